#pragma once
#include <vector>

#include "carve/mesh/mesh.h"
#include "carve/texture/drawings.h"

namespace carve {

/// A parallel projection of the surface: of triangles that look along `toward`, with the colours of a drawing or none.
struct Projection {
  int view;           // index of ViewSet::views; -1: seen in no drawing
  SignedAxis toward;  // the side it is seen from; the drawing's own, or the one across

  bool operator==(const Projection& o) const {
    return view == o.view && toward.axis == o.toward.axis && toward.sign == o.toward.sign;
  }
};

/// Which projection each triangle takes. A patch is a set of triangles with one projection that hang together by edges.
struct ViewChoice {
  std::vector<Projection> projections;
  std::vector<int> projection;  // per triangle
  std::vector<int> patch;       // per triangle; numbered by their first triangles
  int patches = 0;
};

/// One drawing a triangle, by graph cut \cite lempitsky_2007: a triangle costs its area times 1 - cos of the angle it
/// is seen at (normals smoothed), a seam its length times options.seam, less along creases. A drawing can be taken only
/// where it sees the triangle (DepthMap; 3 of 4 points) at most at options.steepest; a drawing of the side across only
/// as options.mirror says. What nothing can colour is projected along the best of the six axes, seen at 55 degrees at
/// most. \throws std::invalid_argument on an option out of range or a mesh that check_mesh refuses
ViewChoice choose_views(const Mesh& mesh, const ViewSet& views, const Drawings& drawings,
                        const TextureOptions& options = {});

/// Whether the drawings that show left and right, seen in a mirror, are the same shapes (IoU of at least 0.85).
bool is_symmetric(const ViewSet& views);

}  // namespace carve
