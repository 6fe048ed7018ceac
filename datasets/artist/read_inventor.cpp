#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoInteraction.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/errors/SoError.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoShape.h>

#include <map>

#include "artist/readers.h"
#include "carve/core/error.h"

namespace carve::artist {
namespace {

struct Collector {
  Model model;
  std::map<std::uint32_t, int> materials;  // by packed colour
};

void add_triangle(void* data, SoCallbackAction* action, const SoPrimitiveVertex* a, const SoPrimitiveVertex* b,
                  const SoPrimitiveVertex* c) {
  auto& [model, materials] = *static_cast<Collector*>(data);
  SbColor ambient, diffuse, specular, emission;
  float shininess = 0, transparency = 0;
  action->getMaterial(ambient, diffuse, specular, emission, shininess, transparency, a->getMaterialIndex());
  const auto [found, fresh] = materials.try_emplace(diffuse.getPackedValue(), static_cast<int>(model.materials.size()));
  if (fresh) model.materials.push_back({"", Vec3(diffuse[0], diffuse[1], diffuse[2])});
  const SbMatrix& world = action->getModelMatrix();
  Face face{{}, found->second};
  for (int k = 0; const SoPrimitiveVertex* vertex : {a, b, c}) {
    SbVec3f p;
    world.multVecMatrix(vertex->getPoint(), p);
    face.corners[k++].position = static_cast<int>(model.positions.size());
    model.positions.push_back({p[0], p[1], p[2]});
  }
  if (world.det4() < 0) std::swap(face.corners[1], face.corners[2]);
  model.faces.push_back(face);
}

// libCoin prints what is wrong with a file; the first of it becomes our error's text.
void keep_first(const SoError* error, void* data) {
  auto& text = *static_cast<std::string*>(data);
  if (text.empty()) text = error->getDebugString().getString();
}

}  // namespace

Model read_inventor(const std::filesystem::path& path) {
  SoDB::init();
  SoInteraction::init();
  std::string complaint;
  SoErrorCB* const handler = SoError::getHandlerCallback();
  void* const handler_data = SoError::getHandlerData();
  SoError::setHandlerCallback(keep_first, &complaint);
  SoInput input;
  SoSeparator* root = input.openFile(path.c_str(), TRUE) ? SoDB::readAll(&input) : nullptr;
  SoError::setHandlerCallback(handler, handler_data);
  if (!root || !complaint.empty()) {
    if (root) {
      root->ref();
      root->unref();
    }
    complaint = complaint.substr(0, complaint.find('\n'));
    throw IoError(path.string(), "not an Inventor file, or a broken one" + (complaint.empty() ? "" : ": " + complaint));
  }
  root->ref();
  Collector collector;
  SoCallbackAction action;
  action.addTriangleCallback(SoShape::getClassTypeId(), add_triangle, &collector);
  action.apply(root);
  root->unref();
  for (const Vec3& p : collector.model.positions)
    if (!p.allFinite()) throw IoError(path.string(), "a vertex is not finite");
  if (collector.model.faces.empty()) throw IoError(path.string(), "no triangles");
  return std::move(collector.model);
}

}  // namespace carve::artist
