#include "carve/texture/texture.h"

#include <stdexcept>

#include "carve/core/options.h"
#include "carve/texture/diffuse.h"

namespace carve {

TexturedMesh texture(Mesh mesh, const ViewSet& views, const TextureOptions& options, const AtlasOptions& atlas_options,
                     const Monitor& monitor) {
  check("texture", options);
  check("atlas", atlas_options);
  if (options.arm != TextureArm::blend && options.arm != TextureArm::best_view)
    throw std::invalid_argument("texture.arm must be blend or best_view to make a texture");
  if (mesh.triangles.empty()) throw std::invalid_argument("the mesh to be textured must have triangles");

  const Drawings drawings(views, options);
  const ViewChoice choice = choose_views(mesh, views, drawings, options);
  monitor.at("texture", 0.3);
  Atlas atlas = lay_out(mesh,
                        atlas_options.arm == AtlasArm::clusters ? cluster_charts(mesh, views, atlas_options)
                                                                : view_charts(mesh, views, choice),
                        atlas_options);
  monitor.at("texture", 0.6);
  const bool blend = options.arm == TextureArm::blend;
  const std::vector<Paint> paints = blend ? paint_by_normal(mesh, views, options.mirror) : paint_by_view(choice);
  const CornerColours corners = surface_colours(mesh, paints, choice.patch, drawings, blend ? 0 : options.level);
  TexturedMesh result;
  result.texture = bake(mesh, atlas, paints, drawings, corners, atlas_options.gutter);
  result.mesh = std::move(mesh);
  result.uvs = std::move(atlas.charts.uvs);
  for (Vec2& uv : result.uvs) uv /= atlas.size;
  result.uv_triangles = std::move(atlas.charts.triangles);
  return result;
}

}  // namespace carve
