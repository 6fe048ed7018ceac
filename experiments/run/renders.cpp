#include "run/renders.h"

#include <algorithm>

#include "carve/image/read_image.h"
#include "carve/mesh/mesh_io.h"
#include "eval/render.h"
#include "eval/shade.h"
#include "eval/text.h"
#include "run/figures.h"

namespace carve::experiments {
namespace fs = std::filesystem;
namespace {

constexpr int kPanel = 300, kMargin = 12, kTitle = 22;
constexpr double kText = 15;
constexpr const char* kCameras[] = {"three_quarter", "215:22", "-35:-25"};

// A picture made to fit a panel, each pixel the mean of those it covers.
Picture fitted(const Picture& picture) {
  const double step = std::max(1.0, std::max(picture.width, picture.height) / static_cast<double>(kPanel));
  Picture small(std::max(1, static_cast<int>(picture.width / step)),
                std::max(1, static_cast<int>(picture.height / step)));
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      double sum[3] = {0, 0, 0};
      int count = 0;
      for (int j = static_cast<int>(y * step); j < std::min<double>(picture.height, (y + 1) * step); ++j)
        for (int i = static_cast<int>(x * step); i < std::min<double>(picture.width, (x + 1) * step); ++i, ++count) {
          const Rgba p = picture(i, j);
          const double a = p.a / 255.0;  // over white
          const double channels[] = {p.r * a + 255 * (1 - a), p.g * a + 255 * (1 - a), p.b * a + 255 * (1 - a)};
          for (int k = 0; k < 3; ++k) sum[k] += channels[k];
        }
      const auto channel = [&](int k) { return static_cast<std::uint8_t>(sum[k] / count + 0.5); };
      small(x, y) = {channel(0), channel(1), channel(2), 255};
    }
  return small;
}

// With its texture if it has one.
Picture render_of(const TexturedMesh& model, const CameraAxes& axes) {
  const Window unit = window_around(axes, model.mesh.positions, 1000);
  const double extent = std::max(unit.width, unit.height) / 1000.0;
  const Window window = window_around(axes, model.mesh.positions, kPanel / std::max(extent, 1e-9));
  if (model.texture.empty()) return shade(model.mesh, axes, window);
  Picture picture = render(model, axes, window, true);
  for (Rgba& pixel : picture.pixels)
    if (pixel.a == 0) pixel = {255, 255, 255, 255};
  return picture;
}

struct Strip {
  std::string title;
  std::vector<Picture> panels;
};

Picture stacked(const std::vector<Strip>& strips) {
  int width = 0, height = kMargin;
  for (const Strip& strip : strips) {
    width = std::max(width, kMargin + static_cast<int>(strip.panels.size()) * (kPanel + kMargin));
    int tallest = 0;
    for (const Picture& panel : strip.panels) tallest = std::max(tallest, panel.height);
    height += kTitle + tallest + kMargin;
  }
  Picture figure(width, height, Rgba{255, 255, 255, 255});
  int y = kMargin;
  for (const Strip& strip : strips) {
    draw_text(figure, kMargin, y + kText, kText, strip.title);
    y += kTitle;
    int x = kMargin, tallest = 0;
    for (const Picture& panel : strip.panels) tallest = std::max(tallest, panel.height);
    for (const Picture& panel : strip.panels) {
      paste(figure, panel, x + (kPanel - panel.width) / 2, y + (tallest - panel.height) / 2);
      x += kPanel + kMargin;
    }
    y += tallest + kMargin;
  }
  return figure;
}

Picture figure_of(const fs::path& results, const std::vector<const Record*>& runs) {
  std::vector<Strip> strips = {{"drawings", {}}};
  for (const View view : kViews)
    if (const fs::path file = results / runs.front()->folder / (std::string(name(view)) + ".png"); fs::exists(file))
      strips[0].panels.push_back(fitted(read_image(file)));
  if (strips[0].panels.empty()) strips.clear();
  for (const Record* run : runs) {
    const fs::path folder = results / run->folder;
    const TexturedMesh model = run->metrics.contains("step_texture")
                                   ? read_textured_mesh(folder / "mesh.glb")
                                   : TexturedMesh{read_mesh(folder / "mesh.ply"), {}, {}, {}};
    strips.push_back({run->method, {}});
    for (const char* camera : kCameras) strips.back().panels.push_back(render_of(model, named_camera(camera)));
  }
  return stacked(strips);
}

}  // namespace

std::vector<fs::path> draw_renders_of(const fs::path& folder, const Overview& overview,
                                      const std::vector<Record>& records) {
  std::vector<fs::path> written;
  fs::remove_all(folder / "renders");  // the report shows what is there
  for (const Figure& figure : figures_of(overview, records, overview.render_models)) {
    fs::create_directories(folder / "renders");
    written.push_back(folder / "renders" / figure.file);
    write_png(written.back(), figure_of(folder.parent_path(), figure.runs));
  }
  return written;
}

}  // namespace carve::experiments
