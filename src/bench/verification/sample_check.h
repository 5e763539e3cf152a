#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "backends/interface/backend.h"

namespace mssim {

/// Where the samples of a round start: at the system's start, with a wave on the velocities that is another
/// one for every number. Nobody knows where it leads who has not stepped it. The wave strains springs by
/// about a thousandth, and moves nodes further than the tolerance of a comparison. In single precision.
State sample_start(const System& system, std::uint32_t number);

/// What is kept of the state that a sample has ended with.
struct SampleEnd {
  int steps = 0;
  std::vector<Vec3d> positions;  ///< of the nodes that are looked at, m
  double energy_j = 0;           ///< of all nodes
};

/// A sample's end. Of a large scene every so manieth node is looked at, from the one after `first` on, so
/// that they are a million at most.
SampleEnd sample_end(const System& system, const State& state, int steps, std::size_t first);

/// Compares ends of samples that all began with `start` with the double-precision reference of as many steps:
/// for each of them why it is wrong, or nothing. `first` as for sample_end.
///
/// Allowed is the tolerance of a verification of as many steps (position_tolerance). But motions of the scene
/// itself (folds of a cloth under pressure) may make more of a rounding than a random walk does, which a
/// second reference shows, whose state is rounded to single precision after every step. Backends in single
/// precision end 0.5 to 1.7 times as far from the first one as it does with semi-euler, and 2 to 4 times with
/// rk4, whose steps round four times (cloths and bodies of the paper, 100 to 2,000 steps). Where that is
/// more, four times that a rounding is allowed, in scenes of up to a million nodes; and after a node has met
/// the floor the way of the fastest node in four steps besides, because a rounding may let a node land a step
/// later.
std::vector<std::string> check_samples(const System& system, const Integrator& integrator, double dt_s,
                                       const State& start, std::size_t first,
                                       std::span<const SampleEnd> ends);

}  // namespace mssim
