// The laws of kernels/ for a number type `Real` of C++. Include it inside a namespace that has the names the
// texts need, after defining MSSIM_LAW_INLINE (the prefix of inline functions). It may be included several
// times, so it has no guard.

#define MSSIM_LAW       \
  template <class Real> \
  MSSIM_LAW_INLINE Real
#define MSSIM_STRUCT(Name) \
  template <class Real>    \
  struct Name
#define MSSIM_MEMBER(name) Real name{};
#define MSSIM_OF(Name) Name<Real>
#define MSSIM_GIVES(Name) \
  template <class Real>   \
  MSSIM_LAW_INLINE Name<Real>
#define MSSIM_VECTOR_LAW              \
  template <class Vector, class Real> \
  MSSIM_LAW_INLINE Vector
#define dot_product dot

#include "kernels/node_laws.h"
#include "kernels/spring_law.h"
// After the names that they need.
#include "kernels/body_contact.h"
#include "kernels/garment_laws.h"
#include "kernels/spring_jacobian.h"

/// Constants of a spring, each made from the constants of the same name: make(number...).
template <class Real, class Make, class... From>
MSSIM_LAW_INLINE SpringConstants<Real> constants_from(const Make& make, const From&... from) {
#define MSSIM_MADE(name, info) static_cast<Real>(make(from.name...)),
  return {MSSIM_SPRING_CONSTANTS(MSSIM_MADE)};
#undef MSSIM_MADE
}
/// A spring with such constants, and its stiffness times rest length made in the same way.
template <class Real, class Make, class... From>
MSSIM_LAW_INLINE LinearSpring<Real> spring_from(const Make& make, const From&... from) {
  return {constants_from<Real>(make, from.constants...), static_cast<Real>(make(from.stiffness_rest...))};
}

#undef MSSIM_LAW
#undef MSSIM_STRUCT
#undef MSSIM_MEMBER
#undef MSSIM_CONSTANT
#undef MSSIM_OF
#undef MSSIM_GIVES
#undef MSSIM_VECTOR_LAW
#undef dot_product
#undef MSSIM_LAW_INLINE
