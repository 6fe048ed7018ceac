#include "carve/refine/contour.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "carve/image/outline.h"
#include "carve/image/outline_loops.h"

namespace carve::refining {
namespace {

constexpr int kCells = 512;        // along the drawing's longer side
constexpr double kStraight = 0.5;  // pixels off a line that still count as straight
constexpr double kTooLong = 1.5;   // times the chord that a circle of the object's size has within kStraight

double off_line(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double length = along.norm();
  return length == 0 ? (p - a).norm() : std::abs(along.x() * (p - a).y() - along.y() * (p - a).x()) / length;
}

}  // namespace

Contour::Contour(const AlignedView& view)
    : view_(view),
      right_(frame(view.view).right.axis),
      up_(frame(view.view).up.axis),
      pixel_(1 / std::max(std::abs(view.column_per_unit), std::abs(view.row_per_unit))) {
  trace();
  spread_nearest();
  find_radii();
}

void Contour::trace() {
  const auto in_object_units = [&](const OutlineCrossing& c) {
    return Vec2((c.place.x() - view_.column0) / view_.column_per_unit, (c.place.y() - view_.row0) / view_.row_per_unit);
  };
  for (const std::vector<OutlineCrossing>& loop : outline_loops(view_.drawing.coverage)) {
    const int first = pieces();
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec2 from = in_object_units(loop[i]), to = in_object_units(loop[(i + 1) % loop.size()]);
      if (from != to) from_.push_back(from), to_.push_back(to);
    }
    straight_.resize(from_.size());
    if (pieces() - first > 2) find_straight(first, pieces());
  }
}

/// Splits the loop at its points farthest from the chord (Douglas and Peucker) until it is straight in between.
void Contour::find_straight(int first, int last) {
  const double size = 1 / pixel_;  // pixels along the object's longest side
  const double shortest = kTooLong * std::sqrt(4 * size * kStraight) * pixel_;
  std::vector<std::pair<int, int>> runs;
  const int middle = first + static_cast<int>(std::max_element(from_.begin() + first, from_.begin() + last,
                                                               [&](const Vec2& a, const Vec2& b) {
                                                                 return (a - from_[first]).squaredNorm() <
                                                                        (b - from_[first]).squaredNorm();
                                                               }) -
                                              (from_.begin() + first));
  runs.emplace_back(first, middle);
  runs.emplace_back(middle, last);
  while (!runs.empty()) {
    const auto [begin, end] = runs.back();  // pieces
    runs.pop_back();
    if (end - begin < 2) continue;
    const Vec2 &a = from_[begin], &b = to_[end - 1];
    int worst = begin + 1;
    for (int i = begin + 1; i < end; ++i)
      if (off_line(from_[i], a, b) > off_line(from_[worst], a, b)) worst = i;
    if (off_line(from_[worst], a, b) > kStraight * pixel_) {
      runs.emplace_back(begin, worst);
      runs.emplace_back(worst, end);
    } else if ((b - a).norm() >= shortest) {
      std::fill(straight_.begin() + begin, straight_.begin() + end, 1);
    }
  }
}

