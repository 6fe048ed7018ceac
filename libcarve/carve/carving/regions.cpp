#include "carve/carving/regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "carve/carving/nearest.h"
#include "carve/grid/shadow.h"

namespace carve {
namespace {

struct Sets {
  std::vector<int> parent;
  explicit Sets(std::size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0); }
  int find(int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
};

/// The part of a drawing that shows the object, cut out with a margin of one background pixel.
struct Window {
  int x0, y0;
  Raster<Label> label;
  Raster<Rgba> colour;
};

Window window_of(const Drawing& drawing) {
  const Box& b = drawing.bounds;
  Window out{b.x0 - 1, b.y0 - 1, Raster<Label>(b.width() + 2, b.height() + 2, Label::background),
             Raster<Rgba>(b.width() + 2, b.height() + 2)};
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) {
      out.label(x - out.x0, y - out.y0) = drawing.labels(x, y);
      out.colour(x - out.x0, y - out.y0) = drawing.picture(x, y);
    }
  return out;
}

Mask where(const Raster<Label>& labels, Label wanted) {
  Mask mask(labels.width, labels.height);
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) mask.pixels[i] = labels.pixels[i] == wanted;
  return mask;
}

/// Median width of the strokes in pixels: the shorter of the horizontal and the vertical run through each edge pixel.
double stroke_width(const Mask& edge) {
  Raster<int> across(edge.width, edge.height, 0), down(edge.width, edge.height, 0);
  for (int y = 0; y < edge.height; ++y)
    for (int x = 0, start = 0; x <= edge.width; ++x)
      if (x == edge.width || !edge(x, y)) {
        for (int i = start; i < x; ++i) across(i, y) = x - start;
        start = x + 1;
      }
  for (int x = 0; x < edge.width; ++x)
    for (int y = 0, start = 0; y <= edge.height; ++y)
      if (y == edge.height || !edge(x, y)) {
        for (int i = start; i < y; ++i) down(x, i) = y - start;
        start = y + 1;
      }
  std::vector<int> widths;
  for (std::size_t i = 0; i < edge.pixels.size(); ++i)
    if (edge.pixels[i]) widths.push_back(std::min(across.pixels[i], down.pixels[i]));
  if (widths.empty()) return 0;
  std::nth_element(widths.begin(), widths.begin() + widths.size() / 2, widths.end());
  return widths[widths.size() / 2];
}

/// Keeps the strokes that are drawn like the outline: as dark, and, gaps closed, not only specks of less than
/// `smallest` pixels. The others, dark spots of a texture, become surface.
void drop_false_strokes(Raster<Label>& label, const Raster<Rgba>& colour, double width, double gap, double smallest) {
  const Mask edge = where(label, Label::edge);
  const Raster<float> to_background = distance_to(nearest_set(where(label, Label::background)));
  const auto darkness = [&](int i) {
    const Rgba& c = colour.pixels[i];
    return static_cast<int>(std::max({c.r, c.g, c.b}));
  };
  std::vector<int> outline;
  for (std::size_t i = 0; i < edge.pixels.size(); ++i)
    if (edge.pixels[i] && to_background.pixels[i] <= width) outline.push_back(darkness(static_cast<int>(i)));
  int darkest = 255;
  if (outline.size() > 20) {
    std::nth_element(outline.begin(), outline.begin() + outline.size() / 2, outline.end());
    darkest = outline[outline.size() / 2] + 12;
  }
  Mask core(edge.width, edge.height);
  for (std::size_t i = 0; i < edge.pixels.size(); ++i)
    core.pixels[i] = edge.pixels[i] && darkness(static_cast<int>(i)) <= darkest;
  const Raster<float> to_core = distance_to(nearest_set(core));
  Mask kept(edge.width, edge.height);
  for (std::size_t i = 0; i < edge.pixels.size(); ++i)
    kept.pixels[i] = edge.pixels[i] && to_core.pixels[i] <= std::max(1.5, width / 2);

  const int w = edge.width;
  const Raster<float> to_kept = distance_to(nearest_set(kept));
  const auto joined = [&](int i) { return to_kept.pixels[i] <= gap / 2 + 1; };
  Sets sets(edge.pixels.size());
  for (int i = 0; i + w + 1 < static_cast<int>(edge.pixels.size()); ++i)
    if (joined(i))
      for (const int n : {i + 1, i + w - 1, i + w, i + w + 1})
        if (joined(n)) {
          const int a = sets.find(i), b = sets.find(n);
          sets.parent[std::max(a, b)] = std::min(a, b);
        }
  std::vector<Box> box(edge.pixels.size(), Box{w, edge.height, 0, 0});
  for (int i = 0; i < static_cast<int>(edge.pixels.size()); ++i)
    if (kept.pixels[i]) {
      Box& b = box[sets.find(i)];
      b = {std::min(b.x0, i % w), std::min(b.y0, i / w), std::max(b.x1, i % w + 1), std::max(b.y1, i / w + 1)};
    }
  for (int i = 0; i < static_cast<int>(edge.pixels.size()); ++i) {
    if (!edge.pixels[i]) continue;
    const Box& b = box[sets.find(i)];
    if (!kept.pixels[i] || std::hypot(b.width(), b.height()) < smallest) label.pixels[i] = Label::surface;
  }
}

