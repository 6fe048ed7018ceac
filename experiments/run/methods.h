#pragma once
#include <span>
#include <string>

#include "carve/pipeline/reconstruct.h"
#include "run/settings.h"

namespace carve::experiments {

/// What a method is given: the drawings as pictures, as a user would have them, and as understood by the library.
struct MethodInput {
  std::map<View, Picture> pictures;
  std::map<View, Drawing> drawings;
  RunOptions options;
  unsigned seed = 1;
};

struct MethodOutput {
  Mesh mesh;
  TexturedMesh textured = {};  // the same with colours; without a texture if the method makes none
  std::vector<StageTime> times = {};
};

/// One way from drawings to a mesh. A new variant is one function and one line in the table.
struct Method {
  const char* name;
  const char* what;
  MethodOutput (*run)(const MethodInput&);
};

std::span<const Method> methods();
const Method* find_method(const std::string& name);  // null if there is none
std::string method_names();                          // "a, b, c"

}  // namespace carve::experiments
