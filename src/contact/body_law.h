#pragma once

#include <cmath>

namespace mssim::body_law {

/// kernels/body_contact.h for one point at a time on the host: Real is float or double. In a namespace of its
/// own, because the backends instantiate the texts of kernels/ for their own number types.

template <class Real>
inline Real mul_add(Real a, Real b, Real c) {
  return a * b + c;
}
template <class Real>
inline Real inverse_sqrt(Real a) {
  return Real{1} / std::sqrt(a);
}
template <class Real>
inline Real where_less(Real a, Real b, Real yes, Real no) {
  return a < b ? yes : no;
}

#define MSSIM_LAW       \
  template <class Real> \
  inline Real
#define MSSIM_STRUCT(Name) \
  template <class Real>    \
  struct Name
#define MSSIM_OF(Name) Name<Real>
#define MSSIM_GIVES(Name) \
  template <class Real>   \
  inline auto
#include "kernels/floor_law.h"
// After what it needs.
#include "kernels/body_contact.h"
#undef MSSIM_LAW
#undef MSSIM_STRUCT
#undef MSSIM_OF
#undef MSSIM_GIVES

}  // namespace mssim::body_law
