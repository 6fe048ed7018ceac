#pragma once
#include <span>
#include <string>
#include <vector>

#include "carve/core/monitor.h"
#include "carve/photo/camera.h"
#include "models/model.h"
#include "photograph/solid_texture.h"

namespace carve {

/// What the object looks like; shading is Lambert's, without shadows or highlights.
enum class PhotoStyle {
  textured,       // noise_colour, lamps fixed to the model
  own,            // the model's colours and textures, lamps fixed to the model
  plain,          // grey, lamps fixed to the model: shading is a texture of its own
  plain_turning,  // grey, lamps fixed to the camera: a place is bright in one photo and dark in the next
  flat            // grey, no shading: nothing but the silhouette
};
inline std::span<const char* const> names(PhotoStyle) {
  static constexpr const char* all[] = {"textured", "own", "plain", "plain_turning", "flat"};
  return all;
}

struct PhotographOptions {
  PhotoStyle style = PhotoStyle::textured;
  int samples = 2;
  std::string background = "#000000";
};
template <class Visitor>
void visit_fields(PhotographOptions& o, Visitor&& field) {
  field("style", o.style, "what the object looks like");
  field("samples", o.samples, 1, 16, "rays a pixel, along each axis");
  field("background", o.background, "what is around the object, #rrggbb");
}

/// Photos of a model by rays (Embree; needs no display) \cite wald_2014. A pixel is the mean of samples x samples rays,
/// in sRGB values; normals are the triangles' own, so faceted models look faceted. The same input gives the same bytes.
/// \throws std::invalid_argument on an option out of range, or a model without triangles
std::vector<Photo> photograph(const Model& model, std::span<const Camera> cameras,
                              const PhotographOptions& options = {}, const SolidTextureOptions& texture = {},
                              const Monitor& monitor = {});

}  // namespace carve
