#include "carve/texture/choose_views.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "carve/core/options.h"
#include "carve/core/parallel.h"
#include "carve/mesh/neighbours.h"
#include "carve/texture/depth_map.h"
#include "carve/texture/potts.h"

namespace carve {
namespace {

constexpr double kAcross = 0.1;   // what a drawing of the side across costs more than one of this side
constexpr double kUnseen = 1.2;   // what no drawing costs more
constexpr double kUnit = 1000;    // cost of a mean triangle
constexpr double kLargest = 1e8;  // of a cost or weight

std::vector<Projection> all_projections(const ViewSet& views, Mirror mirror) {
  std::vector<Projection> all;
  const auto drawn = [&](SignedAxis toward) {
    return std::ranges::any_of(views.views, [&](const AlignedView& v) {
      const SignedAxis t = frame(v.view).toward;
      return t.axis == toward.axis && t.sign == toward.sign;
    });
  };
  all.reserve(2 * views.views.size());
  for (int i = 0; i < static_cast<int>(views.views.size()); ++i) all.push_back({i, frame(views.views[i].view).toward});
  for (int i = 0; i < static_cast<int>(views.views.size()) && mirror != Mirror::no; ++i) {
    const SignedAxis toward = frame(views.views[i].view).toward, across{toward.axis, -toward.sign};
    if (!drawn(across)) all.push_back({i, across});
  }
  for (int axis = 0; axis < 3; ++axis)
    for (const int sign : {1, -1}) all.push_back({-1, {axis, sign}});
  return all;
}

double along(const Vec3& v, SignedAxis axis) { return axis.sign * v[axis.axis]; }

// Normals averaged over the rings around each triangle, so that the grid's steps do not show.
std::vector<Vec3> smoothed_normals(const Mesh& mesh, const std::vector<Vec3>& normals) {
  constexpr int kRounds = 3;
  std::vector<Vec3> smooth = normals, at_vertices;
  for (int round = 0; round < kRounds; ++round) {
    at_vertices.assign(mesh.positions.size(), Vec3::Zero());
    for (std::size_t t = 0; t < smooth.size(); ++t)
      for (const int v : mesh.triangles[t]) at_vertices[v] += smooth[t];
    for (std::size_t t = 0; t < smooth.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      smooth[t] =
          (at_vertices[a].normalized() + at_vertices[b].normalized() + at_vertices[c].normalized()).normalized();
    }
  }
  return smooth;
}

class Chooser {
 public:
  Chooser(const Mesh& mesh, const ViewSet& views, const Drawings& drawings, const TextureOptions& options)
      : mesh_(mesh),
        views_(views),
        drawings_(drawings),
        options_(options),
        normals_(triangle_normals(mesh)),
        smooth_(smoothed_normals(mesh, normals_)),
        neighbours_(triangle_neighbours(mesh)),
        symmetric_(is_symmetric(views)) {
    maps_.reserve(views.views.size());
    for (const AlignedView& view : views.views) maps_.emplace_back(mesh, view);
  }

  ViewChoice choose() {
    ViewChoice choice{all_projections(views_, options_.mirror), {}, {}, 0};
    PottsProblem problem{static_cast<int>(choice.projections.size()), {}, {}};
    set_scale();
    fill_costs(choice.projections, problem);
    add_seams(problem);
    choice.projection = minimise(problem);
    find_patches(choice);
    if (absorb_specks(choice)) find_patches(choice);
    return choice;
  }

 private:
  const Vec3& corner(int t, int k) const { return mesh_.positions[mesh_.triangles[t][k]]; }

  void set_scale() {
    areas_.resize(mesh_.triangles.size());
    double sum = 0;
    for (int t = 0; t < static_cast<int>(areas_.size()); ++t)
      sum += areas_[t] = (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).norm() / 2;
    per_area_ = sum > 0 ? kUnit * static_cast<double>(areas_.size()) / sum : 0;
  }
  int scaled(double area) const { return static_cast<int>(std::min(area * per_area_, kLargest)); }

