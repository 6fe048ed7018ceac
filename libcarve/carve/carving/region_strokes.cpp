#include "carve/carving/region_strokes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "carve/carving/disjoint_sets.h"
#include "carve/carving/nearest.h"

namespace carve {
namespace {

int darkness(const Rgba& c) { return std::max({c.r, c.g, c.b}); }

std::vector<int> set_pixels(const Mask& mask) {
  std::vector<int> pixels;
  for (std::size_t i = 0; i < mask.pixels.size(); ++i)
    if (mask.pixels[i]) pixels.push_back(static_cast<int>(i));
  return pixels;
}

/// Strokes as dark as most of the outline are, and what runs along them.
Mask dark_strokes(const RegionWindow& window, const NearestSet& background, const Mask& edge,
                  const std::vector<int>& strokes, double width) {
  const int w = edge.width;
  std::vector<int> outline;
  for (const int i : strokes)
    if (background(i % w, i / w, width) >= 0) outline.push_back(darkness(window.colour.pixels[i]));
  int darkest = 255;
  if (outline.size() > 20) {
    std::nth_element(outline.begin(), outline.begin() + outline.size() / 2, outline.end());
    darkest = outline[outline.size() / 2] + 12;
  }
  Mask core(w, edge.height);
  for (const int i : strokes) core.pixels[i] = darkness(window.colour.pixels[i]) <= darkest;
  const NearestSet nearest(core);
  Mask kept(w, edge.height);
  for (const int i : strokes) kept.pixels[i] = core.pixels[i] || nearest(i % w, i / w, std::max(1.5, width / 2)) >= 0;
  return kept;
}

}  // namespace

Mask where(const Raster<Label>& labels, Label wanted) {
  Mask mask(labels.width, labels.height);
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) mask.pixels[i] = labels.pixels[i] == wanted;
  return mask;
}

double stroke_width(const Mask& edge) {
  const int w = edge.width, h = edge.height;
  Raster<int> down(w, h);  // edge pixels above and here, then the whole run
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) down(x, y) = edge(x, y) ? 1 + (y > 0 ? down(x, y - 1) : 0) : 0;
  for (int y = h - 2; y >= 0; --y)
    for (int x = 0; x < w; ++x)
      if (edge(x, y) && edge(x, y + 1)) down(x, y) = down(x, y + 1);
  std::vector<int> widths;
  for (int y = 0; y < h; ++y)
    for (int x = 0, start = 0; x <= w; ++x)
      if (x == w || !edge(x, y)) {
        for (int i = start; i < x; ++i) widths.push_back(std::min(x - start, down(i, y)));
        start = x + 1;
      }
  if (widths.empty()) return 0;
  std::nth_element(widths.begin(), widths.begin() + widths.size() / 2, widths.end());
  return widths[widths.size() / 2];
}

void drop_false_strokes(RegionWindow& window, const NearestSet& background, double width, double gap, double smallest) {
  const Mask edge = where(window.label, Label::edge);
  const std::vector<int> strokes = set_pixels(edge);
  const Mask kept = dark_strokes(window, background, edge, strokes, width);

  const int w = edge.width, last = static_cast<int>(edge.pixels.size()) - w - 1;
  const double reach = gap / 2 + 1;
  const Raster<std::uint16_t> to_kept = squared_distances(kept, static_cast<int>(std::floor(reach)) + 1);
  const auto joined = [&](int i) { return to_kept.pixels[i] <= reach * reach; };
  DisjointSets sets(edge.pixels.size());
  for (int i = 0; i < last; ++i)
    if (joined(i))
      for (const int n : {i + 1, i + w - 1, i + w, i + w + 1})
        if (joined(n)) sets.join(sets.find(i), sets.find(n));
  std::vector<Box> box(edge.pixels.size(), Box{w, edge.height, 0, 0});
  for (const int i : strokes)
    if (kept.pixels[i]) {
      Box& b = box[sets.find(i)];
      b = {std::min(b.x0, i % w), std::min(b.y0, i / w), std::max(b.x1, i % w + 1), std::max(b.y1, i / w + 1)};
    }
  for (const int i : strokes) {
    const Box& b = box[sets.find(i)];
    if (!kept.pixels[i] || std::hypot(b.width(), b.height()) < smallest) window.label.pixels[i] = Label::surface;
  }
}

