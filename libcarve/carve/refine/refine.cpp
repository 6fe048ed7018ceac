#include "carve/refine/refine.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "carve/core/options.h"
#include "carve/mesh/adjacency.h"
#include "carve/mesh/self_intersections.h"
#include "carve/mesh/topology.h"

namespace carve {
namespace {

struct Stage {
  const char* name;
  Mesh (*run)(const Mesh&, const RefineOptions&, const ViewSet&);
};

template <Mesh (*Run)(const Mesh&, const StageOptions&)>
Mesh with_stage_options(const Mesh& mesh, const RefineOptions& options, const ViewSet&) {
  return Run(mesh, options.stages);
}

Mesh fit_to_views(const Mesh& mesh, const RefineOptions& options, const ViewSet& views) {
  return fit(mesh, views, options.fit);
}

Mesh decimate_to_faces(const Mesh& mesh, const RefineOptions& options, const ViewSet&) {
  return decimate(mesh, *options.faces);
}

constexpr Stage kStages[] = {
    {"remesh", with_stage_options<remesh>},
    {"smooth_shape", with_stage_options<smooth_shape>},
    {"angle_and_area", with_stage_options<angle_and_area>},
    {"tangential", with_stage_options<tangential>},
    {"segment", with_stage_options<segment>},
    {"fit", fit_to_views},
    {"decimate", decimate_to_faces},
    {"alpha_wrap", with_stage_options<alpha_wrap>},
};

using Pairs = std::vector<std::pair<int, int>>;

/// A mesh and what the stages must not make worse.
struct Checked {
  Mesh mesh;
  Topology topology;
  Pairs meeting;  // pairs of triangles
};

Checked checked(Mesh mesh) {
  Checked result{std::move(mesh), {}, {}};
  result.topology = topology(result.mesh);
  if (result.topology.solid()) result.meeting = self_intersections(result.mesh);
  return result;
}

/// Empty if the mesh is no worse than before.
std::string what_broke(const Checked& before, const Checked& after) {
  if (!after.topology.solid()) return "it is no longer closed, oriented and 2-manifold";
  if (!(after.topology.volume > 0)) return "it is turned inside out";
  if (after.topology.degenerate_triangles > before.topology.degenerate_triangles)
    return std::to_string(after.topology.degenerate_triangles) + " triangles have no area";
  if (after.meeting.size() > before.meeting.size())
    return std::to_string(after.meeting.size()) + " pairs of triangles meet, " + std::to_string(before.meeting.size()) +
           " before";
  return {};
}

/// Puts vertices around what broke back where they were, in ever larger neighbourhoods.
class PutBack {
 public:
  PutBack(const Checked& before, std::size_t vertices)
      : before_(before), around_(vertex_triangles(before.mesh)), back_(vertices) {}

  Checked operator()(Checked after) {
    for (int rings = 1; rings <= kMostRings && !what_broke(before_, after).empty(); rings *= 2) {
      mark(broken(after), rings);
      for (std::size_t v = 0; v < back_.size(); ++v)
        if (back_[v]) after.mesh.positions[v] = before_.mesh.positions[v];
      after = checked(std::move(after.mesh));
    }
    return after;
  }

  std::int64_t count() const { return std::count(back_.begin(), back_.end(), 1); }

 private:
  static constexpr int kMostRings = 16;

  /// The triangles that meet, and did not before, or have no area.
  std::vector<int> broken(const Checked& after) const {
    std::vector<int> triangles;
    for (const auto& pair : after.meeting)
      if (!std::binary_search(before_.meeting.begin(), before_.meeting.end(), pair))
        triangles.insert(triangles.end(), {pair.first, pair.second});
    if (after.topology.degenerate_triangles > before_.topology.degenerate_triangles)
      for (std::size_t t = 0; t < after.mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = after.mesh.triangles[t];
        const Mesh one{{after.mesh.positions[a], after.mesh.positions[b], after.mesh.positions[c]}, {{0, 1, 2}}};
        if (topology(one).degenerate_triangles) triangles.push_back(static_cast<int>(t));
      }
    return triangles;
  }