/// Components of the surface between strokes, as a watershed of the distance to them: two basins are one if the pass
/// between them is wider than the gap, or nearly as wide as the narrower basin. -1 on strokes and background.
Raster<int> stroke_components(const Raster<Label>& label, const Raster<float>& to_stroke, double gap) {
  const int w = label.width;
  const float open = static_cast<float>(gap / 2 + 1);
  std::vector<int> order;
  for (std::size_t i = 0; i < label.pixels.size(); ++i)
    if (label.pixels[i] == Label::surface) order.push_back(static_cast<int>(i));
  const auto height = [&](int i) { return std::min(to_stroke.pixels[i], open); };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return height(a) > height(b); });

  Sets sets(label.pixels.size());
  std::vector<float> peak(label.pixels.size(), 0);
  std::vector<std::uint8_t> active(label.pixels.size(), 0);
  for (const int i : order) {
    active[i] = 1;
    peak[i] = height(i);
    std::array<int, 4> around{i - 1, i + 1, i - w, i + w};
    std::stable_sort(around.begin(), around.end(), [&](int a, int b) {
      return (active[a] ? peak[sets.find(a)] : -1) > (active[b] ? peak[sets.find(b)] : -1);
    });
    bool joined = false;
    for (const int n : around) {
      if (!active[n]) continue;
      const int a = sets.find(i), b = sets.find(n);
      if (a == b) continue;
      if (!joined || height(i) >= std::min(open, 0.6F * std::min(peak[a], peak[b]))) {
        peak[std::min(a, b)] = std::max(peak[a], peak[b]);
        sets.parent[std::max(a, b)] = std::min(a, b);
        joined = true;
      }
    }
  }
  Raster<int> out(w, label.height, -1);
  for (const int i : order) out.pixels[i] = sets.find(i);
  return out;
}

