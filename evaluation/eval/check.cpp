#include "eval/check.h"

#include <nlohmann/json.hpp>
#include <ostream>

#include "carve/mesh/self_intersections.h"

namespace carve {

std::string MeshReport::why_not() const {
  std::string why;
  const auto complain = [&](std::int64_t count, const std::string& what) {
    if (count > 0) why += (why.empty() ? "" : ", ") + std::to_string(count) + " " + what + (count > 1 ? "s" : "");
  };
  if (topology.triangles == 0) return "no triangles";
  complain(topology.boundary_edges, "boundary edge");
  complain(topology.nonmanifold_edges, "non-manifold edge");
  complain(topology.misoriented_edges, "misoriented edge");
  complain(topology.nonmanifold_vertices, "non-manifold corner");
  complain(self_intersections, "self-intersection");
  complain(topology.degenerate_triangles, "degenerate triangle");
  if (why.empty() && !(topology.volume > 0)) why = "inside out: the volume is not positive";
  return why;
}

MeshReport inspect(const Mesh& mesh) {
  MeshReport report{topology(mesh)};
  const auto meeting = self_intersections(mesh);
  report.contacts = std::ssize(contacts(mesh, meeting));
  report.self_intersections = std::ssize(meeting) - report.contacts;
  return report;
}

std::ostream& operator<<(std::ostream& out, const MeshReport& report) {
  return out << report.topology << "self-intersections   " << report.self_intersections << '\n'
             << "contacts             " << report.contacts << '\n';
}

std::string to_json(const MeshReport& report) {
  const Topology& t = report.topology;
  const nlohmann::ordered_json all = {{"pass", report.pass()},
                                      {"why_not", report.why_not()},
                                      {"vertices", t.vertices},
                                      {"edges", t.edges},
                                      {"triangles", t.triangles},
                                      {"closed", t.closed()},
                                      {"manifold", t.manifold()},
                                      {"oriented", t.oriented()},
                                      {"boundary_edges", t.boundary_edges},
                                      {"nonmanifold_edges", t.nonmanifold_edges},
                                      {"misoriented_edges", t.misoriented_edges},
                                      {"nonmanifold_vertices", t.nonmanifold_vertices},
                                      {"unused_vertices", t.unused_vertices},
                                      {"degenerate_triangles", t.degenerate_triangles},
                                      {"self_intersections", report.self_intersections},
                                      {"contacts", report.contacts},
                                      {"components", t.components},
                                      {"euler", t.euler},
                                      {"genus", t.genus},
                                      {"area", t.area},
                                      {"volume", t.volume}};
  return all.dump();
}

}  // namespace carve
