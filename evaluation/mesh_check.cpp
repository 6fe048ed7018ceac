#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/command_line.h"
#include "carve/mesh/mesh_io.h"
#include "eval/check.h"

namespace {
using namespace carve;

int check_files(const std::vector<std::filesystem::path>& files, bool json) {
  bool all_pass = true;
  auto reports = nlohmann::ordered_json::array();
  for (const auto& file : files) {
    const MeshReport report = inspect(read_mesh(file));
    all_pass &= report.pass();
    if (json)
      reports.push_back({{"file", file.string()}, {"report", nlohmann::ordered_json::parse(to_json(report))}});
    else
      std::cout << file.string() << ": " << (report.pass() ? "pass" : "FAIL: " + report.why_not()) << '\n' << report;
  }
  if (json) std::cout << reports.dump(2) << '\n';
  return all_pass ? kDone : kCheckFailed;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::filesystem::path> files;
  bool json = false;
  CLI::App app(
      "Whether meshes are closed, oriented 2-manifolds without self-intersections and degenerate triangles, around a "
      "positive volume.",
      "mesh_check");
  app.add_option("meshes", files, ".ply .obj .off .stl .glb")->required()->type_name("FILE");
  app.add_flag("--json", json, "JSON on standard output");
  add_threads_flag(app);
  app.footer(
      "Example:\n  mesh_check result.glb && echo printable\n"
      "Exit codes: 0 all pass, 1 the work could not be done, 2 wrong usage or bad input, 3 a mesh fails.");
  return run_program(app, argc, argv, [&] { return check_files(files, json); });
}
