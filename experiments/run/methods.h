#pragma once
#include <span>
#include <string>

#include "carve/pipeline/reconstruct.h"
#include "run/settings.h"

namespace carve::experiments {

/// Photos with known cameras, and the box that the object lies in.
struct PhotoInput {
  std::vector<Photo> photos = {};
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
};

/// What a method is given: the drawings as pictures, as a user would have them, and as understood by the library.
struct MethodInput {
  std::map<View, Picture> pictures;
  std::map<View, Drawing> drawings;
  RunOptions options;
  unsigned seed = 1;
  PhotoInput photos = {};  // for methods that ask for them
};

struct MethodOutput {
  Mesh mesh = {};
  TexturedMesh textured = {};  // the same with colours; without a texture if the method makes none
  std::vector<StageTime> times = {};
  std::vector<Vec3> points = {};                       // that the mesh was made from, if it was
  std::map<std::string, std::string> provenance = {};  // of what other programs did
};

/// One way from drawings to a mesh. A new variant is one function and one line in the table.
struct Method {
  const char* name;
  const char* what;
  MethodOutput (*run)(const MethodInput&);
  bool photos = false;  // it needs photos, and so a base model to take them of
};

std::span<const Method> methods();
const Method* find_method(const std::string& name);  // null if there is none
std::string method_names();                          // "a, b, c"

}  // namespace carve::experiments
