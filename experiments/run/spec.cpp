#include "run/spec.h"

#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <iterator>

#include "carve/core/error.h"
#include "carve/core/file.h"
#include "run/methods.h"
#include "run/metrics.h"
#include "run/models.h"
#include "run/settings.h"

namespace carve::experiments {
namespace {

// Reads one file; every complaint names its line.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : path_(path) { spec_.name = path.stem().string(); }

  Spec read() {
    toml::table table;
    try {
      table = toml::parse(read_file(path_), path_.string());
    } catch (const toml::parse_error& error) {
      throw IoError(path_.string() + ":" + std::to_string(error.source().begin.line), std::string(error.description()));
    }
    for (const auto& [key, node] : table) read_entry(key.str(), node);
    finish(table);
    return std::move(spec_);
  }

 private:
  [[noreturn]] void fail(const toml::node& node, const std::string& what) const {
    throw IoError(path_.string() + ":" + std::to_string(node.source().begin.line), what);
  }

  void read_entry(std::string_view key, const toml::node& node) {
    if (key == "title")
      spec_.title = text(node);
    else if (key == "thesis")
      read_thesis(node);
    else if (key == "baseline")
      spec_.baseline = text(node);
    else if (key == "models")
      spec_.models = models(node);
    else if (key == "metrics")
      read_metrics(node);
    else if (key == "seeds")
      read_seeds(node);
    else if (key == "options")
      spec_.options = settings(node);
    else if (key == "sweep")
      read_sweep(node);
    else if (key == "limits")
      read_limits(node);
    else if (key == "heat_map")
      read_heat_map(node);
    else if (key == "renders")
      spec_.render_models = models(node);
    else if (key == "published")
      read_published(node);
    else if (key == "method")
      read_methods(node);
    else if (key != "all_minus")
      fail(node, "unknown key " + std::string(key));
  }

  const toml::table& table(const toml::node& node) const {
    if (!node.is_table()) fail(node, "must be a table");
    return *node.as_table();
  }

  std::string text(const toml::node& node) const {
    if (!node.is_string()) fail(node, "must be a string");
    return *node.value<std::string>();
  }

  // A scalar as an option's text.
  std::string value(const toml::node& node) const {
    if (node.is_string()) return *node.value<std::string>();
    if (node.is_boolean()) return *node.value<bool>() ? "on" : "off";
    if (!node.is_integer() && !node.is_floating_point()) fail(node, "must be a number, a string, true or false");
    return node.is_integer() ? text_of(*node.value<std::int64_t>()) : text_of(*node.value<double>());
  }

  template <class Number>
  static std::string text_of(Number number) {
    char digits[32];
    return {digits, std::to_chars(digits, std::end(digits), number).ptr};
  }

  template <class Convert>
  auto list(const toml::node& node, Convert&& convert) const {
    if (!node.is_array()) fail(node, "must be a list");
    std::vector<decltype(convert(node))> all;
    for (const toml::node& item : *node.as_array()) {
      all.push_back(convert(item));
      if (std::count(all.begin(), all.end(), all.back()) > 1) fail(item, "is there twice");
    }
    return all;
  }

  std::vector<std::string> texts(const toml::node& node) const {
    return list(node, [this](const toml::node& item) { return text(item); });
  }

  std::vector<std::string> models(const toml::node& node) const {
    return list(node, [this](const toml::node& item) {
      try {
        expand_subjects({text(item)});
      } catch (const std::invalid_argument& error) {
        fail(item, error.what());
      }
      return text(item);
    });
  }

  double number(const toml::node& node, double low, double high, const char* name) const {
    const auto number = node.value<double>();
    if (!number || !(*number >= low && *number <= high))
      fail(node, std::string(name) + " must be in [" + text_of(low) + ", " + text_of(high) + "]");
    return *number;
  }

  // Checks a setting by setting it on default options.
  void check_setting(const toml::node& node, const std::string& field, const std::string& text) const {
    RunOptions scratch;
    try {
      apply(scratch, {{field, text}});
    } catch (const std::invalid_argument& error) {
      fail(node, error.what());
    }
  }

  void collect(const toml::node& node, const std::string& prefix, Settings& out) const {
    for (const auto& [key, item] : table(node)) {
      const std::string field = prefix + std::string(key.str());
      if (item.is_table()) {
        collect(item, field + ".", out);
      } else {
        out[field] = value(item);
        check_setting(item, field, out[field]);
      }
    }
  }

  Settings settings(const toml::node& node) const {
    Settings out;
    collect(node, "", out);
    return out;
  }

  void sweep(const toml::node& node, const std::string& prefix) {
    for (const auto& [key, item] : table(node)) {
      const std::string field = prefix + std::string(key.str());
      if (item.is_table()) {
        sweep(item, field + ".");
        continue;
      }
      const auto values = list(item, [this](const toml::node& v) { return value(v); });
      if (values.empty()) fail(item, field + " needs a value to sweep");
      for (const std::string& v : values) check_setting(item, field, v);
      spec_.sweep.emplace_back(field, values);
    }
  }
  void read_sweep(const toml::node& node) { sweep(node, ""); }

