#pragma once
#include <vector>

#include "carve/mesh/mesh.h"
#include "carve/texture/choose_views.h"
#include "carve/texture/options.h"

namespace carve {

/// Pieces of the surface laid flat, each in a plane of its own. Triangles are counter-clockwise with v pointing up, so
/// clockwise as texels are counted (v down).
struct Charts {
  std::vector<Vec2> uvs;            // per chart and vertex; in texels at scale 1
  std::vector<Triangle> triangles;  // per triangle of the mesh, indices of uvs
  std::vector<int> chart;           // per triangle of the mesh
  int count = 0;
  std::vector<double> height = {};  // per triangle; where two overlap, the lower one goes to a chart of its own
};

/// Where every triangle lies on the texture.
struct Atlas {
  int size = 0;       // texels along a side
  double scale = 0;   // texels a pixel of the drawings
  Charts charts;      // uvs in texels of the texture, in [0, size]
  Raster<int> owner;  // the triangle whose colour a texel has, by its centre; -1 = none
};

/// Charts of ViewChoice's patches (`view_charts`): their coordinates are the drawing's pixels, mirrored where the
/// drawing is of the side across, so a texel can be one pixel. Parts no drawing shows are laid out at half the density.
Charts view_charts(const Mesh& mesh, const ViewSet& views, const ViewChoice& choice);

/// Charts by planarity and compactness, the thesis's arm \cite sander_2001: beginning with single triangles, the two
/// neighbours that make the flattest and roundest chart are joined, until options.max_clusters are left or none would
/// stay within options.max_distortion of a plane (root mean square). A chart is unfolded by a least squares conformal
/// map \cite levy_2002 or projected onto its plane, whichever distorts less. One that neither lays out with all
/// triangles face up and a symmetric Dirichlet energy of at most 5 is cut up into charts whose triangles look at most
/// 75 degrees away from their plane, so that none is stretched more than 3.9 times where they are projected.
Charts cluster_charts(const Mesh& mesh, const ViewSet& views, const AtlasOptions& options = {});

/// Packs charts into a square, options.gutter texels apart, at one scale: with options.exact the largest whole number
/// that fits, if 1 does; else the largest found. Triangles on whose texels others of their chart lie get charts of
/// their own, so that no texel's centre lies in two triangles. \throws NoResult if the charts do not fit at any scale
Atlas lay_out(const Mesh& mesh, Charts charts, const AtlasOptions& options = {});

}  // namespace carve
