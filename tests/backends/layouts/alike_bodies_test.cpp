#include "backends/layouts/alike_bodies.h"

#include <bit>
#include <map>

#include "backends/layouts/packed_springs.h"
#include "tests/support/backend_checks.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

TEST(AlikeBodies, AreThoseOfTheSameSprings) {
  System system = alike_bodies(solid_block(3, 4, 3), 5);
  append_body(system, solid_block(2, 2, 2), {5, 0, 0});
  append_body(system, solid_block(3, 4, 3), {6, 0, 0});
  const auto found = find_alike_bodies(system);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 2U);
  EXPECT_EQ(found->front().nodes(), 36U);
  EXPECT_EQ(found->front().bodies.size(), 6U);
  EXPECT_EQ(found->back().nodes(), 8U);
  EXPECT_EQ(found->back().bodies.size(), 1U);
}

TEST(AlikeBodies, AreToldApartByAnythingThatSpringsOrNodesHave) {
  const System block = solid_block(3, 3, 3);
  const std::pair<const char*, std::function<void(System&)>> changes[] = {
      {"a rest length", [](System& body) { body.springs[7].rest_length *= 1.001F; }},
      {"a spring less", [](System& body) { body.springs.erase(body.springs.begin() + 11); }},
      {"stiffness", [](System& body) { body.materials[0].stiffness *= 2; }},
      {"damping", [](System& body) { body.materials[0].damping *= 2; }},
      {"masses", [](System& body) { body.node_mass.assign(body.nodes(), 0.005); }},
      {"a pin", [](System& body) {
         body.pins = {4};
         body.start.velocity[4] = {};
       }}};
  for (const auto& [what, change] : changes) {
    System system = alike_bodies(block, 2), other = block;
    change(other);
    append_body(system, other, {2, 0, 0});
    const auto found = find_alike_bodies(system);
    ASSERT_TRUE(found) << what;
    ASSERT_EQ(found->size(), 2U) << what;
    EXPECT_EQ(found->front().bodies.size(), 2U) << what;
  }
}

TEST(AlikeBodies, AreNotSoughtWhereNodesThatSpringsJoinAreUnlike) {
  System masses = alike_bodies(solid_block(2, 2, 2), 2);
  masses.node_mass[3] *= 1.5;
  EXPECT_FALSE(find_alike_bodies(masses));
  System materials = alike_bodies(solid_block(2, 2, 2), 2);
  materials.materials.push_back({100, 0});
  materials.springs[3].kind = 2;
  EXPECT_FALSE(find_alike_bodies(materials));
}

TEST(AlikeBodies, AreForLanesWhereTheyAreMany) {
  const System block = solid_block(3, 3, 3);
  EXPECT_FALSE(alike_bodies_for(block, 16, 3));
  EXPECT_FALSE(alike_bodies_for(alike_bodies(block, 5), 16, 3));
  EXPECT_TRUE(alike_bodies_for(alike_bodies(block, 6), 16, 3));
  EXPECT_FALSE(alike_bodies_for(alike_bodies(block, 6), 16, 2));
  EXPECT_TRUE(alike_bodies_for(alike_bodies(block, 8), 16, 2));
  EXPECT_TRUE(alike_bodies_for(alike_bodies(block, 3), 8, 3));
  EXPECT_FALSE(alike_bodies_for(block, 4, 3));
  EXPECT_TRUE(alike_bodies_for(alike_bodies(block, 2), 4, 3));
  EXPECT_TRUE(alike_bodies_for(block, 1, 3));
  System mixed = alike_bodies(block, 16);
  EXPECT_TRUE(alike_bodies_for(mixed, 16, 3));
  append_body(mixed, solid_block(9, 9, 9), {9, 0, 0});
  EXPECT_FALSE(alike_bodies_for(mixed, 16, 3)) << "most of its springs are in one body";
  System unlike = alike_bodies(block, 16);
  unlike.node_mass[3] *= 2;
  EXPECT_FALSE(alike_bodies_for(unlike, 16, 3));
}

TEST(AlikeBodies, NeedAVectorForASpringOfAsManyBodiesAsThereAreLanes) {
  const auto bodies = find_alike_bodies(alike_bodies(solid_block(2, 2, 2), 9));
  ASSERT_TRUE(bodies);
  const std::size_t springs = bodies->front().springs.size();
  EXPECT_EQ(spring_vectors(*bodies, 4), 3 * springs);
  EXPECT_EQ(spring_vectors(*bodies, 8), 2 * springs);
  EXPECT_EQ(spring_vectors(*bodies, 9), springs);
  EXPECT_EQ(spring_vectors(*bodies, 16), springs);
}

constexpr std::size_t slice_nodes = PackedSprings::slice_nodes;

