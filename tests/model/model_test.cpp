#include <cstring>

#include "geometry/surface.h"
#include "model/node_shape.h"
#include "model/system.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"
#include "text/text.h"

namespace mssim {
namespace {

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

TEST(ModeBound, IsGershgorinsOfTheNodeWithMost) {
  // Of the middle node: 2 (100 + 60) / 0.5 and 2 (3 + 1) / 0.5, and the air's 0.25.
  const ModeBound bound = mode_bound(three_nodes());
  EXPECT_DOUBLE_EQ(bound.stiffness, 640);
  EXPECT_DOUBLE_EQ(bound.damping, 16.25);
  // 3 / 100 and 1 / 60 are different proportions: 2 100 / 0.5 and 2 60 / 0.5, 2 3 / 0.5 and 2 1 / 0.5.
  ASSERT_EQ(bound.parts.size(), 2U);
  EXPECT_DOUBLE_EQ(bound.parts[0].stiffness, 400);
  EXPECT_DOUBLE_EQ(bound.parts[1].stiffness, 240);
  EXPECT_DOUBLE_EQ(bound.parts[0].damping, 12);
  EXPECT_DOUBLE_EQ(bound.parts[1].damping, 4);
  EXPECT_TRUE(mode_bound(cloth_system(4, 4)).parts.empty()) << "of its springs all damp alike";
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

TEST(RoundToSingle, LeavesNothingThatAFloatCannotHold) {
  State state;
  for (int i = 1; i < 50; ++i) state.add({1.0 / i, -3.0 / i, 1e-3 * i}, {0.1 * i, 0.7 / i, -1e-9 / i});
  const State exact = state;
  round_to_single(state);
  for (std::size_t i = 0; i < state.position.size(); ++i)
    for (const auto& [rounded, before] : {std::pair{state.position[i].x, exact.position[i].x},
                                          {state.position[i].y, exact.position[i].y},
                                          {state.position[i].z, exact.position[i].z},
                                          {state.velocity[i].x, exact.velocity[i].x},
                                          {state.velocity[i].z, exact.velocity[i].z}}) {
      EXPECT_EQ(rounded, static_cast<double>(static_cast<float>(rounded))) << "more than 24 bits";
      EXPECT_NEAR(rounded, before, 0x1p-24 * std::abs(before));
    }
}

TEST(Spectrum, OfAChainIsThatOfItsClosedForm) {
  for (const std::uint32_t free : {1U, 2U, 7U, 40U}) {
    System system = spring_chain(free);
    system.materials[0].damping = 0.01;
    system.viscous_damping = 3;
    // 4 k/m sin^2(j pi / (2 (n + 1))) for j = 1 .. n.
    const double sine = std::sin(free * std::numbers::pi / (2 * (free + 1)));
    const Spectrum spectrum = spectrum_at(system, system.start);
    EXPECT_NEAR(spectrum.stiffness / (4 * 200 / 2e-5 * sine * sine), 1, 1e-3) << free;
    EXPECT_NEAR(spectrum.damping / (4 * 0.01 / 2e-5 * sine * sine + 3), 1, 1e-3) << free;
  }
}

TEST(Spectrum, OfAStrainedSpringHasWhatItDoesSideways) {
  System system = spring_chain(1);
  for (Spring& spring : system.springs) spring.rest_length = 0.005F;
  system.materials[0].stiffness = 1;
  // Along: 2 k/m. With springs of twice their length, sideways 2 k (1 - 1/2)/m, which is less.
  EXPECT_NEAR(spectrum_at(system, system.start).stiffness, 2 / 2e-5, 1e-3 * 2 / 2e-5);
  // Compressed to a quarter: sideways 2 k (1 - 4)/m, larger and of the other sign.
  for (Spring& spring : system.springs) spring.rest_length = 0.04F;
  EXPECT_NEAR(spectrum_at(system, system.start).stiffness, -2 * 3 / 2e-5, 1e-3 * 6 / 2e-5);
}

TEST(Spectrum, IsBelowGershgorinsBoundAndNotFarBelow) {
  const System system = cloth_system(12, 12);
  const Spectrum spectrum = spectrum_at(system, system.start);
  const ModeBound bound = mode_bound(system);
  EXPECT_LT(spectrum.stiffness, bound.stiffness);
  EXPECT_GT(spectrum.stiffness, 0.2 * bound.stiffness);
  EXPECT_LT(spectrum.damping, bound.damping);
}

State state_of(std::size_t nodes) {
  State state;
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto x = static_cast<double>(i);
    state.add({x, 0.5 * x, 1 / (x + 1)}, {-x, 3, 0});
  }
  return state;
}

TEST(StateHash, IsThatOfTheBytesOfItsNumbersInATree) {
  const State state = state_of(state_hash_leaf + 1);
  const auto leaf = [&](std::size_t first, std::size_t end) {
    std::string bytes;
    for (std::size_t i = first; i < end; ++i)
      for (const Vec3d& vector : {state.position[i], state.velocity[i]})
        for (const double number : {vector.x, vector.y, vector.z}) {
          char word[8];
          std::memcpy(word, &number, 8);  // the lowest byte first, on all processors that mssim runs on
          bytes.append(word, 8);
        }
    const std::uint64_t hash = fnv1a_64(bytes);
    char word[8];
    std::memcpy(word, &hash, 8);
    return std::string(word, 8);
  };
  EXPECT_EQ(state_hash(state),
            fnv1a_64(leaf(0, state_hash_leaf) + leaf(state_hash_leaf, state_hash_leaf + 1)));
}

TEST(StateHash, ChangesWithEveryBit) {
  const State state = state_of(10);
  std::set<std::uint64_t> hashes{state_hash(state)};
  State next = state, zero = state, swapped = state, fewer = state_of(9);
  next.position[9].z = std::nextafter(next.position[9].z, 2);
  zero.velocity[3].z = -0.0;
  std::swap(swapped.position[1], swapped.position[2]);
  for (const State& other : {next, zero, swapped, fewer}) hashes.insert(state_hash(other));
  EXPECT_EQ(hashes.size(), 5U);
  EXPECT_EQ(state_hash(state_of(10)), state_hash(state));
}

TEST(StateHash, IsWrittenInDigitsThatAreReadBack) {
  for (const std::uint64_t value : {std::uint64_t{0}, std::uint64_t{0x0123456789abcdef}, UINT64_MAX})
    EXPECT_EQ(from_hex(to_hex(value)), value);
  for (const char* text :
       {"", "0", "0123456789abcdeg", "0123456789ABCDEF", "00123456789abcdef", "0x23456789abcdef"})
    EXPECT_EQ(from_hex(text), std::nullopt) << text;
}

TEST(NodeSurface, OfBodiesIsClosedAndHasNoInnerNodes) {
  const System system = two_solid_blocks();
  const NodeSurface surface = surface_of(shape_of(system.topology), system.nodes());
  Surface closed{{}, surface.triangles};
  for (const std::uint32_t node : surface.node) closed.points.push_back(system.start.position[node]);
  EXPECT_NO_THROW(validate_surface(closed, "two blocks"));  // every point in use, every edge in two triangles
  EXPECT_TRUE(std::ranges::is_sorted(surface.node));
  EXPECT_EQ(surface.node.size(), system.nodes() - 2 * 3 * 1 - 1 * 1 * 5);
}

}  // namespace
}  // namespace mssim
