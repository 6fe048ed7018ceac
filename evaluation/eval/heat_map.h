#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "carve/mesh/mesh.h"
#include "eval/ramp.h"

namespace carve {

struct HeatMapOptions {
  Ramp ramp = Ramp::thesis;
  std::optional<double> range = {};  // automatic: see heat_range
  std::vector<std::string> views = {"front", "side", "top", "three_quarter"};
  int size = 400;
  bool show_reference = false;
};
template <class Visitor>
void visit_fields(HeatMapOptions& o, Visitor&& field) {
  field("ramp", o.ramp, "thesis: blue shrunk, green near, yellow inflated, red far; the others: colour-blind safe");
  field("range", o.range, 1e-9, 1e9, "distance of the ramp's end, % of the reference's diagonal");
  field("views", o.views, "front, side, top, back, left, bottom, three_quarter or AZIMUTH:ELEVATION in degrees");
  field("size", o.size, 64, 4096, "pixels along the longest side of all meshes' common box");
  field("show_reference", o.show_reference, "the reference in grey as the first column");
}

/// A compared mesh with the signed distance of every vertex (eval/signed_distance.h).
struct HeatMap {
  std::string title;
  Mesh mesh;
  std::vector<double> distances;
};

/// The same surface with every edge longer than `longest` halved until none is: distances known at vertices alone say
/// nothing of what lies inside a large triangle. Triangles stay joined; the first vertices are the mesh's own.
Mesh with_short_edges(const Mesh& mesh, double longest);

/// The ramp's end in the model's unit: options.range, or the 99th percentile of all |distances|, rounded up to
/// 1, 1.5, 2, 3, 4, 5, 6 or 8 times a power of ten in % of the diagonal.
double heat_range(const std::vector<HeatMap>& maps, double diagonal, const HeatMapOptions& options);

/// Share of vertices whose colour is that of the range's end.
double saturated_share(const HeatMap& map, double range);

/// A figure on one scale: a column a mesh and a row a view (one mesh alone: a column a view), titles with mean, max and
/// saturation, colour bar. Needs no display. \throws std::invalid_argument: no mesh, unknown view, options out of range
Picture draw_heat_maps(const std::vector<HeatMap>& maps, const Mesh& reference, double diagonal,
                       const HeatMapOptions& options = {});

/// Binary PLY with per-vertex `quality` (read by MeshLab) and `scalar_C2M` (read by CloudCompare), both the signed
/// distance, and red green blue. \throws IoError
void write_heat_ply(const std::filesystem::path& path, const HeatMap& map, Ramp ramp, double range);
/// VTK XML PolyData for ParaView: point data `C2M` and `colour`. \throws IoError
void write_heat_vtp(const std::filesystem::path& path, const HeatMap& map, Ramp ramp, double range);

/// Refuses what write_heat_maps cannot do before anything is computed. \throws std::invalid_argument: another ending
/// than .png, .ply or .vtp; several meshes for one .ply or .vtp
void check_heat_output(const std::filesystem::path& path, std::size_t maps);
/// A figure of all maps (.png) or the one coloured mesh (.ply, .vtp), by the name's ending.
void write_heat_maps(const std::filesystem::path& path, const std::vector<HeatMap>& maps, const Mesh& reference,
                     double diagonal, const HeatMapOptions& options = {});

}  // namespace carve
