#include <array>
#include <charconv>
#include <cmath>

#include "artist/bytes.h"
#include "artist/readers.h"

namespace carve::artist {
namespace {

// Numbers in the C locale, separated by white space.
class Numbers {
 public:
  Numbers(std::string_view data, const std::string& name) : at_(data.data()), end_(at_ + data.size()), name_(name) {}
  template <class T>
  T next() {
    while (at_ < end_ && std::isspace(static_cast<unsigned char>(*at_))) ++at_;
    T value{};
    const auto [rest, error] = std::from_chars(at_, end_, value);
    if (error != std::errc()) throw IoError(name_, at_ == end_ ? "truncated" : "not a number where one should be");
    if constexpr (std::is_floating_point_v<T>)
      if (!std::isfinite(value)) throw IoError(name_, "a number is not finite");
    at_ = rest;
    return value;
  }
  std::ptrdiff_t left() const { return end_ - at_; }

 private:
  const char *at_, *end_;
  const std::string& name_;
};

std::string decode_base64(std::string_view text, const std::string& name) {
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text.substr(0, text.find('='))) {
    const bool upper = c >= 'A' && c <= 'Z', lower = c >= 'a' && c <= 'z', digit = c >= '0' && c <= '9';
    if (!upper && !lower && !digit && c != '+' && c != '/') throw IoError(name, "not base64");
    bits = bits << 6 | (upper ? c - 'A' : lower ? c - 'a' + 26 : digit ? c - '0' + 52 : c == '+' ? 62 : 63);
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<char>(bits >> count & 0xff));
  }
  return bytes;
}

// The array of exports.<what> = ...(TypedArray, "base64") with its bytes' width.
struct TypedArray {
  std::string type, bytes;
};
TypedArray exported(std::string_view data, const std::string& what, const std::string& name) {
  const auto missing = [&] { return IoError(name, "no exports." + what + " as base64 of a typed array"); };
  auto at = data.find("exports." + what);
  if (at == std::string_view::npos) throw missing();
  const auto open = data.find('"', data.find("Array", at)), close = data.find('"', open + 1);
  if (open == std::string_view::npos || close == std::string_view::npos) throw missing();
  const std::string_view head = data.substr(at, open - at);
  for (const char* type : {"Float32Array", "Uint16Array", "Uint32Array"})
    if (head.find(type) != std::string_view::npos)
      return {type, decode_base64(data.substr(open + 1, close - open - 1), name)};
  throw missing();
}

}  // namespace

Model read_raw(std::string_view data, const std::string& name) {
  Numbers numbers(data, name);
  const long vertices = numbers.next<long>();
  if (vertices < 0 || vertices % 3 != 0) throw IoError(name, "its vertices make no triangles");
  if (vertices > numbers.left() / 10)
    throw IoError(name, "truncated: it promises " + std::to_string(vertices) + " vertices");
  Model model;
  model.materials.push_back({"raw"});
  for (int v = 0; v < vertices; ++v) {
    Vec3 p;
    Vec2 t;
    for (double& x : p) x = numbers.next<double>();
    for (double& x : t) x = numbers.next<double>();
    model.positions.push_back(p);
    model.texcoords.push_back(t);
    if (v % 3 == 2) model.faces.push_back({{{{v - 2, v - 2}, {v - 1, v - 1}, {v, v}}}, 0});
  }
  return model;
}

Model read_js(std::string_view data, const std::string& name) {
  const TypedArray positions = exported(data, "positions", name), cells = exported(data, "cells", name);
  if (positions.type != "Float32Array" || cells.type == "Float32Array")
    throw IoError(name, "positions must be 32-bit floats and cells integers");
  const Bytes coordinates(positions.bytes, name), indices(cells.bytes, name);
  const int width = cells.type == "Uint16Array" ? 2 : 4;
  Model model;
  model.materials.push_back({"js"});
  for (std::int64_t at = 0; at + 12 <= coordinates.size(); at += 12) {
    model.positions.push_back(
        {coordinates.get<float>(at), coordinates.get<float>(at + 4), coordinates.get<float>(at + 8)});
    if (!model.positions.back().allFinite()) throw IoError(name, "a vertex is not finite");
  }
  for (std::int64_t at = 0; at + 3 * width <= indices.size(); at += 3 * width) {
    Face face;
    for (int k = 0; k < 3; ++k) {
      const std::int64_t index =
          width == 2 ? indices.get<std::uint16_t>(at + 2 * k) : indices.get<std::uint32_t>(at + 4 * k);
      if (index >= static_cast<std::int64_t>(model.positions.size()))
        throw IoError(name, "a cell has a corner that is not there");
      face.corners[k].position = static_cast<int>(index);
    }
    model.faces.push_back(face);
  }
  return model;
}

}  // namespace carve::artist
