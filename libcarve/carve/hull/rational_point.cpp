#include "carve/hull/rational_point.h"

#include <gmpxx.h>

#include <stdexcept>

namespace carve::hull {

ExactPoint rational_point(const std::array<mpq_srcptr, 3>& coordinates) {
  mpz_class den = 1;
  for (const mpq_srcptr x : coordinates) mpz_lcm(den.get_mpz_t(), den.get_mpz_t(), mpq_denref(x));
  if (mpz_sizeinbase(den.get_mpz_t(), 2) > 53)
    throw std::logic_error("a hull's vertex lies where no three planes meet");
  std::array<Int128, 3> numerators;
  for (int axis = 0; axis < 3; ++axis) {
    const mpz_class n = mpz_class(mpq_numref(coordinates[axis])) * (den / mpz_class(mpq_denref(coordinates[axis])));
    const mpz_class size = abs(n);
    const mpz_class high = size >> 64, low = size - (high << 64);
    const Int128 value = (static_cast<Int128>(high.get_ui()) << 64) + low.get_ui();
    numerators[axis] = n < 0 ? -value : value;
  }
  return exact_point(numerators, static_cast<std::int64_t>(den.get_si()));
}

}  // namespace carve::hull