Vec2 Contour::closest(int piece, const Vec2& p) const {
  const Vec2 along = to_[piece] - from_[piece];
  return from_[piece] + std::clamp((p - from_[piece]).dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
}

double Contour::distance2(int piece, const Vec2& p) const { return (p - closest(piece, p)).squaredNorm(); }

int Contour::cell(double x, double low, int count) const {
  return static_cast<int>(std::clamp(std::floor((x - low) / cell_), 0.0, count - 1.0));
}

/// Two sweeps, each over the rows there and back: neighbours' nearest pieces are tried.
void Contour::spread_nearest() {
  Vec2 high = Vec2::Constant(-std::numeric_limits<double>::infinity());
  low_ = -high;
  for (const Vec2& p : from_) low_ = low_.cwiseMin(p), high = high.cwiseMax(p);
  cell_ = std::max(pixel_, (high - low_).maxCoeff() / kCells);
  low_ -= Vec2::Constant(4 * cell_);
  const Vec2 size = (high - low_) / cell_ + Vec2::Constant(5);
  nearest_ = Raster<int>(static_cast<int>(size.x()), static_cast<int>(size.y()), -1);
  Raster<double> best(nearest_.width, nearest_.height, std::numeric_limits<double>::infinity());
  const auto offer = [&](int x, int y, int piece) {
    if (piece < 0 || !nearest_.contains(x, y)) return;
    const double d = distance2(piece, low_ + cell_ * Vec2(x + 0.5, y + 0.5));
    if (d < best(x, y)) best(x, y) = d, nearest_(x, y) = piece;
  };
  for (int i = 0; i < pieces(); ++i)
    offer(cell(from_[i].x(), low_.x(), nearest_.width), cell(from_[i].y(), low_.y(), nearest_.height), i);
  const auto take = [&](int x, int y, int from_x, int from_y) {
    if (nearest_.contains(from_x, from_y)) offer(x, y, nearest_(from_x, from_y));
  };
  for (const int step : {1, -1, 1, -1})
    for (int j = 0; j < nearest_.height; ++j) {
      const int y = step > 0 ? j : nearest_.height - 1 - j;
      for (int x = 0; x < nearest_.width; ++x)
        for (const int dx : {-1, 0, 1}) take(x, y, x + dx, y - step);
      for (int x = 0; x < nearest_.width; ++x) take(x, y, x - 1, y);
      for (int x = nearest_.width; x-- > 0;) take(x, y, x + 1, y);
    }
}

/// The circle grows inwards from the piece until another piece lies in it.
void Contour::find_radii() {
  constexpr double kGrowth = 1.1, kTouching = 0.9;
  radius_.resize(from_.size());
  for (int i = 0; i < pieces(); ++i) {
    const Vec2 middle = (from_[i] + to_[i]) / 2;
    const Vec2 outward = nearest_in_plane(middle).outward;
    double radius = 2 * pixel_;
    for (double next = radius; next < 1; next *= kGrowth) {
      if (nearest_in_plane(middle - next * outward).distance > -kTouching * next) break;
      radius = next;
    }
    radius_[i] = radius;
  }
}

Nearest Contour::nearest(const Vec3& p) const { return nearest_in_plane(project(p)); }

Nearest Contour::nearest_in_plane(const Vec2& p) const {
  const int x = cell(p.x() - cell_ / 2, low_.x(), nearest_.width),
            y = cell(p.y() - cell_ / 2, low_.y(), nearest_.height);
  Nearest result{std::numeric_limits<double>::infinity(), Vec2::Zero(), 0};
  for (const int dy : {0, 1})
    for (const int dx : {0, 1})
      if (nearest_.contains(x + dx, y + dy)) {
        const int piece = nearest_(x + dx, y + dy);
        if (const double d = distance2(piece, p); d < result.distance) result.distance = d, result.piece = piece;
      }
  const bool inside = Outline(view_.drawing.coverage).contains(view_.column(p.x()), view_.row(p.y()));
  const Vec2 from = closest(result.piece, p), along = to_[result.piece] - from_[result.piece];
  result.distance = (p - from).norm();
  // Right at the outline the way to it says nothing.
  const bool mirrored = view_.column_per_unit * view_.row_per_unit > 0;
  if (result.distance > pixel_ / 2)
    result.outward = (p - from) / (inside ? -result.distance : result.distance);
  else
    result.outward = (mirrored ? -1 : 1) * Vec2(along.y(), -along.x()).normalized();
  if (inside) result.distance = -result.distance;
  return result;
}

bool Contour::on_stroke(const Vec3& point) const {
  const Vec2 p = project(point);
  const double column = view_.column(p.x()), row = view_.row(p.y());
  const auto& labels = view_.drawing.labels;
  const int reach = 1;
  for (int y = static_cast<int>(std::floor(row)) - reach; y <= std::floor(row) + reach; ++y)
    for (int x = static_cast<int>(std::floor(column)) - reach; x <= std::floor(column) + reach; ++x)
      if (labels.contains(x, y) && labels(x, y) == Label::edge)
        return nearest(point).distance < -view_.drawing.max_stroke * pixel_;
  return false;
}

}  // namespace carve::refining
