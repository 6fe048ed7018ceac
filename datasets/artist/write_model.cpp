#include "artist/write_model.h"

#include <charconv>
#include <map>
#include <ostream>

#include "artist/readers.h"
#include "carve/core/error.h"
#include "carve/core/file.h"
#include "carve/image/read_image.h"

namespace carve::artist {
namespace fs = std::filesystem;
namespace {

struct Number {  // nine digits in the C locale
  double value;
  friend std::ostream& operator<<(std::ostream& out, Number number) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof(text), number.value + 0.0, std::chars_format::general, 9).ptr;
    return out.write(text, end - text);
  }
};

// Copies a texture to FOLDER/STEM.png or .jpg and returns that name.
std::string copy_texture(const fs::path& source, const fs::path& folder, const std::string& stem) {
  std::string data = read_file(source);
  const bool jpeg = data.starts_with("\xff\xd8\xff"), png = data.starts_with("\x89PNG");
  std::string extension = source.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (!jpeg && !png) {
    if (extension != ".tga") throw IoError(source.string(), "a texture must be PNG, JPEG or Targa");
    data = encode_png(read_tga(data, source.string()));
  }
  const std::string name = stem + (jpeg ? ".jpg" : ".png");
  write_file(folder / name, [&](std::ostream& out) { out << data; });
  return name;
}

void write_mtl(const fs::path& folder, const Model& model, const fs::path& source) {
  const std::string name = folder.filename().string();
  std::map<std::string, std::string> copies;
  for (const Material& material : model.materials)
    if (!material.texture.empty() && !copies.contains(material.texture)) {
      const std::string stem = name + "_" + std::to_string(copies.size());
      copies[material.texture] = copy_texture(source / material.texture, folder, stem);
    }
  write_file(folder / (name + ".mtl"), [&](std::ostream& out) {
    for (std::size_t i = 0; i < model.materials.size(); ++i) {
      const Material& material = model.materials[i];
      const Vec3 colour = material.texture.empty() ? material.colour : Vec3::Ones();
      out << "newmtl m" << i << "\nKd " << Number{colour[0]} << ' ' << Number{colour[1]} << ' ' << Number{colour[2]}
          << '\n';
      if (!material.texture.empty()) out << "map_Kd " << copies.at(material.texture) << '\n';
    }
  });
}

}  // namespace

void write_model(const fs::path& folder, const Model& model, const fs::path& source) {
  fs::create_directories(folder);
  write_mtl(folder, model, source);
  const std::string name = folder.filename().string();
  write_file(folder / (name + ".obj"), [&](std::ostream& out) {
    out << "mtllib " << name << ".mtl\n";
    for (const Vec3& p : model.positions)
      out << "v " << Number{p.x()} << ' ' << Number{p.y()} << ' ' << Number{p.z()} << '\n';
    for (const Vec2& t : model.texcoords) out << "vt " << Number{t.x()} << ' ' << Number{t.y()} << '\n';
    out << "vt 0 0\n";  // for corners that have none
    for (std::size_t m = 0; m < model.materials.size(); ++m) {
      out << "usemtl m" << m << '\n';
      for (const Face& face : model.faces) {
        if (face.material != static_cast<int>(m)) continue;
        out << 'f';
        for (const Corner& c : face.corners)
          out << ' ' << c.position + 1 << '/' << (c.texcoord < 0 ? model.texcoords.size() : c.texcoord) + 1;
        out << '\n';
      }
    }
  });
}

}  // namespace carve::artist
