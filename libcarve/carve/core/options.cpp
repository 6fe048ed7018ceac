#include "carve/core/options.h"

#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

#include "carve/core/error.h"

namespace carve {
namespace {

constexpr std::string_view kAutomatic = "auto";

// Shortest text that reads back to the same value, whatever the locale.
template <class Number>
std::string text_of(Number value) {
  char buffer[32];
  return std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

template <class Number>
std::optional<Number> number_from(std::string_view text) {
  Number value{};
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

[[noreturn]] void reject(const std::string& name, const std::string& rule, std::string_view got) {
  throw std::invalid_argument(name + " must be " + rule + ", got " + (got.empty() ? "nothing" : std::string(got)));
}

template <class Number>
void set_number(const std::string& name, Number& value, double low, double high, const std::string& range,
                std::string_view text) {
  const auto number = number_from<Number>(text);
  if (!number || !(*number >= low && *number <= high))
    reject(name, (std::is_integral_v<Number> ? "a whole number in " : "in ") + range, text);
  value = *number;
}

template <class Number>
Field ranged(std::string name, Number& value, double low, double high, std::string help) {
  const std::string range = "[" + text_of(low) + ", " + text_of(high) + "]";
  return {name,
          range,
          std::move(help),
          std::is_integral_v<Number> ? Field::Kind::integer : Field::Kind::real,
          false,
          [&value] { return text_of(value); },
          [=, &value](std::string_view text) { set_number(name, value, low, high, range, text); }};
}

template <class Number>
Field ranged_or_automatic(std::string name, std::optional<Number>& value, double low, double high, std::string help) {
  const std::string range = "[" + text_of(low) + ", " + text_of(high) + "] or auto";
  return {name,
          range,
          std::move(help),
          std::is_integral_v<Number> ? Field::Kind::integer : Field::Kind::real,
          true,
          [&value] { return value ? text_of(*value) : std::string(kAutomatic); },
          [=, &value](std::string_view text) {
            if (text == kAutomatic) return value.reset();
            Number number{};
            set_number(name, number, low, high, range, text);
            value = number;
          }};
}

std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    if (end > begin) parts.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string all;
  for (const std::string& part : parts) all += (all.empty() ? "" : ",") + part;
  return all;
}

// "section.field" -> {"section", "field"}
std::pair<std::string, std::string> split_name(const std::string& name) {
  const std::size_t dot = name.find('.');
  return dot == std::string::npos ? std::pair{std::string(), name}
                                  : std::pair{name.substr(0, dot), name.substr(dot + 1)};
}

nlohmann::ordered_json json_value(const Field& field) {
  const std::string text = field.get();
  if (field.has_automatic && text == kAutomatic) return text;
  switch (field.kind) {
    case Field::Kind::integer:
      return *number_from<int>(text);
    case Field::Kind::real:
      return *number_from<double>(text);
    case Field::Kind::boolean:
      return text == "on";
    case Field::Kind::list:
      return split(text);
    default:
      return text;
  }
}

// The text a Field::set takes for a TOML value, or nothing where the type does not fit the field.
std::optional<std::string> text_of_node(const Field& field, const toml::node& node) {
  if (const auto value = node.value_exact<std::string>())
    return field.kind == Field::Kind::text || field.kind == Field::Kind::list || field.has_automatic ||
                   field.kind == Field::Kind::boolean
               ? value
               : std::nullopt;
  if (const auto value = node.value_exact<bool>())
    return field.kind == Field::Kind::boolean ? std::optional<std::string>(*value ? "on" : "off") : std::nullopt;
  if (const auto value = node.value_exact<std::int64_t>())
    return field.kind <= Field::Kind::real ? std::optional(text_of(*value)) : std::nullopt;
  if (const auto value = node.value_exact<double>())
    return field.kind <= Field::Kind::real ? std::optional(text_of(*value)) : std::nullopt;
  if (const toml::array* array = node.as_array(); array && field.kind == Field::Kind::list) {
    std::vector<std::string> parts;
    for (const toml::node& part : *array) {
      if (!part.is_string()) return std::nullopt;
      parts.push_back(*part.value<std::string>());
    }
    return joined(parts);
  }
  return std::nullopt;
}

void set_from_table(std::span<const Field> fields, const std::string& path, const std::string& prefix,
                    const toml::table& table) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    const std::string place = path + ":" + std::to_string(node.source().begin.line);
    if (const toml::table* inner = node.as_table(); inner && prefix.empty()) {
      set_from_table(fields, path, name + ".", *inner);
      continue;
    }
    const auto field = std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return f.name == name; });
    if (field == fields.end()) throw IoError(place, "unknown option " + name);
    const auto text = text_of_node(*field, node);
    if (!text)
      throw IoError(place, name + " must be " + (field->range.empty() ? "text" : field->range) + ", got another type");
    try {
      field->set(*text);
    } catch (const std::invalid_argument& error) {
      throw IoError(place, error.what());
    }
  }
}

}  // namespace

