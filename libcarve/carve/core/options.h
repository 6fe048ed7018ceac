#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace carve {

/// One field of an options struct, as flags, TOML, run records and the studio see it. Fields are made from the struct's
/// one declaration,
///   template <class Field> void visit_fields(SmoothOptions& o, Field&& field) {
///     field("steps", o.steps, 0, 1000, "Laplacian steps");   // numbers (and optional numbers) have a range
///     field("keep", o.keep, "keep strokes sharp");           // bool, string, list of strings, enum have none
///   }
/// An enum E needs `std::span<const char* const> names(E)` beside it. Field refers to the struct: do not outlive it.
struct Field {
  enum class Kind { integer, real, boolean, text, list };
  std::string name;   // "section.field", or "field" where the section is empty
  std::string range;  // "[0, 1000]", "on|off", "none|two_level|solver", ""
  std::string help;
  Kind kind;
  bool has_automatic = false;        // std::optional: "auto" is a value too
  std::function<std::string()> get;  // C locale; reads back to the same value
  std::function<void(std::string_view)>
      set;  // \throws std::invalid_argument: "smooth.steps must be in [0, 1000], got -3"
};

namespace detail {
Field number_field(std::string name, int& value, double low, double high, std::string help);
Field number_field(std::string name, double& value, double low, double high, std::string help);
Field number_field(std::string name, std::optional<double>& value, double low, double high, std::string help);
Field number_field(std::string name, std::optional<int>& value, double low, double high, std::string help);
Field plain_field(std::string name, bool& value, std::string help);
Field plain_field(std::string name, std::string& value, std::string help);
Field plain_field(std::string name, std::vector<std::string>& value, std::string help);
Field choice_field(std::string name, std::span<const char* const> names, std::function<int()> get,
                   std::function<void(int)> set, std::string help);

struct FieldCollector {
  std::string prefix;
  std::vector<Field>& out;
  template <class T>
  void operator()(const char* name, T& value, double low, double high, const char* help) const {
    out.push_back(number_field(prefix + name, value, low, high, help));
  }
  template <class T>
  void operator()(const char* name, T& value, const char* help) const {
    if constexpr (std::is_enum_v<T>)
      out.push_back(choice_field(
          prefix + name, names(value), [&value] { return static_cast<int>(value); },
          [&value](int i) { value = static_cast<T>(i); }, help));
    else
      out.push_back(plain_field(prefix + name, value, help));
  }
};
}  // namespace detail

template <class Options>
void add_fields(std::vector<Field>& out, const std::string& section, Options& options) {
  visit_fields(options, detail::FieldCollector{section.empty() ? "" : section + ".", out});
}

/// Every field of `options` is in its range. \throws std::invalid_argument naming the first that is not
template <class Options>
void check(const std::string& section, Options options) {
  std::vector<Field> all;
  add_fields(all, section, options);
  for (const Field& field : all) field.set(field.get());
}

/// TOML with one table a section and every field's help and range as a comment.
std::string to_toml(std::span<const Field> fields);
/// Sets fields from TOML text. \throws IoError naming `path`, line and key: unknown key, wrong type, out of range
void from_toml(std::span<const Field> fields, const std::string& path, const std::string& toml);
/// A JSON object with one member a field, nested by section.
std::string to_json(std::span<const Field> fields);

}  // namespace carve