  void mark(const std::vector<int>& triangles, int rings) {
    std::vector<std::uint8_t> seen(back_.size());
    std::vector<int> front, next;
    const auto visit = [&](int triangle, std::vector<int>& found) {
      for (const int v : before_.mesh.triangles[triangle])
        if (!std::exchange(seen[v], 1)) found.push_back(v);
    };
    for (const int t : triangles) visit(t, front);
    for (int ring = 0; ring < rings; ++ring, front.swap(next)) {
      next.clear();
      for (const int v : front)
        for (const int t : around_[v]) visit(t, next);
    }
    for (std::size_t v = 0; v < back_.size(); ++v) back_[v] |= seen[v];
  }

  const Checked& before_;
  const VertexTriangles around_;
  std::vector<std::uint8_t> back_;
};

/// The stages to run; names were checked.
std::vector<const Stage*> plan(const RefineOptions& options, const ViewSet& views) {
  check("refine", options);
  if (options.faces && *options.faces < 4)
    throw std::invalid_argument("faces must be at least 4, got " + std::to_string(*options.faces));
  std::vector<const Stage*> stages;
  for (const std::string& name : options.arm) {
    const auto stage = std::ranges::find(kStages, name, [](const Stage& s) { return std::string(s.name); });
    if (stage == std::end(kStages)) {
      throw std::invalid_argument("refine.arm must name stages of " + refinement_names() + ", got " + name);
    }
    stages.push_back(stage);
  }
  const Stage* const decimate_stage = std::ranges::find(kStages, &decimate_to_faces, &Stage::run);
  const bool named = std::ranges::count(stages, decimate_stage) > 0;
  if (options.faces && !named) stages.push_back(decimate_stage);
  if (named && !options.faces) throw std::invalid_argument("refine.arm names decimate: faces must say how many");
  if (views.views.empty() && std::ranges::any_of(stages, [](const Stage* s) { return s->run == fit_to_views; }))
    throw std::invalid_argument("refine.arm names fit: there must be views to fit to");
  return stages;
}

/// The mesh after the stage, or before it where that cannot be mended.
Checked run(const Stage& stage, Checked before, const RefineOptions& options, const ViewSet& views,
            RefinementStep& step) {
  if (stage.run == with_stage_options<alpha_wrap> && before.meeting.empty() && !options.stages.wrap_always)
    return before;
  Checked after;
  try {
    after = checked(stage.run(before.mesh, options, views));
  } catch (const std::invalid_argument&) {
    throw;
  } catch (const std::logic_error&) {  // CGAL's own checks, where a build has them
    step.why = "it met a shape that it cannot work on";
    step.kept = false;
    return before;
  }
  step.why = what_broke(before, after);
  if (!step.why.empty() && after.mesh.triangles == before.mesh.triangles) {
    PutBack put_back(before, after.mesh.positions.size());
    after = put_back(std::move(after));
    if (what_broke(before, after).empty()) {
      step.put_back = put_back.count();
      return after;
    }
  }
  step.kept = step.why.empty();
  if (step.kept && stage.run == decimate_to_faces && after.topology.triangles > 1.01 * *options.faces)
    step.why = std::to_string(*options.faces) + " triangles were asked for";
  return step.kept ? after : before;
}

}  // namespace

std::string refinement_names() {
  std::string all;
  for (const Stage& stage : kStages) all += (all.empty() ? "" : ", ") + std::string(stage.name);
  return all;
}

RefinedMesh refine(Mesh mesh, const RefineOptions& options, const ViewSet& views, const Monitor& monitor) {
  const std::vector<const Stage*> stages = plan(options, views);
  RefinedMesh result;
  if (stages.empty()) {
    result.mesh = std::move(mesh);
    return result;
  }
  Checked now = checked(std::move(mesh));
  if (!now.topology.solid()) throw std::invalid_argument("mesh must be closed, oriented and 2-manifold to be refined");
  for (const Stage* stage : stages) {
    monitor.at(stage->name, static_cast<double>(result.steps.size()) / static_cast<double>(stages.size()));
    const auto start = std::chrono::steady_clock::now();
    RefinementStep step{stage->name};
    now = run(*stage, std::move(now), options, views, step);
    step.triangles = now.topology.triangles;
    step.self_intersections = static_cast<std::int64_t>(now.meeting.size());
    step.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    result.steps.push_back(std::move(step));
  }
  result.mesh = std::move(now.mesh);
  return result;
}

}  // namespace carve
