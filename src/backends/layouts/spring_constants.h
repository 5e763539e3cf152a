#pragma once

#include <vector>

#include "backends/interface/backend.h"
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

/// Those of a cloth's springs, by GridSpringKind. Throws Unsupported where its nodes differ in mass.
inline std::vector<SpringConstants> spring_constants_of(const System& system, const GridPatch& grid) {
  const double mass = require_uniform_mass(system);
  std::vector<SpringConstants> constants;
  for (const GridSpringKind kind : {structural, shear, bending})
    constants.emplace_back(system.materials[kind], static_cast<double>(grid.rest_length(kind)), mass);
  return constants;
}

}  // namespace mssim
