#include "carve/carving/colour_segments.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "carve/carving/disjoint_sets.h"
#include "carve/core/vector.h"

namespace carve {
namespace {

constexpr double kAlike = 12;  // difference of mean colours, of 255

int difference(const Rgba& a, const Rgba& b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

struct Link {
  int a, b;
};

/// Clean neighbours of one component, by the difference of their colours; those without one are joined at once.
class Links {
 public:
  Links(const Raster<int>& component, const Raster<Rgba>& colour, const Mask& clean, DisjointSets& sets) {
    const int w = component.width;
    std::vector<std::uint8_t> weight[2];  // to the right, down; 0: none or no difference
    std::array<int, 256> count{};
    for (auto& weights : weight) weights.assign(component.pixels.size(), 0);
    std::vector<std::uint8_t> same(component.pixels.size(), 0);  // bit 0: as on the left, bit 1: as above
    for (int y = 0; y + 1 < component.height; ++y)
      for (int i = y * w; i < y * w + w - 1; ++i) {
        if (!clean.pixels[i]) continue;
        for (const int d : {0, 1}) {
          const int n = d ? i + w : i + 1;
          if (!clean.pixels[n] || component.pixels[i] != component.pixels[n]) continue;
          const int differ = difference(colour.pixels[i], colour.pixels[n]);
          weight[d][i] = static_cast<std::uint8_t>(differ);
          if (differ)
            ++count[differ];
          else
            same[n] |= 1 << d;
        }
      }
    for (int i = 0; i < static_cast<int>(same.size()); ++i) {
      if (same[i] & 1) sets.join(sets.find(i - 1), i);
      // Four alike are joined by three of their sides.
      if ((same[i] & 2) && !((same[i] & 1) && (same[i - 1] & 2) && (same[i - w] & 1)))
        sets.join(sets.find(i - w), sets.find(i));
    }
    for (int d = 0; d < 256; ++d) first_[d + 1] = first_[d] + count[d];
    all_.resize(first_[256]);
    std::array<int, 257> next = first_;
    for (int i = 0; i < static_cast<int>(same.size()); ++i)
      for (const int d : {0, 1})
        if (weight[d][i]) all_[next[weight[d][i]]++] = {i, d ? i + w : i + 1};
  }

  /// Calls use(link, difference), the least difference first.
  template <class Use>
  void each(Use&& use) const {
    for (int d = 1; d < 256; ++d)
      for (int k = first_[d]; k < first_[d + 1]; ++k) use(all_[k], d);
  }

 private:
  std::array<int, 257> first_{};  // by difference
  std::vector<Link> all_;
};

Raster<int> split(const Raster<int>& component, const Raster<Rgba>& colour, const Mask& clean, double scale,
                  int smallest) {
  DisjointSets sets(component.pixels.size());
  const Links links(component, colour, clean, sets);
  std::vector<int> size(component.pixels.size(), 0);
  std::vector<double> inner(component.pixels.size(), 0);
  for (std::size_t i = 0; i < size.size(); ++i) ++size[sets.find(static_cast<int>(i))];
  const auto join = [&](int a, int b, double difference) {
    const int pixels = size[a] + size[b], both = sets.join(a, b);
    size[both] = pixels;
    inner[both] = difference;
  };
  links.each([&](const Link& link, int d) {
    const int a = sets.find(link.a), b = sets.find(link.b);
    if (a != b && d <= std::min(inner[a] + scale / size[a], inner[b] + scale / size[b])) join(a, b, d);
  });
  links.each([&](const Link& link, int) {
    const int a = sets.find(link.a), b = sets.find(link.b);
    if (a != b && std::min(size[a], size[b]) < smallest) join(a, b, inner[a]);
  });
  Raster<int> out(component.width, component.height, -1);
  for (std::size_t i = 0; i < out.pixels.size(); ++i)
    if (clean.pixels[i]) out.pixels[i] = sets.find(static_cast<int>(i));
  return out;
}

void join_alike(Raster<int>& segment, const Raster<int>& component, const Raster<Rgba>& colour) {
  const int w = segment.width;
  std::vector<int> name(segment.pixels.size(), -1);
  std::vector<int> first;  // pixel of each segment
  std::vector<Eigen::Vector4d> sum;
  std::vector<Link> borders;
  for (int i = 0; i < static_cast<int>(segment.pixels.size()); ++i) {
    if (segment.pixels[i] < 0) continue;
    int& number = name[segment.pixels[i]];
    if (number < 0) {
      number = static_cast<int>(sum.size());
      first.push_back(i);
      sum.push_back(Eigen::Vector4d::Zero());
    }
    const Rgba& c = colour.pixels[i];
    sum[number] += Eigen::Vector4d(c.r, c.g, c.b, 1);
  }
  for (int i = 0; i + w < static_cast<int>(segment.pixels.size()); ++i) {
    if (segment.pixels[i] < 0) continue;
    for (const int n : {i + 1, i + w}) {
      if (segment.pixels[n] < 0 || segment.pixels[n] == segment.pixels[i]) continue;
      const Link link{name[segment.pixels[i]], name[segment.pixels[n]]};
      const bool known = !borders.empty() && borders.back().a == link.a && borders.back().b == link.b;
      if (component.pixels[i] == component.pixels[n] && !known) borders.push_back(link);
    }
  }
  DisjointSets sets(sum.size());
  for (bool again = true; again;) {
    again = false;
    for (const Link& link : borders) {
      const int a = sets.find(link.a), b = sets.find(link.b);
      if (a == b) continue;
      if ((sum[a].head<3>() / sum[a][3] - sum[b].head<3>() / sum[b][3]).cwiseAbs().maxCoeff() > kAlike) continue;
      const Eigen::Vector4d both = sum[a] + sum[b];
      sum[sets.join(a, b)] = both;
      again = true;
    }
  }
  for (int& s : segment.pixels)
    if (s >= 0) s = first[sets.find(name[s])];
}

}  // namespace

Raster<int> colour_segments(const Raster<int>& component, const Raster<Rgba>& colour, const Mask& clean, double voxel) {
  Raster<int> segment = split(component, colour, clean, 500 * voxel, static_cast<int>(12 * voxel));
  join_alike(segment, component, colour);
  return segment;
}

}  // namespace carve