namespace detail {

Field number_field(std::string name, int& value, double low, double high, std::string help) {
  return ranged(std::move(name), value, low, high, std::move(help));
}
Field number_field(std::string name, double& value, double low, double high, std::string help) {
  return ranged(std::move(name), value, low, high, std::move(help));
}
Field number_field(std::string name, std::optional<double>& value, double low, double high, std::string help) {
  return ranged_or_automatic(std::move(name), value, low, high, std::move(help));
}
Field number_field(std::string name, std::optional<int>& value, double low, double high, std::string help) {
  return ranged_or_automatic(std::move(name), value, low, high, std::move(help));
}

Field plain_field(std::string name, bool& value, std::string help) {
  return {name,
          "on|off",
          std::move(help),
          Field::Kind::boolean,
          false,
          [&value] { return std::string(value ? "on" : "off"); },
          [name = std::move(name), &value](std::string_view text) {
            if (text != "on" && text != "off" && text != "true" && text != "false") reject(name, "on or off", text);
            value = text == "on" || text == "true";
          }};
}

Field plain_field(std::string name, std::string& value, std::string help) {
  return {std::move(name),
          "",
          std::move(help),
          Field::Kind::text,
          false,
          [&value] { return value; },
          [&value](std::string_view text) { value = text; }};
}

Field plain_field(std::string name, std::vector<std::string>& value, std::string help) {
  return {std::move(name),
          "a,b,...",
          std::move(help),
          Field::Kind::list,
          false,
          [&value] { return joined(value); },
          [&value](std::string_view text) { value = split(text); }};
}

Field choice_field(std::string name, std::span<const char* const> names, std::function<int()> get,
                   std::function<void(int)> set, std::string help) {
  std::string range;
  for (const char* choice : names) range += (range.empty() ? "" : "|") + std::string(choice);
  return {name,
          range,
          std::move(help),
          Field::Kind::text,
          false,
          [names, get = std::move(get)] { return std::string(names[get()]); },
          [name = std::move(name), names, range, set = std::move(set)](std::string_view text) {
            const auto found = std::find(names.begin(), names.end(), text);
            if (found == names.end()) reject(name, "one of " + range, text);
            set(static_cast<int>(found - names.begin()));
          }};
}

}  // namespace detail

std::string to_toml(std::span<const Field> fields) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  std::string open;
  for (const Field& field : fields) {
    const auto [section, key] = split_name(field.name);
    if (section != open) out << "\n[" << (open = section) << "]\n";
    out << "# " << field.help << (field.range.empty() ? "" : "; " + field.range) << "\n";
    // A JSON scalar or array of strings is also a TOML one.
    out << key << " = " << json_value(field).dump() << "\n";
  }
  return out.str();
}

void from_toml(std::span<const Field> fields, const std::string& path, const std::string& text) {
  try {
    set_from_table(fields, path, "", toml::parse(text, path));
  } catch (const toml::parse_error& error) {
    throw IoError(path + ":" + std::to_string(error.source().begin.line), std::string(error.description()));
  }
}

std::string to_json(std::span<const Field> fields) {
  nlohmann::ordered_json all;
  for (const Field& field : fields) {
    const auto [section, key] = split_name(field.name);
    (section.empty() ? all : all[section])[key] = json_value(field);
  }
  return all.dump();
}

}  // namespace carve
