#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "backends/implicit/constraints/compliance.h"
#include "backends/interface/backend.h"
#include "backends/layouts/aligned_array.h"
#include "backends/layouts/node_records.h"
#include "backends/threads/team_gain.h"
#include "model/system.h"

namespace mssim {

/// Bodies for vectors of `lanes` springs of a colour: the nodes as records (node_records.h), renumbered so
/// that neighbours stand near each other (reverse Cuthill-McKee), and the springs side by side. What no
/// spring connects is stepped apart, in parts, each of which stays in a thread's cache for all small steps
/// of a call.
struct SpringBatches {
  /// Springs of a colour whose constants are the same, in vectors [begin, end) of `springs`.
  struct Batch {
    std::size_t begin, end;
    float stiffness, damping;               ///< as in Compliance
    float first_mobility, second_mobility;  ///< 1/kg
  };
  /// Batches [begin, end) of a colour.
  struct Colour {
    std::size_t begin, end;
  };
  /// Vectors [begin, end) of nodes and colours [first_colour, end_colour) of one or several bodies.
  struct Part {
    std::size_t begin, end;
    std::size_t first_colour, end_colour;
  };

  std::size_t lanes = 0;
  std::vector<std::uint32_t> slot;  ///< [nodes] the record of the scene's node
  AlignedArray nodes;               ///< [slots][record_floats]
  AlignedArray rest;                ///< [slots / lanes][x y z][lanes] m, what x y z lack (carried_sum-inl.h)
  AlignedArray free;                ///< [slots] 1 where a node may move, 0 for a pin and where there is none
  /// [vectors][3][lanes] where the records of both ends begin, in units of offset_floats and as
  /// std::uint32_t, then the stiffness of Compliance times the rest length. The last vector of a batch
  /// repeats its last spring, which writes the same once more.
  AlignedArray springs;
  static constexpr std::size_t offset_floats = record_floats;
  std::vector<Batch> batches;
  std::vector<Colour> colours;
  std::vector<Part> parts;

  std::size_t threads = 1;
  std::vector<std::vector<std::size_t>> own_parts;  ///< [threads] what a thread does alone
  std::vector<std::size_t> shared_parts;            ///< what all do together, colour by colour

  float h_s = 0;   ///< the small step
  float fall = 0;  ///< m/s, of gravity in a small step
  float kept = 0;  ///< part of the velocity that the air leaves in a small step
  Surroundings surroundings{};
  std::size_t substeps = 1;  ///< in a step
  TeamGain team_gain;        ///< of the threads that share parts

  SpringBatches(const System& system, double dt_s, std::size_t lane_count, std::size_t thread_count);
  void set_state(const State& state);
  State state() const;

  /// Floats from the start of `rest` to the x of a slot.
  std::size_t rest_offset(std::size_t at) const { return at / lanes * 3 * lanes + at % lanes; }
  std::size_t vectors(const Colour& colour) const {
    return batches[colour.end - 1].end - batches[colour.begin].begin;
  }
};

}  // namespace mssim
