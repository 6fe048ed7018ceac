#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <zlib.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <memory>

#include "artist/readers.h"
#include "carve/core/error.h"

namespace carve::artist {
namespace {

std::string gunzip(const std::filesystem::path& path) {
  constexpr std::size_t kLimit = std::size_t{1} << 30;
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) throw IoError(path.string(), "cannot be opened");
  std::string data;
  char block[1 << 16];
  for (int n = 0; (n = gzread(file.get(), block, sizeof(block))) != 0;) {
    if (n < 0) throw IoError(path.string(), "not a whole gzip file");
    if (data.size() > kLimit) throw IoError(path.string(), "unpacks to more than 1 GiB");
    data.append(block, n);
  }
  if (int error = Z_OK; gzerror(file.get(), &error), error != Z_OK)
    throw IoError(path.string(), "not a whole gzip file");
  return data;
}

double srgb(double linear) { return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055; }

Material material_of(const aiMaterial& source, bool linear) {
  Material material{source.GetName().C_Str()};
  aiColor3D colour(0.75f, 0.75f, 0.75f);
  source.Get(AI_MATKEY_COLOR_DIFFUSE, colour);
  for (int i = 0; i < 3; ++i) {
    const double value = std::clamp(static_cast<double>(colour[i]), 0.0, 1.0);
    material.colour[i] = linear ? srgb(value) : value;
  }
  aiString texture;
  if (source.GetTexture(aiTextureType_DIFFUSE, 0, &texture) == aiReturn_SUCCESS) {
    const std::string name = texture.C_Str();
    material.texture = name.substr(name.find_last_of("/\\") + 1);
  }
  return material;
}

class SceneReader {
 public:
  SceneReader(const aiScene& scene, std::string name, std::span<const std::string> objects)
      : scene_(scene), name_(std::move(name)), objects_(objects) {}

  Model read(bool linear) {
    for (unsigned i = 0; i < scene_.mNumMaterials; ++i)
      model_.materials.push_back(material_of(*scene_.mMaterials[i], linear));
    append(*scene_.mRootNode, aiMatrix4x4());
    return std::move(model_);
  }

 private:
  void append(const aiNode& node, const aiMatrix4x4& parent) {
    const aiMatrix4x4 world = parent * node.mTransformation;
    const bool taken =
        objects_.empty() || std::find(objects_.begin(), objects_.end(), node.mName.C_Str()) != objects_.end();
    for (unsigned i = 0; taken && i < node.mNumMeshes; ++i) append(*scene_.mMeshes[node.mMeshes[i]], world);
    for (unsigned i = 0; i < node.mNumChildren; ++i) append(*node.mChildren[i], world);
  }

  void append(const aiMesh& mesh, const aiMatrix4x4& world) {
    const bool textured = mesh.HasTextureCoords(0), mirrored = world.Determinant() < 0;
    const int first = static_cast<int>(model_.positions.size()), texcoord = static_cast<int>(model_.texcoords.size());
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D p = world * mesh.mVertices[v];
      model_.positions.push_back({p.x, p.y, p.z});
      if (!model_.positions.back().allFinite()) throw IoError(name_, "a vertex is not finite");
      if (textured) model_.texcoords.push_back({mesh.mTextureCoords[0][v].x, mesh.mTextureCoords[0][v].y});
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      if (mesh.mFaces[f].mNumIndices != 3) continue;  // lines and points
      Face face{{}, static_cast<int>(mesh.mMaterialIndex)};
      for (int k = 0; k < 3; ++k) {
        const int index = static_cast<int>(mesh.mFaces[f].mIndices[k]);
        face.corners[mirrored ? 2 - k : k] = {first + index, textured ? texcoord + index : -1};
      }
      model_.faces.push_back(face);
    }
  }

  const aiScene& scene_;
  std::string name_;
  std::span<const std::string> objects_;
  Model model_;
};

}  // namespace

Model read_assimp(const std::filesystem::path& path, std::span<const std::string> objects) {
  constexpr unsigned kSteps = aiProcess_Triangulate | aiProcess_ValidateDataStructure;
  Assimp::Importer importer;
  const aiScene* scene = nullptr;
  if (path.extension() == ".gz") {
    const std::string data = gunzip(path), kind = path.stem().extension().string();
    scene = importer.ReadFileFromMemory(data.data(), data.size(), kSteps, kind.empty() ? "" : kind.c_str() + 1);
  } else {
    scene = importer.ReadFile(path.string(), kSteps);
  }
  if (!scene || !scene->mRootNode) throw IoError(path.string(), std::string("not read: ") + importer.GetErrorString());
  const bool linear = path.extension() == ".gltf" || path.extension() == ".glb";
  Model model = SceneReader(*scene, path.string(), objects).read(linear);
  if (model.faces.empty()) throw IoError(path.string(), "no triangles");
  return model;
}

}  // namespace carve::artist
