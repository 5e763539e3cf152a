#include "backends/layouts/slice_entries.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "backends/layouts/node_records.h"
#include "backends/openmp/openmp.h"
#include "integrators/all_integrators.h"
#include "tests/support/solid_system.h"

namespace mssim {
namespace {

TEST(SliceEntries, NameNeighboursAndRestLengthsAndBehindThemTheFirstRecord) {
  constexpr std::size_t lanes = 4;
  const SlicedGraph graph(solid_block(3, 4, 5), lanes);
  const auto record_of = [](std::uint32_t slot) { return slot + 7; };
  const AlignedArray entries = slice_entries(graph, record_floats, record_of);
  const auto offset = [&](std::size_t entry, std::size_t lane) {
    return std::bit_cast<std::uint32_t>(entries.data()[entry * 2 * lanes + lane]) * slice_offset_floats;
  };
  ASSERT_EQ(entries.size(), (graph.entries() + 1) * 2 * lanes);
  for (std::size_t entry = 0; entry < graph.entries(); ++entry)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t element = entry * lanes + lane;
      EXPECT_EQ(offset(entry, lane), record_of(graph.neighbour[element]) * record_floats);
      EXPECT_EQ(entries.data()[entry * 2 * lanes + lanes + lane], graph.stiffness_rest[element]);
    }
  for (std::size_t lane = 0; lane < lanes; ++lane) EXPECT_EQ(offset(graph.entries(), lane), 0U);
}

// Empty entries and places without a node have the length zero: no mask takes their force away.
TEST(SliceEntries, OfANodeWithoutSpringsGiveItNoForce) {
  System system = solid_block(3, 3, 3);
  const std::size_t alone = system.nodes();
  system.start.position.push_back({5, 5, 5});
  system.start.velocity.push_back({1, 0, 0});
  system.node_mass.push_back(1);
  system.gravity = 0;
  system.viscous_damping = 0;
  constexpr double dt_s = 1e-4;
  constexpr int steps = 10;
  for (const std::string_view set : openmp_instruction_sets()) {
    const auto backend = make_openmp(system, *find_integrator("semi-euler"), dt_s, {1, ""}, set);
    backend->step(steps);
    const State state = backend->state();
    EXPECT_NEAR(state.position[alone].x, 5 + steps * dt_s, 1e-5) << set;
    EXPECT_EQ(state.position[alone].y, 5) << set;
    EXPECT_EQ(state.position[alone].z, 5) << set;
  }
}

}  // namespace
}  // namespace mssim
