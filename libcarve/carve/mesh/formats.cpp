#include "carve/mesh/formats.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <ostream>
#include <stdexcept>

#include "carve/mesh/adjacency.h"
#include "carve/mesh/topology.h"

namespace carve::formats {

static_assert(std::endian::native == std::endian::little, "Sink::raw and the binary readers assume it");

void Sink::number(double value) {
  char digits[32];
  text({digits, std::to_chars(digits, digits + sizeof digits, value).ptr});
}

void Sink::number(int value) {
  char digits[16];
  text({digits, std::to_chars(digits, digits + sizeof digits, value).ptr});
}

void Sink::flush() {
  out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  buffer_.clear();
}

void TextReader::begin_line(std::size_t at) {
  at_ = at;
  end_ = std::min(text_.find('\n', at), text_.size());
  next_ = std::min(end_ + 1, text_.size());
  ++line_;
}

bool TextReader::next_line() {
  while (next_ < text_.size()) {
    begin_line(next_);
    skip_spaces();
    if (at_ < end_) return true;
  }
  at_ = end_ = text_.size();
  return false;
}

bool TextReader::ends_word(std::size_t at) const {
  if (at >= end_) return true;
  const char c = text_[at];
  return c == ' ' || (c >= '\t' && c <= '\r') || (c == '#' && comments_);
}

void TextReader::skip_spaces() {
  while (at_ < end_) {
    const char c = text_[at_];
    if (c == '#' && comments_)
      at_ = end_;
    else if (c == '\\' && text_.substr(at_ + 1, end_ - at_ - 1).find_first_not_of('\r') == std::string_view::npos)
      begin_line(next_);
    else if (ends_word(at_))
      ++at_;
    else
      return;
  }
}

std::string_view TextReader::word() {
  skip_spaces();
  const std::size_t begin = at_;
  while (!ends_word(at_)) ++at_;
  return text_.substr(begin, at_ - begin);
}

bool TextReader::has_word() {
  skip_spaces();
  return at_ < end_;
}

template <class Number>
Number TextReader::number(const char* field) {
  skip_spaces();
  const std::size_t begin = at_;
  if (at_ < end_ && text_[at_] == '+') ++at_;
  Number value{};
  const auto [stop, error] = std::from_chars(text_.data() + at_, text_.data() + end_, value);
  at_ = static_cast<std::size_t>(stop - text_.data());
  if (error != std::errc() || !ends_word(at_)) {
    at_ = begin;
    const std::string_view got = word();
    fail(std::string(field) + " must be a " + (std::is_integral_v<Number> ? "whole " : "") + "number, got " +
         (got.empty() ? "the end of the line" : excerpt(got)));
  }
  return value;
}

double TextReader::coordinate() {
  const double value = number<double>("a coordinate");
  if (!std::isfinite(value))
    fail(std::string("a coordinate must be finite, got ") + (std::isnan(value) ? "nan" : "inf"));
  return value;
}

long long TextReader::whole(const char* field) { return number<long long>(field); }

void TextReader::fail(const std::string& why) const {
  throw IoError(path_ + ":" + std::to_string(std::max(line_, 1LL)), why);
}

std::string ends_at(const std::string& element, std::size_t index, std::size_t count) {
  return "the file ends before " + element + " " + std::to_string(index) + " of " + std::to_string(count);
}

std::string excerpt(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string shown(text.substr(0, kLongest));
  for (char& c : shown)
    if (c < ' ' || c > '~') c = '?';
  return "'" + shown + (text.size() > kLongest ? "...'" : "'");
}

float to_float(double value, const char* format) {
  const float rounded = static_cast<float>(value);
  if (!std::isfinite(rounded))
    throw std::invalid_argument(std::string("coordinates must fit into a float to be written as ") + format);
  return rounded;
}

void check_writable(const std::string& path, const Mesh& mesh, const WriteOptions& options) try {
  if (!options.strict) return check_mesh(mesh);
  const Topology found = topology(mesh);
  if (found.solid()) return;
  std::string faults;
  const auto add = [&](std::int64_t count, const char* one, const char* many) {
    if (count > 0) faults += (faults.empty() ? "" : ", ") + std::to_string(count) + " " + (count == 1 ? one : many);
  };
  add(found.boundary_edges, "boundary edge", "boundary edges");
  add(found.nonmanifold_edges, "edge of more than two triangles", "edges of more than two triangles");
  add(found.misoriented_edges, "misoriented edge", "misoriented edges");
  add(found.nonmanifold_vertices, "nonmanifold vertex", "nonmanifold vertices");
  if (found.triangles == 0) faults = "no triangles";
  throw std::invalid_argument("the mesh must be closed, oriented and 2-manifold, got " + faults);
} catch (const std::invalid_argument& error) {
  throw std::invalid_argument(path + ": " + error.what());
}

}  // namespace carve::formats
