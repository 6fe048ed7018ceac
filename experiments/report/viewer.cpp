#include "report/viewer.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "carve/core/embed.h"
#include "carve/core/error.h"
#include "carve/core/file.h"
#include "carve/core/parallel.h"
#include "carve/mesh/mesh_io.h"
#include "report/display_mesh.h"
#include "report/table.h"

CARVE_EMBED(char, carve_viewer, CARVE_VIEWER);

namespace carve::experiments {
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
namespace {

// What a triangle takes in the page, measured over the meshes of all specs; a mesh is drawn with no more triangles than
// are told apart, and no fewer than show what it is.
constexpr double kBytesPerTriangle = 4.5;
constexpr int kMostTriangles = 24'000, kFewestTriangles = 1'200;

// Files to show; those with the same content once.
class Meshes {
 public:
  // Number of a file's mesh in the page; -1 if it cannot be read.
  int add(const fs::path& file) {
    try {
      std::string bytes = read_file(file);
      const auto [entry, is_new] = number_.try_emplace(std::move(bytes), static_cast<int>(files_.size()));
      if (is_new) files_.push_back(file);
      return entry->second;
    } catch (const IoError&) {
      return -1;
    }
  }

  std::vector<std::string> pack(double megabytes) const {
    const double share =
        megabytes * 1e6 / kBytesPerTriangle / static_cast<double>(std::max<std::size_t>(1, files_.size()));
    const int triangles = static_cast<int>(std::clamp<double>(share, kFewestTriangles, kMostTriangles));
    std::vector<std::string> all(files_.size());
    parallel_ranges(0, static_cast<int>(files_.size()), 1, [&](int first, int last) {
      for (int i = first; i < last; ++i) {
        const Mesh mesh = read_mesh(files_[i]);
        if (!mesh.triangles.empty()) all[i] = packed(mesh, triangles);
      }
    });
    return all;
  }

 private:
  std::map<std::string, int> number_;
  std::vector<fs::path> files_;
};

std::string label_of(const Record& r, bool seeds) {
  return r.method + (r.swept.empty() ? "" : ", " + text_of(r.swept)) +
         (seeds ? ", seed " + std::to_string(r.seed) : "");
}

Json run_of(const Record& r, const Overview& overview, bool seeds, const fs::path& results, Meshes& meshes) {
  Json run = {{"label", label_of(r, seeds)}, {"folder", r.folder}};
  if (!r.done()) {
    run["why"] = r.status;
    return run;
  }
  run["mesh"] = meshes.add(results / r.folder / "mesh.ply");
  for (const RunMetric& metric : overview.metrics)
    if (const auto found = r.metrics.find(metric.name); found != r.metrics.end())
      run["values"].push_back(metric.name + " " + short_text(found->second) + (metric.unit == "s" ? " s" : ""));
  return run;
}

Json spec_of(const fs::path& results, const std::string& name, Meshes& meshes) {
  const Results found = load_results(results / name);
  const bool seeds = std::any_of(found.records.begin(), found.records.end(),
                                 [&](const Record& r) { return r.seed != found.records.front().seed; });
  Json spec = {{"title", found.overview.title}, {"models", Json::array()}};
  for (const std::string& model : found.overview.models) {
    Json runs = Json::array();
    std::string reference;
    for (const std::string& method : found.overview.methods)
      for (const Record& r : found.records) {
        if (r.model != model || r.method != method) continue;
        runs.push_back(run_of(r, found.overview, seeds, results, meshes));
        if (const auto key = r.provenance.find(kReferenceKey); key != r.provenance.end()) reference = key->second;
      }
    if (!reference.empty())
      runs.push_back({{"label", "reference"}, {"mesh", meshes.add(results / kReferences / (reference + ".ply"))}});
    if (!runs.empty()) spec["models"].push_back({{"name", model}, {"runs", runs}});
  }
  return spec;
}

std::string without_end_tags(std::string text) {
  for (std::size_t at = 0; (at = text.find("</", at)) != std::string::npos;) text.replace(at, 2, "<\\/");
  return text;
}

constexpr const char* kControls = R"(<div class="controls">
<label>experiment <select id="view-spec"></select></label>
<label>model <select id="view-model"></select></label>
<label>left <select id="view-left"></select></label>
<label>right <select id="view-right"></select></label>
<label class="check"><input type="checkbox" id="view-edges"> edges</label>
<label class="check"><input type="checkbox" id="view-flat"> facets</label>
<button id="view-reset" type="button">reset</button>
</div>
<div class="stage"><canvas id="view-canvas"></canvas></div>
<div class="captions"><p id="view-left-text"></p><p id="view-right-text"></p></div>
)";

}  // namespace

std::string viewer_html(const fs::path& results, const fs::path& three, double megabytes) {
  std::ostringstream out;
  out << "<section id=\"meshes\" class=\"viewer\"><h2>Meshes in 3-D</h2>\n";
  std::string library, controls;
  try {
    library = read_file(three / "three.min.js");
    controls = read_file(three / "examples" / "js" / "controls" / "OrbitControls.js");
  } catch (const IoError& error) {
    out << "<p class=\"note\">Left out: three.js (Debian package libjs-three) was not there when this page was made: "
        << html_text(error.what()) << "</p></section>\n";
    return out.str();
  }
  Meshes meshes;
  Json specs = Json::array();
  for (const std::string& name : specs_in(results))
    if (Json spec = spec_of(results, name, meshes); !spec["models"].empty()) specs.push_back(std::move(spec));
  out << "<p class=\"note\">Drag turns, wheel or two fingers zoom, right button moves; both sides move together. "
         "Meshes "
         "are simplified for this page; the full ones are mesh.glb and mesh.ply in the runs' folders.</p>\n"
      << "<p id=\"view-missing\" class=\"missing\">The 3-D view needs a browser with scripts and WebGL; the pictures "
         "below show the same meshes.</p>\n<div id=\"view\" hidden>\n"
      << kControls << "</div>\n";
  for (const std::string& mesh : meshes.pack(megabytes))
    out << "<script type=\"text/plain\" class=\"mesh\">" << mesh << "</script>\n";
  out << "<script type=\"application/json\" id=\"view-runs\">" << without_end_tags(specs.dump()) << "</script>\n"
      << "<script>" << library << "</script>\n<script>" << controls << "</script>\n<script>" << carve_viewer
      << "</script>\n</section>\n";
  return out.str();
}

}  // namespace carve::experiments
