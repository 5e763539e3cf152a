#pragma once

#include "model/vec3.h"

namespace mssim {

/// Four floats that are computed with side by side: a Vec3 and a zero, as device records hold it, in one
/// 128-bit register, which every x86-64 and ARM64 processor has.
struct Quad {
  using Lanes = float __attribute__((vector_size(16)));
  Lanes lanes{};

  friend Quad operator+(const Quad& a, const Quad& b) { return {a.lanes + b.lanes}; }
  friend Quad operator-(const Quad& a, const Quad& b) { return {a.lanes - b.lanes}; }
  friend Quad operator*(float s, const Quad& a) { return {s * a.lanes}; }
};

inline Quad quad_of(const Vec3<float>& a) { return {Quad::Lanes{a.x, a.y, a.z, 0}}; }
inline Vec3<float> vec3_of(const Quad& a) { return {a.lanes[0], a.lanes[1], a.lanes[2]}; }

/// a * b + c, in two roundings like the host's other one (backends/host_lines.h).
inline Quad mul_add(float a, const Quad& b, const Quad& c) { return a * b + c; }

}  // namespace mssim
