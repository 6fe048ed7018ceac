#pragma once
#include "carve/core/vector.h"

namespace carve {

/// Each coordinate as the nearest float has it, as GLB and STL files hold it. By way of memory: from -O2 on GCC 12
/// leaves out the conversion of two neighbouring doubles to float and back.
inline Vec3 as_floats(const Vec3& p) {
  Vec3 out;
  for (int k = 0; k < 3; ++k) {
    const volatile float rounded = static_cast<float>(p[k]);
    out[k] = rounded;
  }
  return out;
}

}  // namespace carve