  void fill_costs(const std::vector<Projection>& projections, PottsProblem& problem) const {
    problem.costs.resize(mesh_.triangles.size() * projections.size());
    parallel_ranges(0, static_cast<int>(mesh_.triangles.size()), 2048, [&](int first, int last) {
      std::vector<Witness> witnesses;
      for (int t = first; t < last; ++t) {
        int* costs = &problem.costs[t * projections.size()];
        witnesses.clear();
        for (std::size_t p = 0; p < projections.size(); ++p) {
          costs[p] = cost(t, projections[p]);
          const bool direct = projections[p].view >= 0 && !is_across(projections[p]);
          if (direct && costs[p] < PottsProblem::kImpossible)
            witnesses.push_back({along(normals_[t], projections[p].toward), colour(t, projections[p].view)});
        }
        for (std::size_t p = 0; p < projections.size() && !witnesses.empty(); ++p)
          if (costs[p] < PottsProblem::kImpossible)
            costs[p] += scaled(options_.agree * areas_[t] * contradiction(witnesses, t, projections[p]));
      }
    });
  }

  // What a drawing that sees a triangle shows there, and how much of it.
  struct Witness {
    double cosine;
    Colour colour;
  };
  Colour colour(int t, int view) const {
    return drawings_.at({{{view, 1}, {}, {}}}, (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3);
  }
  // A drawing that sees the triangle at an angle has less to say against one that sees it straight, as small errors of
  // the shape move its colours far. A guess must give way to all that is drawn; taking no drawing where one could be
  // taken is as wrong as a colour can be.
  double contradiction(const std::vector<Witness>& witnesses, int t, const Projection& projection) const {
    constexpr double kLargest = 441.7;  // black to white
    const bool none = projection.view < 0, guess = none || (is_across(projection) && !is_mirrored(projection));
    const Colour taken = none ? Colour(Colour::Zero()) : colour(t, projection.view);
    double sum = 0;
    for (const Witness& witness : witnesses)
      sum += witness.cosine * (guess ? 1 : witness.cosine) * (none ? kLargest : (witness.colour - taken).norm()) / 255;
    return sum;
  }
  bool is_across(const Projection& projection) const {
    return projection.toward.sign != frame(views_.views[projection.view].view).toward.sign;
  }

  // The other side of a symmetric object looks the same.
  bool is_mirrored(const Projection& projection) const { return projection.toward.axis == 0 && symmetric_; }

  int cost(int t, const Projection& projection) const {
    const double straight = along(normals_[t], projection.toward), angle = 1 - along(smooth_[t], projection.toward);
    if (projection.view < 0) {
      // The best axis is seen at cos >= 1 / sqrt(3); a triangle without area can take any.
      const bool fits = straight > 0.5 || normals_[t].isZero();
      return fits ? scaled(areas_[t] * (kUnseen + 1 - straight)) : PottsProblem::kImpossible;
    }
    if (straight < std::cos(options_.steepest * std::numbers::pi / 180) || !sees(t, projection, straight))
      return PottsProblem::kImpossible;
    return scaled(areas_[t] * (angle + (is_across(projection) ? kAcross : 0)));
  }

  // Three of four points of the triangle lie on the nearest (for the side across: farthest) surface.
  bool sees(int t, const Projection& projection, double straight) const {
    const DepthMap& map = maps_[projection.view];
    const bool across = is_across(projection);
    const bool anywhere = !across || options_.mirror == Mirror::yes || is_mirrored(projection);
    // A surface seen at an angle differs in depth within a pixel.
    const double slope = std::min(4.0, std::sqrt(1 - straight * straight) / straight);
    const double bias = map.pixel() * (1 + slope);
    const Vec3 centre = (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3;
    int seen = 0;
    for (int k = -1; k < 3; ++k) {
      const Vec3 point = k < 0 ? centre : Vec3((centre + corner(t, k)) / 2);
      const auto [nearest, farthest] = map.at(point);
      const double depth = map.depth(point);
      const bool outermost = nearest < farthest || (across ? depth <= farthest + bias : depth >= nearest - bias);
      seen += outermost && (anywhere || nearest - depth <= options_.thin);
    }
    return seen >= 3;
  }

  // Along a crease a seam hardly shows.
  void add_seams(PottsProblem& problem) const {
    for (int t = 0; t < static_cast<int>(neighbours_.size()); ++t)
      for (int k = 0; k < 3; ++k) {
        const int other = neighbours_[t][k];
        if (other <= t) continue;
        const double flat = std::max(0.0, normals_[t].dot(normals_[other]));
        const double length = (corner(t, k) - corner(t, (k + 1) % 3)).norm();
        problem.edges.push_back({t, other, scaled(options_.seam * length * (0.25 + 0.75 * flat))});
      }
  }

  // Patches of a few triangles, as slivers along creases make them, go to the neighbour they share most border with,
  // if all of them look its way.
  bool absorb_specks(ViewChoice& choice) const {
    constexpr double kSpeck = 12;  // mean triangles
    const double largest = kSpeck * kUnit / per_area_;
    std::vector<double> area(choice.patches);
    for (std::size_t t = 0; t < areas_.size(); ++t) area[choice.patch[t]] += areas_[t];
    std::vector<std::vector<int>> specks(choice.patches);
    for (int t = 0; t < static_cast<int>(areas_.size()); ++t)
      if (area[choice.patch[t]] < largest) specks[choice.patch[t]].push_back(t);
    bool changed = false;
    for (const std::vector<int>& speck : specks) {
      std::vector<double> border(choice.projections.size());
      for (const int t : speck)
        for (int k = 0; k < 3; ++k)
          if (const int other = neighbours_[t][k]; other >= 0 && area[choice.patch[other]] >= largest)
            border[choice.projection[other]] += (corner(t, k) - corner(t, (k + 1) % 3)).norm();
      const auto looks_its_way = [&](std::size_t p) {
        return std::ranges::all_of(speck,
                                   [&](int t) { return along(normals_[t], choice.projections[p].toward) > 0.1; });
      };
      for (std::size_t p = 0; p < border.size(); ++p)
        if (border[p] > 0 && !looks_its_way(p)) border[p] = 0;
      const auto longest = std::ranges::max_element(border);
      if (longest == border.end() || *longest == 0) continue;
      for (const int t : speck) choice.projection[t] = static_cast<int>(longest - border.begin());
      changed = true;
    }
    return changed;
  }

  void find_patches(ViewChoice& choice) const {
    choice.patches = 0;
    choice.patch.assign(choice.projection.size(), -1);
    std::vector<int> open;
    for (int t = 0; t < static_cast<int>(choice.patch.size()); ++t) {
      if (choice.patch[t] >= 0) continue;
      choice.patch[t] = choice.patches;
      open.assign(1, t);
      while (!open.empty()) {
        const int here = open.back();
        open.pop_back();
        for (const int next : neighbours_[here])
          if (next >= 0 && choice.patch[next] < 0 && choice.projection[next] == choice.projection[here]) {
            choice.patch[next] = choice.patches;
            open.push_back(next);
          }
      }
      ++choice.patches;
    }
  }

  const Mesh& mesh_;
  const ViewSet& views_;
  const Drawings& drawings_;
  const TextureOptions& options_;
  std::vector<Vec3> normals_, smooth_;
  std::vector<std::array<int, 3>> neighbours_;
  std::vector<double> areas_;
  std::vector<DepthMap> maps_;
  double per_area_ = 0;
  bool symmetric_;
};

}  // namespace

bool is_symmetric(const ViewSet& views) {
  std::int64_t both = 0, either = 0;
  for (const AlignedView& view : views.views) {
    if (frame(view.view).right.axis != 0) continue;
    const Mask& coverage = view.drawing.coverage;
    const Box& box = view.drawing.bounds;
    for (int y = box.y0; y < box.y1; ++y)
      for (int x = box.x0; x < box.x1; ++x) {
        const int mirrored = static_cast<int>(std::floor(2 * view.column0 - (x + 0.5)));
        const bool a = coverage(x, y) >= 128, b = coverage.contains(mirrored, y) && coverage(mirrored, y) >= 128;
        both += a && b, either += a || b;
      }
  }
  return either > 0 && static_cast<double>(both) >= 0.85 * static_cast<double>(either);
}

ViewChoice choose_views(const Mesh& mesh, const ViewSet& views, const Drawings& drawings,
                        const TextureOptions& options) {
  check("texture", options);
  return Chooser(mesh, views, drawings, options).choose();
}

}  // namespace carve
