#pragma once
#include <filesystem>
#include <string>

namespace carve::experiments {

/// A section of HTML with a rotatable view of any run's mesh below `results`, two side by side, and what it needs: the
/// meshes (report/display_mesh.h; alike ones once), three.js and report/viewer.js. Meshes are simplified so that all
/// together take about `megabytes`. Where WebGL, scripts or three.js is missing a text says so.
///
/// `three` is the folder of three.js as Debian's libjs-three installs it (three.min.js, examples/js/controls).
std::string viewer_html(const std::filesystem::path& results, const std::filesystem::path& three, double megabytes);

}  // namespace carve::experiments