double outline_gap(const Raster<Label>& label) {
  constexpr double kFew = 0.02, kMost = 0.5;  // shares of the outline that are missing
  const int w = label.width, last = static_cast<int>(label.pixels.size()) - w - 1;
  std::vector<int> missing;
  std::int64_t drawn = 0;
  for (int i = w + 1; i < last; ++i) {
    if (label.pixels[i] == Label::background) continue;
    const auto open = [&](int n) { return label.pixels[n] == Label::background; };
    if (!open(i - 1) && !open(i + 1) && !open(i - w) && !open(i + w)) continue;
    if (label.pixels[i] == Label::edge)
      ++drawn;
    else
      missing.push_back(i);
  }
  const double share = missing.empty() ? 0 : static_cast<double>(missing.size()) / (missing.size() + drawn);
  if (share < kFew || share > kMost) return 0;
  DisjointSets sets(label.pixels.size());
  std::vector<int> length(label.pixels.size(), 0);
  Mask open(w, label.height);
  for (const int i : missing) open.pixels[i] = 1;
  for (const int i : missing)
    for (const int n : {i - 1, i - w - 1, i - w, i - w + 1})
      if (open.pixels[n]) sets.join(sets.find(n), sets.find(i));
  for (const int i : missing) ++length[sets.find(i)];
  std::vector<int> gaps;
  for (const int i : missing)
    if (length[i] > 0) gaps.push_back(length[i]);
  std::nth_element(gaps.begin(), gaps.begin() + gaps.size() / 2, gaps.end());
  return gaps[gaps.size() / 2];
}

Raster<int> stroke_components(const Raster<Label>& label, double gap) {
  constexpr float kAsWide = 0.6F;  // share of the narrower basin
  const auto open = static_cast<float>(gap / 2 + 1);
  const int w = label.width, reach = static_cast<int>(std::ceil(open / kAsWide));
  const Raster<std::uint16_t> to_stroke = squared_distances(where(label, Label::edge), reach);
  std::vector<float> root(reach * reach + 1);
  for (std::size_t i = 0; i < root.size(); ++i) root[i] = std::min(static_cast<float>(std::sqrt(i)), open / kAsWide);
  const auto height = [&](int i) { return root[to_stroke.pixels[i]]; };

  // The surface's pixels from the highest down, in the drawing's order where they are as high.
  std::vector<int> place(root.size() + 1, 0);
  for (std::size_t i = 0; i < label.pixels.size(); ++i)
    if (label.pixels[i] == Label::surface) ++place[root.size() - 1 - to_stroke.pixels[i] + 1];
  for (std::size_t i = 1; i < place.size(); ++i) place[i] += place[i - 1];
  std::vector<int> order(place.back());
  for (std::size_t i = 0; i < label.pixels.size(); ++i)
    if (label.pixels[i] == Label::surface) order[place[root.size() - 1 - to_stroke.pixels[i]]++] = static_cast<int>(i);

  DisjointSets sets(label.pixels.size());
  std::vector<float> peak(label.pixels.size(), -1);  // below 0: not yet under water
  std::size_t low = 0;
  // Where all is as high as can be, neighbours are one basin, and four of them are joined by three of their sides.
  for (; low < order.size() && to_stroke.pixels[order[low]] + 1u == root.size(); ++low) {
    const int i = order[low];
    peak[i] = root.back();
    const bool left = peak[i - 1] >= 0, above = peak[i - w] >= 0;
    if (left) sets.join(sets.find(i - 1), i);
    if (above && !(left && peak[i - w - 1] >= 0)) sets.join(sets.find(i - w), sets.find(i));
  }
  for (; low < order.size(); ++low) {
    const int i = order[low];
    peak[i] = height(i);
    std::array<int, 4> around;  // basins that meet here, the highest first
    int basins = 0;
    for (const int n : {i - 1, i + 1, i - w, i + w}) {
      if (peak[n] < 0) continue;
      const int basin = sets.find(n);
      int at = 0;
      while (at < basins && around[at] != basin) ++at;
      if (at < basins) continue;
      for (at = basins++; at > 0 && peak[around[at - 1]] < peak[basin]; --at) around[at] = around[at - 1];
      around[at] = basin;
    }
    int here = i;
    for (int k = 0; k < basins; ++k) {
      const int basin = around[k];
      if (k > 0 && height(i) < std::min(open, kAsWide * std::min(peak[here], peak[basin]))) continue;
      const float highest = std::max(peak[here], peak[basin]);
      here = sets.join(here, basin);
      peak[here] = highest;
    }
  }
  Raster<int> out(w, label.height, -1);
  for (const int i : order) out.pixels[i] = sets.find(i);
  return out;
}

void fill_specks(Raster<Label>& label, Raster<int>& component, double smallest) {
  std::vector<int> size(component.pixels.size(), 0);
  for (const int c : component.pixels)
    if (c >= 0) ++size[c];
  for (std::size_t i = 0; i < size.size(); ++i)
    if (int& c = component.pixels[i]; c >= 0 && size[c] < smallest) {
      c = -1;
      label.pixels[i] = Label::edge;
    }
}

}  // namespace carve