  void read_thesis(const toml::node& node) {
    spec_.thesis = texts(node);
    for (const std::string& what : spec_.thesis)
      if (!what.starts_with("Fig. ") && !what.starts_with("Table ") && !what.starts_with("Section "))
        fail(node, "thesis must name a Fig., a Table or a Section, got " + what);
  }

  void read_metrics(const toml::node& node) {
    spec_.metrics = texts(node);
    for (const std::string& name : spec_.metrics)
      if (!find_metric(name)) fail(node, "unknown metric " + name);
  }

  void read_seeds(const toml::node& node) {
    spec_.seeds = list(node, [this](const toml::node& item) {
      return static_cast<unsigned>(number(item, 0, 4294967295.0, "a seed"));
    });
    if (spec_.seeds.empty()) fail(node, "seeds must not be empty");
  }

  void read_limits(const toml::node& node) {
    for (const auto& [key, item] : table(node)) {
      if (key.str() == "seconds")
        spec_.seconds = number(item, 0.1, 1e6, "seconds");
      else if (key.str() == "megabytes")
        spec_.megabytes = number(item, 64, 1e6, "megabytes");
      else
        fail(item, "unknown key limits." + std::string(key.str()));
    }
  }

  void read_heat_map(const toml::node& node) {
    for (const auto& [key, item] : table(node)) {
      if (key.str() == "models")
        spec_.heat_map_models = models(item);
      else if (key.str() == "range")
        spec_.heat_map_range = number(item, 1e-6, 1e3, "range");
      else
        fail(item, "unknown key heat_map." + std::string(key.str()));
    }
  }

  void read_published(const toml::node& node) {
    for (const auto& [key, item] : table(node)) {
      if (key.str() == "table")
        spec_.published.table = text(item);
      else if (key.str() == "method")
        spec_.published.method = text(item);
      else if (key.str() == "columns")
        for (const auto& [column, metric] : table(item)) {
          spec_.published.columns[std::string(column.str())] = text(metric);
          if (!find_metric(text(metric))) fail(metric, "unknown metric " + text(metric));
        }
      else
        fail(item, "unknown key published." + std::string(key.str()));
    }
  }

  void read_methods(const toml::node& node) {
    if (!node.is_array_of_tables()) fail(node, "method must be written as [[method]]");
    for (const toml::node& entry : *node.as_array()) {
      MethodSpec method;
      for (const auto& [key, item] : table(entry)) {
        if (key.str() == "name")
          method.name = text(item);
        else if (key.str() == "arm")
          method.arm = text(item);
        else if (key.str() == "options")
          method.settings = settings(item);
        else
          fail(item, "unknown key method." + std::string(key.str()));
      }
      if (method.name.empty()) fail(entry, "a method needs a name");
      if (!find_method(method.arm)) fail(entry, "unknown arm " + method.arm + "; arms: " + method_names());
      add(entry, std::move(method));
    }
  }

  void add(const toml::node& node, MethodSpec method) {
    if (method.name.find_first_of("/,=\n") != std::string::npos)
      fail(node, "a method's name must not have / , = in it");
    for (const MethodSpec& other : spec_.methods)
      if (other.name == method.name) fail(node, "method " + method.name + " is there twice");
    spec_.methods.push_back(std::move(method));
  }

  // What depends on several keys.
  void finish(const toml::table& table) {
    if (const toml::node* minus = table.get("all_minus")) {
      add(*minus, {.name = "all"});
      for (const std::string& field : texts(*minus)) {
        try {
          add(*minus, {.name = "all - " + field, .settings = {{field, switched_off(field)}}});
        } catch (const std::invalid_argument& error) {
          fail(*minus, error.what());
        }
      }
    }
    if (spec_.methods.empty()) throw IoError(path_.string(), "needs at least one [[method]] or all_minus");
    if (spec_.models.empty()) throw IoError(path_.string(), "needs models");
    if (spec_.title.empty()) spec_.title = spec_.name;
    check_method(spec_.baseline, "baseline");
    check_method(spec_.published.method, "published.method");
    for (const auto& [field, values] : spec_.sweep)
      if (std::all_of(spec_.methods.begin(), spec_.methods.end(),
                      [&](const MethodSpec& m) { return m.settings.contains(field); }))
        fail(*table.get("sweep"), "every method states " + field + " itself: nothing is left to sweep");
  }

  void check_method(const std::string& name, const std::string& key) const {
    const auto named = [&](const MethodSpec& m) { return m.name == name; };
    if (!name.empty() && std::none_of(spec_.methods.begin(), spec_.methods.end(), named))
      throw IoError(path_.string(), key + " " + name + " is not one of its methods");
  }

  std::filesystem::path path_;
  Spec spec_;
};

}  // namespace

Spec read_spec(const std::filesystem::path& path) { return Reader(path).read(); }

}  // namespace carve::experiments
