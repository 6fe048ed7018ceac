#include "carve/texture/unfold.h"

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/LSCM_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/parameterize.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>

#include "carve/mesh/uv_jacobian.h"
#include "carve/texture/chart_uvs.h"

namespace carve {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
namespace Parameterization = CGAL::Surface_mesh_parameterization;

// Of a map from a chart's surface to the plane: integrals over the surface of the squared norms of its Jacobian and of
// the inverse.
struct Distortion {
  double area = 0, stretch = 0, shrink = 0;
  bool flipped = false;

  double best_scale() const { return std::sqrt(std::sqrt(shrink / stretch)); }
  double energy(double scale) const {  // mean symmetric Dirichlet energy
    return flipped || !std::isfinite(stretch + shrink) ? std::numeric_limits<double>::infinity()
           : area == 0                                 ? 4
                                                       : (stretch * scale * scale + shrink / (scale * scale)) / area;
  }
};

class Unfolding {
 public:
  Unfolding(const Mesh& mesh, Charts& charts) : mesh_(mesh), charts_(charts), local_(charts.uvs.size(), -1) {}

  // Of one chart's triangles; their energy.
  double unfold(std::span<const int> triangles, double density) {
    const double before = distortion(triangles, [&](int uv) { return charts_.uvs[uv]; }).energy(1 / density);
    std::vector<int> uvs;
    const std::vector<Vec2> flat = conformal(triangles, uvs);
    double energy = before;
    if (!flat.empty()) {
      const Distortion after = distortion(triangles, [&](int uv) { return flat[local_[uv]]; });
      const double scale = after.best_scale();
      energy = std::min(before, after.energy(scale));
      if (energy < before) take(uvs, flat, density * scale);
    }
    for (const int i : uvs) local_[i] = -1;
    return energy;
  }

 private:
  // Places of the coordinates `uvs`; none if the chart is not a disk.
  std::vector<Vec2> conformal(std::span<const int> triangles, std::vector<int>& uvs) {
    Surface surface;
    if (!build(triangles, surface, uvs)) return {};
    std::vector<Surface::Halfedge_index> borders;
    CGAL::Polygon_mesh_processing::extract_boundary_cycles(surface, std::back_inserter(borders));
    const auto count = [](auto size) { return static_cast<long>(size); };
    const long euler =
        count(surface.number_of_vertices()) - count(surface.number_of_edges()) + count(surface.number_of_faces());
    if (borders.size() != 1 || euler != 1) return {};
    auto map = surface.add_property_map<Surface::Vertex_index, Kernel::Point_2>("v:uv").first;
    using Lscm = Parameterization::LSCM_parameterizer_3<Surface>;
    if (Parameterization::parameterize(surface, Lscm(), borders[0], map) != Parameterization::OK) return {};
    std::vector<Vec2> flat;
    for (const Surface::Vertex_index v : surface.vertices())
      flat.emplace_back(map[v].x(), -map[v].y());  // v points down
    return flat;
  }

  bool build(std::span<const int> triangles, Surface& surface, std::vector<int>& uvs) {
    for (const int t : triangles) {
      Surface::Vertex_index corner[3];
      for (int k = 0; k < 3; ++k) {
        const int uv = charts_.triangles[t][k];
        if (local_[uv] < 0) {
          local_[uv] = static_cast<int>(uvs.size());
          uvs.push_back(uv);
          const Vec3& p = mesh_.positions[mesh_.triangles[t][k]];
          surface.add_vertex({p.x(), p.y(), p.z()});
        }
        corner[k] = Surface::Vertex_index(static_cast<unsigned>(local_[uv]));
      }
      if (surface.add_face(corner[0], corner[1], corner[2]) == Surface::null_face()) return false;
    }
    return true;
  }

  template <class Place>
  Distortion distortion(std::span<const int> triangles, const Place& place) const {
    Distortion sum;
    for (const int t : triangles) {
      const auto& [i, k, l] = mesh_.triangles[t];
      const Vec3 &a = mesh_.positions[i], &b = mesh_.positions[k], &c = mesh_.positions[l];
      const double area = (b - a).cross(c - a).norm() / 2;
      if (area < 1e-14) continue;
      const auto& [at_a, at_b, at_c] = charts_.triangles[t];
      const Eigen::Matrix2d j = uv_jacobian(a, b, c, place(at_a), place(at_b), place(at_c));
      if (!(j.determinant() > 0)) {
        sum.flipped = true;
        continue;
      }
      sum.area += area, sum.stretch += area * j.squaredNorm(), sum.shrink += area * j.inverse().squaredNorm();
    }
    return sum;
  }

  // Turned so that the chart lies as it did.
  void take(const std::vector<int>& uvs, const std::vector<Vec2>& flat, double scale) {
    Vec2 centre = Vec2::Zero(), flat_centre = Vec2::Zero();
    for (std::size_t i = 0; i < uvs.size(); ++i) centre += charts_.uvs[uvs[i]], flat_centre += flat[i];
    centre /= static_cast<double>(uvs.size()), flat_centre /= static_cast<double>(uvs.size());
    double cosine = 0, sine = 0;
    for (std::size_t i = 0; i < uvs.size(); ++i) {
      const Vec2 a = flat[i] - flat_centre, b = charts_.uvs[uvs[i]] - centre;
      cosine += a.dot(b), sine += a.x() * b.y() - a.y() * b.x();
    }
    const Eigen::Rotation2Dd turn(std::atan2(sine, cosine));
    for (std::size_t i = 0; i < uvs.size(); ++i)
      charts_.uvs[uvs[i]] = centre + scale * (turn * (flat[i] - flat_centre));
  }

  const Mesh& mesh_;
  Charts& charts_;
  std::vector<int> local_;  // per coordinate its vertex of the surface at hand
};

}  // namespace

std::vector<double> unfold(const Mesh& mesh, double density, Charts& charts) {
  std::vector<double> energies(charts.count);
  const std::vector<int> order = sorted_by(charts.chart, charts.count);
  Unfolding unfolding(mesh, charts);
  for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
    while (last < order.size() && charts.chart[order[last]] == charts.chart[order[first]]) ++last;
    energies[charts.chart[order[first]]] = unfolding.unfold(std::span(order).subspan(first, last - first), density);
  }
  return energies;
}

}  // namespace carve