int colour_difference(const Rgba& a, const Rgba& b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

/// Splits components further where the colour or texture changes \cite felzenszwalb_2004. Only pixels that `clean` says
/// are free of anti-aliasing take part; the others keep -1.
Raster<int> colour_components(const Raster<int>& part, const Raster<Rgba>& colour, const Mask& clean, double scale,
                              int smallest) {
  struct Link {
    int a, b;
  };
  const int w = part.width;
  std::array<std::vector<Link>, 256> links;
  for (int y = 0; y + 1 < part.height; ++y)
    for (int x = 0; x + 1 < w; ++x) {
      const int i = y * w + x;
      if (!clean.pixels[i]) continue;
      for (const int n : {i + 1, i + w})
        if (clean.pixels[n] && part.pixels[i] == part.pixels[n])
          links[colour_difference(colour.pixels[i], colour.pixels[n])].push_back({i, n});
    }
  Sets sets(part.pixels.size());
  std::vector<int> size(part.pixels.size(), 1);
  std::vector<double> inner(part.pixels.size(), 0);
  const auto join = [&](int a, int b, double weight) {
    sets.parent[std::max(a, b)] = std::min(a, b);
    size[std::min(a, b)] = size[a] + size[b];
    inner[std::min(a, b)] = weight;
  };
  for (int weight = 0; weight < 256; ++weight)
    for (const Link& link : links[weight]) {
      const int a = sets.find(link.a), b = sets.find(link.b);
      if (a != b && weight <= std::min(inner[a] + scale / size[a], inner[b] + scale / size[b])) join(a, b, weight);
    }
  for (int weight = 0; weight < 256; ++weight)
    for (const Link& link : links[weight]) {
      const int a = sets.find(link.a), b = sets.find(link.b);
      if (a != b && std::min(size[a], size[b]) < smallest) join(a, b, inner[a]);
    }
  Raster<int> out(w, part.height, -1);
  for (std::size_t i = 0; i < out.pixels.size(); ++i)
    if (clean.pixels[i]) out.pixels[i] = sets.find(static_cast<int>(i));
  return out;
}

/// Joins neighbouring segments of one component whose mean colours differ by less than `tolerance`.
void join_alike(Raster<int>& segment, const Raster<int>& part, const Raster<Rgba>& colour, double tolerance) {
  const int w = segment.width;
  Sets sets(segment.pixels.size());
  std::vector<Eigen::Vector4d> sum(segment.pixels.size(), Eigen::Vector4d::Zero());
  for (std::size_t i = 0; i < segment.pixels.size(); ++i)
    if (segment.pixels[i] >= 0) {
      const Rgba& c = colour.pixels[i];
      sum[segment.pixels[i]] += Eigen::Vector4d(c.r, c.g, c.b, 1);
    }
  for (bool again = true; again;) {
    again = false;
    for (int i = 0; i + w < static_cast<int>(segment.pixels.size()); ++i) {
      if (segment.pixels[i] < 0) continue;
      for (const int n : {i + 1, i + w}) {
        if (segment.pixels[n] < 0 || part.pixels[i] != part.pixels[n]) continue;
        const int a = sets.find(segment.pixels[i]), b = sets.find(segment.pixels[n]);
        if (a == b) continue;
        if ((sum[a].head<3>() / sum[a][3] - sum[b].head<3>() / sum[b][3]).cwiseAbs().maxCoeff() > tolerance) continue;
        sets.parent[std::max(a, b)] = std::min(a, b);
        sum[std::min(a, b)] = (sum[a] + sum[b]).eval();
        again = true;
      }
    }
  }
  for (int& s : segment.pixels)
    if (s >= 0) s = sets.find(s);
}

/// Gives every pixel of the object that has no label that of the nearest one that has.
void fill(Raster<int>& label) {
  Mask known(label.width, label.height);
  for (std::size_t i = 0; i < label.pixels.size(); ++i) known.pixels[i] = label.pixels[i] >= 0;
  const Raster<int> nearest = nearest_set(known);
  for (std::size_t i = 0; i < label.pixels.size(); ++i)
    if (label.pixels[i] < 0 && nearest.pixels[i] >= 0) label.pixels[i] = label.pixels[nearest.pixels[i]];
}

}  // namespace

