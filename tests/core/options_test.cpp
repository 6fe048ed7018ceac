#include "carve/core/options.h"

#include <gmock/gmock.h>

#include "carve/core/error.h"

namespace carve {
namespace {

enum class Colour { red, green };
std::span<const char* const> names(Colour) {
  static constexpr const char* all[] = {"red", "green"};
  return all;
}

struct Sample {
  int count = 3;
  double level = 0.5;
  std::optional<double> width = {};
  bool on = true;
  Colour colour = Colour::red;
  std::string label = "a \"b\"";
  std::vector<std::string> parts = {"x", "y"};
  bool operator==(const Sample&) const = default;
};
template <class Visitor>
void visit_fields(Sample& o, Visitor&& field) {
  field("count", o.count, 0, 10, "how many");
  field("level", o.level, 0.0, 1.0, "how much");
  field("width", o.width, 1.0, 9.0, "how wide");
  field("on", o.on, "whether");
  field("colour", o.colour, "which");
  field("label", o.label, "what");
  field("parts", o.parts, "of which");
}

std::vector<Field> fields_of(Sample& sample) {
  std::vector<Field> fields;
  add_fields(fields, "sample", sample);
  return fields;
}

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

TEST(Options, DefaultsAreInRange) { EXPECT_NO_THROW(check("sample", Sample{})); }

TEST(Options, AnErrorNamesFieldRangeAndValue) {
  EXPECT_EQ(error_of([] { check("sample", Sample{.level = 7}); }), "sample.level must be in [0, 1], got 7");
  EXPECT_EQ(error_of([] { check("sample", Sample{.count = -3}); }),
            "sample.count must be a whole number in [0, 10], got -3");
  EXPECT_EQ(error_of([] { check("sample", Sample{.level = std::nan("")}); }),
            "sample.level must be in [0, 1], got nan");
}

TEST(Options, SetRejectsWhatIsNoNumberAndWhatIsNoChoice) {
  Sample sample;
  const auto fields = fields_of(sample);
  EXPECT_THAT(error_of([&] { fields[0].set("3.5"); }), testing::HasSubstr("got 3.5"));
  EXPECT_THAT(error_of([&] { fields[0].set("99999999999999999999"); }), testing::HasSubstr("[0, 10]"));
  EXPECT_THAT(error_of([&] { fields[4].set("blue"); }), testing::HasSubstr("one of red|green, got blue"));
  EXPECT_THAT(error_of([&] { fields[3].set("maybe"); }), testing::HasSubstr("on or off"));
  EXPECT_EQ(sample, Sample{});
}

TEST(Options, TomlReadsBackToTheSameValues) {
  Sample written{
      .count = 9, .level = 0.1, .width = 2.5, .on = false, .colour = Colour::green, .label = "q\\", .parts = {}};
  Sample read;
  from_toml(fields_of(read), "x.toml", to_toml(fields_of(written)));
  EXPECT_EQ(read, written);
  Sample automatic;
  from_toml(fields_of(written), "x.toml", to_toml(fields_of(automatic)));
  EXPECT_EQ(written, automatic);
}

TEST(Options, TomlErrorsNameFileAndLine) {
  Sample sample;
  const auto fields = fields_of(sample);
  EXPECT_EQ(error_of([&] { from_toml(fields, "x.toml", "[sample]\nlevel = 7\n"); }),
            "x.toml:2: sample.level must be in [0, 1], got 7");
  EXPECT_EQ(error_of([&] { from_toml(fields, "x.toml", "\n\n[sample]\nlevle = 1"); }),
            "x.toml:4: unknown option sample.levle");
  EXPECT_THAT(error_of([&] { from_toml(fields, "x.toml", "[sample]\ncount = \"many\""); }),
              testing::StartsWith("x.toml:2: "));
  EXPECT_THAT(error_of([&] { from_toml(fields, "x.toml", "[sample\n"); }), testing::StartsWith("x.toml:1: "));
}

TEST(Options, JsonHasOneMemberAField) {
  Sample sample;
  EXPECT_EQ(
      to_json(fields_of(sample)),
      R"({"sample":{"count":3,"level":0.5,"width":"auto","on":true,"colour":"red","label":"a \"b\"","parts":["x","y"]}})");
}

}  // namespace
}  // namespace carve
