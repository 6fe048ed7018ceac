#pragma once
#include <gmp.h>

#include "carve/hull/exact_point.h"

namespace carve::hull {

/// GMP's rational of CGAL's exact numbers, whichever of its two wrappers CGAL was built with.
template <class Rational>
mpq_srcptr rational(const Rational& q) {
  if constexpr (requires { q.get_mpq_t(); })
    return q.get_mpq_t();
  else
    return q.mpq();
}

/// \throws std::logic_error if the point is not one in which three planes of the lattice meet
ExactPoint rational_point(const std::array<mpq_srcptr, 3>& coordinates);

}  // namespace carve::hull
