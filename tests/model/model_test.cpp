#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "model/energy.h"
#include "model/system.h"
#include "model/topology.h"

namespace mssim {
namespace {

struct PublishedCloth {
  std::uint32_t rows, columns;
  std::uint64_t nodes, springs;
};
// Hong et al. 2016, Table 1.
constexpr std::array<PublishedCloth, 6> published_cloths{{{50, 50, 2500, 29004},
                                                          {70, 70, 4900, 57404},
                                                          {100, 100, 10000, 118004},
                                                          {200, 200, 40000, 476004},
                                                          {400, 500, 200000, 2391004},
                                                          {500, 700, 350000, 4188004}}};

TEST(GridPatch, HasHalfOfThePublishedSpringsOfEveryCloth) {
  for (const PublishedCloth& cloth : published_cloths) {
    EXPECT_EQ(std::uint64_t{cloth.rows} * cloth.columns, cloth.nodes);
    EXPECT_EQ(2 * count_springs(cloth.rows, cloth.columns), cloth.springs);
  }
}

TEST(GridPatch, ListsAsManySpringsAsItCountsAndNoneTwice) {
  for (const auto& [rows, columns] :
       {std::pair{1U, 1U}, {1U, 7U}, {2U, 2U}, {3U, 2U}, {9U, 11U}, {50U, 50U}}) {
    const auto springs = springs_of(GridPatch{rows, columns, 0.01});
    EXPECT_EQ(springs.size(), count_springs(rows, columns)) << rows << " x " << columns;
    std::set<std::pair<std::uint32_t, std::uint32_t>> ends;
    for (const Spring& spring : springs) {
      EXPECT_NE(spring.first, spring.second);
      EXPECT_LT(std::max(spring.first, spring.second), rows * columns);
      ends.insert(std::minmax(spring.first, spring.second));
    }
    EXPECT_EQ(ends.size(), springs.size());
  }
}

TEST(GridPatch, GivesInnerNodesTwelveNeighbours) {
  const GridPatch grid{9, 11, 0.01};
  std::set<std::uint32_t> neighbours;
  const std::uint32_t middle = grid.node(4, 5);
  for (const Spring& spring : springs_of(grid)) {
    if (spring.first == middle) neighbours.insert(spring.second);
    if (spring.second == middle) neighbours.insert(spring.first);
  }
  EXPECT_EQ(neighbours.size(), 12U);
}

/// Three nodes of 2, 0.5 and 1 kg, the first two joined by a spring of 5 m, the last two by one of 2 m.
System three_nodes() {
  System system;
  system.topology = TetrahedralMesh{};
  system.springs = {{0, 1, 4.5F, 0}, {1, 2, 2, 1}};
  system.materials = {{100, 3}, {60, 1}};
  system.node_mass = {2, 0.5, 1};
  system.gravity = 10;
  system.viscous_damping = 0.25;
  system.floor.height = 1;
  system.start.position = {{0, 1, 0}, {3, 1, 4}, {3, 3, 4}};
  system.start.velocity = {{1, 0, 0}, {0, 2, 0}, {}};
  return system;
}

TEST(StiffnessBound, IsGershgorinsOfTheNodeWithMost) {
  // Of the middle node: 2 (100 + 60) / 0.5 and 2 (3 + 1) / 0.5, and the air's 0.25.
  const StiffnessBound bound = stiffness_bound(three_nodes());
  EXPECT_DOUBLE_EQ(bound.stiffness, 640);
  EXPECT_DOUBLE_EQ(bound.damping, 16.25);
}

TEST(Energy, IsTheSumOfEachNodesAndSprings) {
  const System system = three_nodes();
  const Energy energy = energy_of(system, system.start);
  EXPECT_DOUBLE_EQ(energy.kinetic, 1 + 1);     // 2 kg at 1 m/s and 0.5 kg at 2 m/s
  EXPECT_DOUBLE_EQ(energy.elastic, 12.5);      // 100 N/m over 0.5 m
  EXPECT_DOUBLE_EQ(energy.gravitational, 20);  // 1 kg, 2 m above the floor
  EXPECT_DOUBLE_EQ(energy.total(), 34.5);
  // u . d of the springs is (-1, 2, 0) . (3, 0, 4) = -3 and (0, -2, 0) . (0, 2, 0) = -4: 3 9 / 25 + 1 16 / 4;
  // in the air 0.25 (2 1^2 + 0.5 2^2).
  EXPECT_DOUBLE_EQ(damping_power(system, system.start), 1.08 + 4 + 1);
}

double mantissa(double value) {
  int exponent = 0;
  return std::frexp(value, &exponent);
}

TEST(RoundToSingle, LeavesNothingThatAFloatCannotHold) {
  State state;
  for (int i = 1; i < 50; ++i) {
    state.position.push_back({1.0 / i, -3.0 / i, 1e-3 * i});
    state.velocity.push_back({0.1 * i, 0.7 / i, -1e-9 / i});
  }
  const State exact = state;
  round_to_single(state);
  for (std::size_t i = 0; i < state.position.size(); ++i)
    for (const auto& [rounded, before] : {std::pair{state.position[i].x, exact.position[i].x},
                                          {state.position[i].y, exact.position[i].y},
                                          {state.position[i].z, exact.position[i].z},
                                          {state.velocity[i].x, exact.velocity[i].x},
                                          {state.velocity[i].z, exact.velocity[i].z}}) {
      EXPECT_EQ(std::fmod(std::abs(mantissa(rounded)) * 0x1p24, 1.0), 0) << "more than 24 bits: " << rounded;
      EXPECT_NEAR(rounded, before, 0x1p-24 * std::abs(before));
    }
}

}  // namespace
}  // namespace mssim
