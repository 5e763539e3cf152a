#pragma once

#include <cstdint>

namespace mssim {

/// How over-elongated springs are kept from growing (Vassilev's loop 5).
enum class VelocityCorrection : std::uint8_t {
  none,
  /// As published: what lengthens such a spring is taken from the velocities of its ends.
  published,
  /// Such a spring has to shorten, too: its ends may part at -rate * excess / dt at most.
  bounded
};

/// What dressing takes beside springs: everything about one step that is no property of the cloth. The step
/// is Vassilev's Algorithm 1; ARCHITECTURE.md says where it goes beyond what was published.
struct DressingSettings {
  /// While the seams close there is no friction and, by default, no gravity: the panels would fall before
  /// they hold.
  double seam_force = 4;               ///< N per metre of seam at first
  double seam_force_doubling_s = 0.5;  ///< the force grows by its first value in this time
  double seaming_damping = 8;          ///< 1/s, per mass; draping takes System::viscous_damping
  double seaming_gravity = 0;          ///< share of gravity that acts meanwhile
  double longest_seaming_s = 1;        ///< what is open then is sewn as it is
  /// A joint nearer than this is sewn: from then on its gap closes by an inelastic constraint on velocities.
  double sewn_gap = 0.01;      ///< m
  double closing_share = 0.2;  ///< of a sewn joint's gap that a step closes at most
  double closing_speed = 0.5;  ///< m/s, at most
  double friction = 0.5;       ///< Coulomb's coefficient on the body, while draping
  double push_speed = 1;       ///< m/s at which a point inside the body is moved out, at most

  VelocityCorrection correction = VelocityCorrection::bounded;
  double correction_threshold = 0.05;   ///< elongation over rest length
  double correction_rate = 0.5;         ///< see VelocityCorrection::bounded
  std::uint32_t correction_sweeps = 2;  ///< over all springs, forwards and backwards by turns
};

}  // namespace mssim