/// The unit of a slice's node in an entry, in slots.
struct Unit {
  std::uint32_t first, second, kind;
  float rest_length;
};

Unit unit_at(const PackedSprings& packed, std::size_t entry, std::size_t node) {
  const std::uint32_t* at = &packed.units[entry * 2 * slice_nodes + node];
  return {static_cast<std::uint32_t>(packed.entries[entry].slice * slice_nodes + node), at[0],
          packed.entries[entry].kind, std::bit_cast<float>(at[slice_nodes])};
}

/// A unit in the scene's numbers, the lower node first.
using Ends = std::tuple<std::uint32_t, std::uint32_t, float, std::uint32_t>;
Ends in_scene(const PackedSprings& packed, const Unit& unit) {
  const auto [low, high] = std::minmax(packed.scene_node[unit.first], packed.scene_node[unit.second]);
  return {low, high, unit.rest_length, unit.kind};
}

/// A body in whose nodes springs of two materials meet.
System mixed_block() {
  System system = solid_block(7, 5, 6);
  system.materials.push_back({100, 0});
  for (std::size_t i = 0; i < system.springs.size(); i += 3) system.springs[i].kind = 1;
  return system;
}

class EachSystem : public testing::TestWithParam<int> {
 protected:
  const System system = GetParam() == 0   ? solid_block(7, 5, 6)
                        : GetParam() == 1 ? two_solid_blocks()
                        : GetParam() == 2 ? solid_block(2, 2, 2)
                        : GetParam() == 3 ? cloth_system(13, 9)
                                          : mixed_block();
  const PackedSprings packed{system};
};
INSTANTIATE_TEST_SUITE_P(Systems, EachSystem, testing::Range(0, 5));

TEST_P(EachSystem, PacksEverySpringOnceInEntriesOfOneSliceAndKind) {
  std::map<Ends, int> springs;
  for (const Spring& spring : system.springs)
    ++springs[{std::min(spring.first, spring.second), std::max(spring.first, spring.second),
               spring.rest_length, spring.kind}];
  std::size_t found = 0;
  for (std::size_t slice = 0; slice < packed.slices(); ++slice)
    for (std::size_t entry = packed.first_entry[slice]; entry < packed.first_entry[slice + 1]; ++entry) {
      EXPECT_EQ(packed.entries[entry].slice, slice);
      for (std::size_t node = 0; node < slice_nodes; ++node) {
        const Unit unit = unit_at(packed, entry, node);
        if (unit.rest_length == PackedSprings::empty_unit) {
          EXPECT_EQ(unit.second, unit.first) << "a device may read what an empty unit names";
          continue;
        }
        --springs[in_scene(packed, unit)];
        ++found;
      }
    }
  EXPECT_EQ(found, system.springs.size());
  for (const auto& [spring, count] : springs) EXPECT_EQ(count, 0) << std::get<0>(spring);
  EXPECT_EQ(packed.entries.size(), packed.first_entry.back());
}

TEST_P(EachSystem, ListsEveryForceAtItsSecondEndOnce) {
  constexpr std::size_t list_nodes = PackedSprings::list_nodes;
  std::vector<std::size_t> node_at(slice_nodes);  // by the slot of the force
  for (std::size_t node = 0; node < slice_nodes; ++node) node_at[PackedSprings::force_place(node)] = node;
  std::vector<int> listed(packed.unit_count(), 0);
  for (std::size_t list = 0; list < packed.slots() / list_nodes; ++list)
    for (std::size_t i = packed.first_subtracted[list] * list_nodes;
         i < packed.first_subtracted[list + 1] * list_nodes; ++i) {
      const std::uint32_t force = packed.subtracted[i];
      if (force == packed.no_force()) continue;
      ASSERT_LT(force, packed.unit_count());
      ++listed[force];
      const Unit unit = unit_at(packed, force / slice_nodes, node_at[force % slice_nodes]);
      EXPECT_EQ(unit.second, list * list_nodes + i % list_nodes);
      EXPECT_NE(unit.rest_length, PackedSprings::empty_unit);
    }
  for (const int times : listed) EXPECT_LE(times, 1);
  EXPECT_EQ(static_cast<std::size_t>(std::count(listed.begin(), listed.end(), 1)), system.springs.size());
}

TEST(PackedSprings, HaveFewEmptyUnitsInABody) {
  const System system = solid_block(13, 13, 13);
  const PackedSprings packed(system);
  EXPECT_LT(static_cast<double>(packed.unit_count()), 1.12 * static_cast<double>(system.springs.size()));
  EXPECT_LT(static_cast<double>(packed.subtracted.size()), 1.12 * static_cast<double>(system.springs.size()));
}

}  // namespace
}  // namespace mssim
