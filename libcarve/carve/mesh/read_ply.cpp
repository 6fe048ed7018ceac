#include <algorithm>
#include <cmath>
#include <fstream>

#include "carve/mesh/ply_cloud.h"
#include "carve/mesh/ply_header.h"

namespace carve::formats {
namespace {

// The numbers of a binary body. Sources throw EndOfFile where they have no more.
struct EndOfFile {};

template <bool swapped>
class BinarySource {
 public:
  BinarySource(TextReader&, std::string_view bytes) : bytes_(bytes) {}

  double real(PlyType type) {
    if (type == PlyType::f32) return load<float>();
    if (type == PlyType::f64) return load<double>();
    return static_cast<double>(whole(type));
  }
  std::int64_t whole(PlyType type) {
    switch (type) {
      case PlyType::i8:
        return load<std::int8_t>();
      case PlyType::u8:
        return load<std::uint8_t>();
      case PlyType::i16:
        return load<std::int16_t>();
      case PlyType::u16:
        return load<std::uint16_t>();
      case PlyType::i32:
        return load<std::int32_t>();
      default:
        return load<std::uint32_t>();
    }
  }
  void skip(PlyType type, std::size_t count) {
    if (count > bytes_.size() / size_of(type)) throw EndOfFile();
    bytes_.remove_prefix(count * size_of(type));
  }
  bool can_hold(PlyType type, std::size_t count) const { return count <= bytes_.size() / size_of(type); }

 private:
  template <class T>
  T load() {
    if (bytes_.size() < sizeof(T)) throw EndOfFile();
    char raw[sizeof(T)];
    std::memcpy(raw, bytes_.data(), sizeof(T));
    bytes_.remove_prefix(sizeof(T));
    if (swapped) std::reverse(raw, raw + sizeof(T));
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }

  std::string_view bytes_;
};

// The numbers of an ascii body, whatever its line breaks.
class TextSource {
 public:
  TextSource(TextReader& text, std::string_view) : text_(text) {}

  double real(PlyType) {
    to_word();
    return text_.coordinate();
  }
  std::int64_t whole(PlyType) {
    to_word();
    return text_.whole("a count or index");
  }
  void skip(PlyType, std::size_t count) {
    for (; count > 0; --count) {
      to_word();
      text_.word();
    }
  }
  bool can_hold(PlyType, std::size_t count) const { return count <= text_.bytes_left() / 2 + 1; }

 private:
  void to_word() {
    if (!text_.has_word() && !text_.next_line()) throw EndOfFile();
  }

  TextReader& text_;
};

template <class Source>
class BodyReader {
 public:
  // `first`: how many of the only element's items stand before this body.
  BodyReader(const std::string& path, const PlyHeader& header, Source source, std::size_t first = 0)
      : path_(path), header_(header), source_(source), first_(first) {}

  Mesh read() {
    for (const PlyElement& element : header_.elements) read(element);
    return std::move(mesh_);
  }

 private:
  void read(const PlyElement& element) {
    if (element.properties.empty()) return;
    const bool vertex = element.name == "vertex", face = element.name == "face";
    const int corners = face ? corners_property(element) : -1;
    const std::vector<int> axes = vertex ? axis_properties(element) : std::vector<int>();
    if (vertex) mesh_.positions.reserve(element.count);
    if (face) mesh_.triangles.reserve(element.count);
    std::size_t i = 0;
    try {
      for (; i < element.count; ++i) {
        if (vertex)
          read_vertex(element, axes, i);
        else
          read_other(element, corners, i);
      }
    } catch (const EndOfFile&) {
      throw IoError(path_, ends_at(excerpt(element.name), i, element.count));
    }
  }

  // Which axis each property of the vertices is, or -1.
  std::vector<int> axis_properties(const PlyElement& element) const {
    std::vector<int> axes(element.properties.size(), -1);
    for (int axis = 0; axis < 3; ++axis) {
      const std::string name(1, static_cast<char>('x' + axis));
      const auto found = std::find_if(element.properties.begin(), element.properties.end(),
                                      [&](const PlyProperty& p) { return p.name == name && !p.count; });
      if (found == element.properties.end()) throw IoError(path_, "element vertex has no property " + name);
      axes[found - element.properties.begin()] = axis;
    }
    return axes;
  }

  int corners_property(const PlyElement& element) const {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (property.name != "vertex_indices" && property.name != "vertex_index") continue;
      if (!property.count || is_real(property.type))
        throw IoError(path_, "face." + property.name + " must be a list of a whole type");
      return static_cast<int>(i);
    }
    throw IoError(path_, "element face has no property vertex_indices");
  }

  void read_vertex(const PlyElement& element, const std::vector<int>& axes, std::size_t index) {
    Vec3 position;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (axes[i] < 0) {
        skip(property, element, index);
        continue;
      }
      const double x = source_.real(property.type);
      if (!std::isfinite(x))
        fail(element, index, property, "must be finite, got " + std::string(std::isnan(x) ? "nan" : "inf"));
      position[axes[i]] = x;
    }
    mesh_.positions.push_back(position);
  }

  void read_other(const PlyElement& element, int corners, std::size_t index) {
    for (int i = 0; i < static_cast<int>(element.properties.size()); ++i) {
      if (i == corners)
        read_corners(element.properties[i], element, index);
      else
        skip(element.properties[i], element, index);
    }
  }

