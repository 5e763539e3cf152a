#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "model/system.h"

namespace mssim {

/// Alike bodies: all have the same springs, with the same constants, between corresponding nodes. A body is a
/// connected component of the springs. Its nodes are numbered by their position in the body's
/// reverse_cuthill_mckee(). `Real`, float or double, is what the backend steps with.
template <class Real>
struct AlikeBodiesOf {
  /// A spring to a later node.
  struct SpringAhead {
    std::uint32_t other;
    Real stiffness_rest;  ///< stiffness times rest length / mass, m/s^2
    bool operator==(const SpringAhead&) const = default;
  };

  SpringConstants<Real> constants{};  ///< divided by a node's mass
  std::vector<std::uint8_t> pinned;   ///< [nodes] 1 if pinned, else 0
  /// [nodes + 1] begin of each node's springs in `springs`; the last one is their number.
  std::vector<std::uint32_t> first_spring;
  std::vector<SpringAhead> springs;  ///< [springs] ascending by both ends
  /// [bodies][nodes] the scene's node numbers
  std::vector<std::vector<std::uint32_t>> bodies;

  std::size_t nodes() const { return pinned.size(); }
};
using AlikeBodies = AlikeBodiesOf<float>;

/// All bodies of a system, grouped by alikeness; groups are in the scene's order of their first bodies.
/// Nothing if springs of different materials meet, or joined nodes differ in mass.
template <class Real = float>
std::optional<std::vector<AlikeBodiesOf<Real>>> find_alike_bodies(const System& system);

/// Number of vectors of `lanes` lanes for the springs of these bodies, one body per lane.
template <class Real>
std::size_t spring_vectors(const std::vector<AlikeBodiesOf<Real>>& bodies, std::size_t lanes);

/// Finds alike bodies if vectors of `lanes` lanes per spring pay off (AlikeSlices): if at least one of
/// `per_body` lanes has a body of its own, counted over the springs.
template <class Real = float>
std::optional<std::vector<AlikeBodiesOf<Real>>> alike_bodies_for(const System& system, std::size_t lanes,
                                                                 double per_body);

/// Storage of the nodes of alike bodies: a slice has one node of as many bodies as there are lanes, so the
/// ends of a spring of all of them are two slices, [x y z u v w][lanes] each. Unused lanes repeat the group's
/// first body.
struct AlikeSlices {
  static constexpr std::size_t components = 6;

  /// As many bodies as lanes. Node i is in slice first_slice + i.
  struct Group {
    std::size_t shape;  ///< index of the AlikeBodies
    std::size_t first_slice;
  };

  std::size_t lanes = 0;
  std::size_t nodes = 0;                  ///< in the scene
  std::size_t count = 0;                  ///< number of slices
  std::vector<Group> groups;              ///< by shape
  std::vector<std::uint32_t> scene_node;  ///< [slices][lanes]

  template <class Real>
  AlikeSlices(const std::vector<AlikeBodiesOf<Real>>& bodies, std::size_t lane_count);
  std::size_t floats() const { return scene_node.size() * components; }  ///< numbers of a pair
  /// Converts to and from a pair, [slices][components][lanes]. Rounds to Real.
  template <class Real>
  void write(const State& state, Real* pair) const;
  template <class Real>
  State read(const Real* pair) const;
};

}  // namespace mssim
