#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "model/system.h"

namespace mssim {

/// Bodies that are alike: all have the same springs between the same nodes, of the same constants, whatever
/// else their nodes do. A body is what springs join. Its nodes are numbered by their place in the body's
/// reverse_cuthill_mckee().
struct AlikeBodies {
  /// To a node further behind.
  struct SpringAhead {
    std::uint32_t other;
    float stiffness_rest;  ///< stiffness times rest length / mass, m/s^2
    bool operator==(const SpringAhead&) const = default;
  };

  SpringConstants<float> constants{};  ///< divided by a node's mass
  std::vector<std::uint8_t> pinned;    ///< [nodes] 1 where it is, else 0
  /// [nodes + 1] where each node's begin in `springs`; the last one is their number.
  std::vector<std::uint32_t> first_spring;
  std::vector<SpringAhead> springs;  ///< [springs] ascending by both ends
  /// [bodies][nodes] the scene's nodes
  std::vector<std::vector<std::uint32_t>> bodies;

  std::size_t nodes() const { return pinned.size(); }
};

/// All bodies of a system, by what they are alike in; the first of each in the order of the scene. Nothing
/// where springs of unlike materials meet, or nodes of unlike mass are joined.
std::optional<std::vector<AlikeBodies>> find_alike_bodies(const System& system);

/// Vectors of so many lanes that the springs of these bodies are, each of as many bodies as there are lanes.
std::size_t spring_vectors(const std::vector<AlikeBodies>& bodies, std::size_t lanes);

/// Finds alike bodies where they are worth a vector of so many lanes for each of their springs (AlikeSlices):
/// where at least one of `per_body` lanes has a body of its own, counted over the springs.
std::optional<std::vector<AlikeBodies>> alike_bodies_for(const System& system, std::size_t lanes,
                                                         double per_body);

/// Where the nodes of alike bodies lie: a slice holds one node of as many bodies as there are lanes, so that
/// the ends of a spring of all of them are two slices, [x y z u v w][lanes] each. Lanes for which there is no
/// body repeat the group's first one.
struct AlikeSlices {
  static constexpr std::size_t components = 6;

  /// As many bodies as lanes. Node i is in slice first_slice + i.
  struct Group {
    std::size_t shape;  ///< of the AlikeBodies
    std::size_t first_slice;
  };

  std::size_t lanes = 0;
  std::size_t nodes = 0;                  ///< of the scene
  std::size_t count = 0;                  ///< slices
  std::vector<Group> groups;              ///< shape after shape
  std::vector<std::uint32_t> scene_node;  ///< [slices][lanes]

  AlikeSlices(const std::vector<AlikeBodies>& bodies, std::size_t lane_count);
  std::size_t floats() const { return scene_node.size() * components; }  ///< of a pair
  /// To and from a pair, [slices][components][lanes]. Rounds to float.
  void write(const State& state, float* pair) const;
  State read(const float* pair) const;
};

}  // namespace mssim