  void read_corners(const PlyProperty& property, const PlyElement& element, std::size_t index) {
    const std::size_t size = list_size(property, element, index);
    if (size < 3) fail(element, index, property, "must have at least 3 corners, got " + std::to_string(size));
    const std::size_t vertices = header_.count_of("vertex");
    corners_.resize(size);
    for (int& corner : corners_) {
      const std::int64_t value = source_.whole(property.type);
      if (value < 0 || static_cast<std::size_t>(value) >= vertices)
        fail(element, index, property,
             "must be in [0, " + std::to_string(vertices) + "), got " + std::to_string(value));
      corner = static_cast<int>(value);
    }
    add_polygon(mesh_, corners_);
  }

  std::size_t list_size(const PlyProperty& property, const PlyElement& element, std::size_t index) {
    const std::int64_t size = source_.whole(*property.count);
    if (size < 0) fail(element, index, property, "must have a count from 0, got " + std::to_string(size));
    if (!source_.can_hold(property.type, static_cast<std::size_t>(size))) throw EndOfFile();
    return static_cast<std::size_t>(size);
  }

  void skip(const PlyProperty& property, const PlyElement& element, std::size_t index) {
    source_.skip(property.type, property.count ? list_size(property, element, index) : 1);
  }

  [[noreturn]] void fail(const PlyElement& element, std::size_t index, const PlyProperty& property,
                         const std::string& why) {
    throw IoError(path_, excerpt(element.name) + " " + std::to_string(first_ + index) + ": " + excerpt(property.name) +
                             " " + why);
  }

  const std::string& path_;
  const PlyHeader& header_;
  Source source_;
  std::size_t first_;
  Mesh mesh_;
  std::vector<int> corners_;
};

template <class Source>
Mesh read_body(const std::string& path, const PlyHeader& header, TextReader& text, std::string_view body) {
  return BodyReader<Source>(path, header, Source(text, body)).read();
}

}  // namespace

Mesh read_ply(const std::string& path, std::string_view bytes) {
  TextReader text(path, bytes, false);
  const PlyHeader header = read_header(text);
  const std::string_view body = text.rest();
  check_counts(path, header, body.size());
  if (header.count_of("face") > 0 && header.count_of("vertex") == 0)
    throw IoError(path, "there are faces but no vertices");
  switch (header.encoding) {
    case PlyEncoding::little:
      return read_body<BinarySource<false>>(path, header, text, body);
    case PlyEncoding::big:
      return read_body<BinarySource<true>>(path, header, text, body);
    default:
      return read_body<TextSource>(path, header, text, body);
  }
}

}  // namespace carve::formats

namespace carve {

struct PlyCloud::State {
  std::string path;
  std::ifstream file;
  formats::PlyHeader piece;  // its vertex element counts what is read at a time
  std::size_t size = 0, at = 0, bytes_a_point = 0;
};

std::optional<PlyCloud> PlyCloud::open(const std::filesystem::path& path) {
  auto state = std::make_unique<State>();
  state->path = path.string();
  state->file.open(path, std::ios::binary);
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::string head(std::min<std::uintmax_t>(size, 1 << 16), '\0');
  if (error || !state->file.read(head.data(), static_cast<std::streamsize>(head.size()))) return std::nullopt;
  if (!head.starts_with("ply") || head.find("end_header") == std::string::npos) return std::nullopt;
  formats::TextReader text(state->path, head, false);
  state->piece = formats::read_header(text);
  const std::size_t begin = head.size() - text.rest().size();
  std::erase_if(state->piece.elements, [](const formats::PlyElement& element) { return element.count == 0; });
  if (state->piece.encoding == formats::PlyEncoding::text || state->piece.elements.size() != 1 ||
      state->piece.elements[0].name != "vertex")
    return std::nullopt;
  for (const formats::PlyProperty& property : state->piece.elements[0].properties) {
    if (property.count) return std::nullopt;
    state->bytes_a_point += formats::size_of(property.type);
  }
  formats::check_counts(state->path, state->piece, size - begin);
  state->size = state->piece.elements[0].count;
  state->file.seekg(static_cast<std::streamoff>(begin));
  return PlyCloud(std::move(state));
}

PlyCloud::PlyCloud(std::unique_ptr<State> state) : state_(std::move(state)) {}
PlyCloud::~PlyCloud() = default;
PlyCloud::PlyCloud(PlyCloud&&) noexcept = default;

std::size_t PlyCloud::size() const { return state_->size; }

std::vector<Vec3> PlyCloud::next(std::size_t most) {
  State& s = *state_;
  const std::size_t count = std::min(most, s.size - s.at);
  std::string bytes(count * s.bytes_a_point, '\0');
  if (!s.file.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    throw IoError(s.path, formats::ends_at("vertex", s.at, s.size));
  s.piece.elements[0].count = count;
  formats::TextReader none(s.path, {}, false);
  const auto points = [&](auto source) {
    return formats::BodyReader<decltype(source)>(s.path, s.piece, source, s.at).read().positions;
  };
  std::vector<Vec3> read = s.piece.encoding == formats::PlyEncoding::little
                               ? points(formats::BinarySource<false>(none, bytes))
                               : points(formats::BinarySource<true>(none, bytes));
  s.at += count;
  return read;
}

}  // namespace carve
