#pragma once

#include "model/system.h"

namespace mssim {

/// What kernels/spring_law.h asks for, divided by the mass of a node, so that the force is an acceleration.
struct SpringConstants {
  float stiffness;       ///< 1/s^2
  float stiffness_rest;  ///< stiffness times rest length, m/s^2
  float damping;         ///< 1/s

  /// rest_length in m, mass in kg.
  SpringConstants(const SpringMaterial& material, double rest_length, double mass)
      : stiffness(static_cast<float>(material.stiffness / mass)),
        stiffness_rest(static_cast<float>(material.stiffness * rest_length / mass)),
        damping(static_cast<float>(material.damping / mass)) {}
};

}  // namespace mssim
