#pragma once
// What a PLY file says of its own layout; not part of the interface.
#include <optional>
#include <string>
#include <vector>

#include "carve/mesh/formats.h"
#include "carve/mesh/text_reader.h"

namespace carve::formats {

enum class PlyType { i8, u8, i16, u16, i32, u32, f32, f64 };

struct PlyProperty {
  std::string name;
  PlyType type;
  std::optional<PlyType> count = {};  // of a list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties = {};
};

enum class PlyEncoding { text, little, big };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::text;
  std::vector<PlyElement> elements = {};

  std::size_t count_of(const std::string& name) const;  // 0 if there is no such element
};

bool is_real(PlyType type);
std::size_t size_of(PlyType type);

/// Leaves `text` at end_header. \throws IoError
PlyHeader read_header(TextReader& text);

/// Refuses counts that so many bytes cannot hold, before anything is allocated for them. \throws IoError
void check_counts(const std::string& path, const PlyHeader& header, std::size_t bytes);

}  // namespace carve::formats
