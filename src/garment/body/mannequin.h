#pragma once

#include <cstdint>

#include "garment/body/body_measures.h"
#include "geometry/surface.h"

namespace mssim {

/// How finely a mannequin is cut.
struct MannequinResolution {
  /// Points around the torso; a leg has about two thirds as many, and cells are about square at the hip. 20
  /// makes 2,400 triangles of the reference body, 96 45,000, 128 79,000.
  std::uint32_t cells_around = 96;

  bool operator==(const MannequinResolution&) const = default;
};

/// A dress form with legs and feet: a torso and two legs, each a closed tube of elliptic sections that is
/// monotone between them; the legs' tops end inside the torso. The girths are the measures' at their heights,
/// whatever the resolution; from the hip upwards the torso is the whole section. The thighs meet nowhere:
/// below the crotch's height the body is two legs. Throws InputError that names measure, value and remedy for
/// measures that make no body (check_measures), for legs that would touch, and for points around that are not
/// a multiple of four from 16 to 512.
Surface mannequin(const BodyMeasures& measures, const MannequinResolution& resolution = {});

}  // namespace mssim
