#include "carve/mesh/ply_header.h"

#include <algorithm>
#include <charconv>
#include <limits>

namespace carve::formats {
namespace {

PlyType type_named(TextReader& text, std::string_view name) {
  constexpr std::string_view names[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                           {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                           {"float", "float32"}, {"double", "float64"}};
  for (std::size_t i = 0; i < std::size(names); ++i)
    if (name == names[i][0] || name == names[i][1]) return static_cast<PlyType>(i);
  text.fail("a property's type must be one of char, uchar, short, ushort, int, uint, float, double, got " +
            excerpt(name));
}

PlyEncoding read_encoding(TextReader& text) {
  const std::string_view name = text.word();
  if (name == "ascii") return PlyEncoding::text;
  if (name == "binary_little_endian") return PlyEncoding::little;
  if (name == "binary_big_endian") return PlyEncoding::big;
  text.fail("format must be ascii, binary_little_endian or binary_big_endian, got " + excerpt(name));
}

PlyElement read_element(TextReader& text, const PlyHeader& header) {
  const std::string_view name = text.word(), count = text.word();
  PlyElement element{std::string(name)};
  const auto [stop, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
  if (error != std::errc() || stop != count.data() + count.size())
    text.fail("element " + excerpt(name) + ": the count must be a whole number from 0, got " + excerpt(count));
  if (name == "tristrips") text.fail("element tristrips is not supported; store faces");
  constexpr std::size_t kMost = 256;
  if (header.elements.size() == kMost) text.fail("the header must have at most 256 elements");
  for (const PlyElement& other : header.elements)
    if (other.name == name) text.fail("element " + excerpt(name) + " stands there twice");
  return element;
}

PlyProperty read_property(TextReader& text) {
  std::string_view type = text.word();
  std::optional<PlyType> count;
  if (type == "list") {
    count = type_named(text, text.word());
    if (is_real(*count)) text.fail("a list's count must be of a whole type");
    type = text.word();
  }
  const PlyType value = type_named(text, type);
  return {std::string(text.word()), value, count};
}

}  // namespace

std::size_t PlyHeader::count_of(const std::string& name) const {
  const auto found =
      std::find_if(elements.begin(), elements.end(), [&](const PlyElement& e) { return e.name == name; });
  return found == elements.end() ? 0 : found->count;
}

bool is_real(PlyType type) { return type == PlyType::f32 || type == PlyType::f64; }

std::size_t size_of(PlyType type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<int>(type)];
}

PlyHeader read_header(TextReader& text) {
  if (!text.next_line() || text.word() != "ply") text.fail("a PLY file must begin with ply");
  PlyHeader header;
  bool has_encoding = false;
  while (text.next_line()) {
    const std::string_view keyword = text.word();
    if (keyword == "format") {
      header.encoding = read_encoding(text);
      has_encoding = true;
    } else if (keyword == "element") {
      header.elements.push_back(read_element(text, header));
    } else if (keyword == "property") {
      if (header.elements.empty()) text.fail("a property must stand below its element");
      header.elements.back().properties.push_back(read_property(text));
    } else if (keyword == "end_header") {
      if (!has_encoding) text.fail("the header has no format");
      return header;
    } else if (keyword != "comment" && keyword != "obj_info") {
      text.fail("unknown word in the header: " + excerpt(keyword));
    }
  }
  text.fail("the file ends before its end_header");
}

void check_counts(const std::string& path, const PlyHeader& header, std::size_t bytes) {
  for (const PlyElement& element : header.elements) {
    std::size_t shortest = 0;
    for (const PlyProperty& property : element.properties)
      shortest += header.encoding == PlyEncoding::text ? 2 : size_of(property.count.value_or(property.type));
    if (shortest == 0) continue;
    // The last number of a text needs nothing behind it.
    const std::size_t room = (bytes + (header.encoding == PlyEncoding::text)) / shortest;
    const std::size_t most = std::min<std::size_t>(room, std::numeric_limits<int>::max());
    if (element.count > most)
      throw IoError(path, "element " + excerpt(element.name) + ": the count must be in [0, " + std::to_string(most) +
                              "], as many as the file can hold, got " + std::to_string(element.count));
  }
}

}  // namespace carve::formats