RegionMap find_regions(const AlignedView& view, const VoxelGrid& hull, const RegionOptions& options) {
  Window window = window_of(view.drawing);
  const double voxel_pixels = std::min(std::abs(view.column_per_unit), std::abs(view.row_per_unit)) * hull.spacing();
  drop_false_strokes(window.label, window.colour, stroke_width(where(window.label, Label::edge)), options.gap,
                     4 * voxel_pixels);
  const Mask edge = where(window.label, Label::edge);
  const Raster<float> to_stroke = distance_to(nearest_set(edge));
  const Raster<float> to_background = distance_to(nearest_set(where(window.label, Label::background)));
  const double width = stroke_width(edge);

  const Frame f = frame(view.view);
  const Mask seen = shadow(hull, view.view);
  const double spacing = hull.spacing();
  const double pixels = std::min(std::abs(view.column_per_unit), std::abs(view.row_per_unit)) * spacing;  // a voxel

  Raster<int> part = stroke_components(window.label, to_stroke, options.gap);
  Raster<int> segment = part;
  if (options.colours) {
    Mask clean(edge.width, edge.height);
    for (std::size_t i = 0; i < clean.pixels.size(); ++i)
      clean.pixels[i] =
          window.label.pixels[i] == Label::surface && to_stroke.pixels[i] >= 2 && to_background.pixels[i] >= 2;
    const double voxel = std::max(1.0, pixels * pixels);
    Raster<int> colours = colour_components(part, window.colour, clean, 500 * voxel, static_cast<int>(12 * voxel));
    join_alike(colours, part, window.colour, 12);
    // Within a component the anti-aliased rim takes the nearest colour segment; across components it must not.
    Raster<int> filled = colours;
    fill(filled);
    for (std::size_t i = 0; i < segment.pixels.size(); ++i)
      if (part.pixels[i] >= 0 && filled.pixels[i] >= 0 && part.pixels[filled.pixels[i]] == part.pixels[i])
        segment.pixels[i] = filled.pixels[i];
  }
  fill(part);
  fill(segment);

  // Outlines are strokes that run along the background; what counts as a discontinuity lies further inside.
  Mask inner(edge.width, edge.height);
  for (std::size_t i = 0; i < inner.pixels.size(); ++i)
    inner.pixels[i] = edge.pixels[i] && to_background.pixels[i] > 1.5 * width + 1;
  const Raster<float> to_inner = distance_to(nearest_set(inner));

  RegionMap out;
  out.view = view.view;
  out.region = Raster<int>(seen.width, seen.height, -1);
  out.stroke_distance = Raster<float>(seen.width, seen.height, 1e9F);
  Raster<int> pixel_of(seen.width, seen.height, -1);
  const auto coordinate = [&](SignedAxis axis, int i, int n) {
    const int index = axis.sign > 0 ? i : n - 1 - i;
    return hull.low()[axis.axis] + (index + 0.5) * spacing;
  };
  std::vector<int> name(segment.pixels.size(), -1);
  for (int j = 0; j < seen.height; ++j)
    for (int i = 0; i < seen.width; ++i) {
      if (!seen(i, j)) continue;
      const double a = coordinate(f.right, i, seen.width), b = coordinate(f.up, seen.height - 1 - j, seen.height);
      const int x = std::clamp(static_cast<int>(std::floor(view.column(a))) - window.x0, 0, edge.width - 1);
      const int y = std::clamp(static_cast<int>(std::floor(view.row(b))) - window.y0, 0, edge.height - 1);
      const int p = y * edge.width + x;
      pixel_of(i, j) = p;
      out.stroke_distance(i, j) = static_cast<float>(to_inner.pixels[p] / pixels);
      int& region = name[segment.pixels[p]];
      if (region < 0) region = out.count++;
      out.region(i, j) = region;
    }

  out.colour.assign(out.count, Vec3::Zero());
  std::vector<double> weight(out.count, 0);
  for (std::size_t i = 0; i < segment.pixels.size(); ++i)
    if (window.label.pixels[i] == Label::surface && segment.pixels[i] >= 0 && name[segment.pixels[i]] >= 0) {
      const Rgba& c = window.colour.pixels[i];
      out.colour[name[segment.pixels[i]]] += Vec3(c.r, c.g, c.b);
      ++weight[name[segment.pixels[i]]];
    }
  for (int r = 0; r < out.count; ++r)
    if (weight[r] > 0) out.colour[r] /= weight[r];

  // The middle of a stroke lies where the nearest surface pixels of two neighbours are on its two sides.
  Mask surface = where(window.label, Label::surface);
  const Raster<int> nearest_surface = nearest_set(surface);
  const auto crossed = [&](int p, int q) {
    const int x0 = p % edge.width, y0 = p / edge.width, x1 = q % edge.width, y1 = q / edge.width;
    const int n = std::max({1, std::abs(x1 - x0), std::abs(y1 - y0)});
    for (int k = 0; k < n; ++k) {
      const int ax = x0 + (x1 - x0) * k / n, ay = y0 + (y1 - y0) * k / n;
      const int bx = x0 + (x1 - x0) * (k + 1) / n, by = y0 + (y1 - y0) * (k + 1) / n;
      if (!inner(ax, ay) && !inner(bx, by)) continue;
      const int a = nearest_surface(ax, ay), b = nearest_surface(bx, by);
      if (a < 0 || b < 0) continue;
      if (std::hypot(a % edge.width - b % edge.width, a / edge.width - b / edge.width) >= 0.75 * width) return true;
    }
    return false;
  };
  const auto border = [&](int i, int j, int di, int dj) {
    if (i + di >= seen.width || j + dj >= seen.height) return Border::near;
    const int p = pixel_of(i, j), q = pixel_of(i + di, j + dj);
    if (p < 0 || q < 0) return Border::near;
    const bool near = std::min(out.stroke_distance(i, j), out.stroke_distance(i + di, j + dj)) < 1.5;
    if (part.pixels[p] != part.pixels[q]) return crossed(p, q) ? Border::stroke : Border::near;
    if (crossed(p, q)) return Border::open;
    if (near) return Border::near;
    return out.region(i, j) != out.region(i + di, j + dj) ? Border::colour : Border::none;
  };
  out.right = out.below = Raster<Border>(seen.width, seen.height, Border::near);
  for (int j = 0; j < seen.height; ++j)
    for (int i = 0; i < seen.width; ++i) {
      out.right(i, j) = border(i, j, 1, 0);
      out.below(i, j) = border(i, j, 0, 1);
    }
  return out;
}

}  // namespace carve
