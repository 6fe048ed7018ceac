#pragma once
#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "carve/core/vector.h"

namespace carve {

/// The six orthographic drawings. Views are named, never positional.
///
/// World (glTF's): right-handed, +X right, +Y up, +Z towards the viewer of the front drawing. A view is the drawing
/// seen from the named side; "side" is seen from +X, the object's left-hand side when it faces us.
enum class View { front, side, top, back, left, bottom };
inline constexpr std::array kViews{View::front, View::side, View::top, View::back, View::left, View::bottom};
inline std::span<const char* const> names(View) {
  static constexpr const char* all[] = {"front", "side", "top", "back", "left", "bottom"};
  return all;
}
inline const char* name(View view) { return names(view)[static_cast<int>(view)]; }

/// One of the world's axes and a direction along it.
struct SignedAxis {
  int axis;  // 0 = x, 1 = y, 2 = z
  int sign;  // +1 or -1
};

/// Where a view's picture lies in the world: right = image right, up = image up, toward = from the object to the
/// viewer. right x up = toward, so no view is mirrored.
struct Frame {
  SignedAxis right, up, toward;
};
constexpr Frame frame(View view) {
  switch (view) {
    case View::front:
      return {{0, +1}, {1, +1}, {2, +1}};
    case View::side:
      return {{2, -1}, {1, +1}, {0, +1}};
    case View::top:
      return {{0, +1}, {2, -1}, {1, +1}};
    case View::back:
      return {{0, -1}, {1, +1}, {2, -1}};
    case View::left:
      return {{2, +1}, {1, +1}, {0, -1}};
    default:
      return {{0, +1}, {2, +1}, {1, -1}};
  }
}

}  // namespace carve
