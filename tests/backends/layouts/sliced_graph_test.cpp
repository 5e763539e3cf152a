#include "backends/layouts/sliced_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <numeric>
#include <string>
#include <string_view>

#include "backends/interface/backend.h"
#include "backends/layouts/node_arrays.h"
#include "backends/layouts/spring_graph.h"
#include "backends/openmp/bodies.h"
#include "backends/openmp/openmp.h"
#include "integrators/all_integrators.h"
#include "integrators/integrators.h"
#include "tests/support/solid_system.h"

namespace mssim {
namespace {

using testing::HasSubstr;

/// Bodies of many shapes: among them less than a slice, one node short of a slice, several windows.
std::vector<System> bodies() {
  std::vector<System> systems{solid_block(2, 2, 2), solid_block(3, 4, 5), solid_block(3, 3, 7),
                              solid_block(9, 9, 9), two_solid_blocks()};
  systems.push_back(solid_block(3, 3, 3));  // with a node that hangs on nothing, and pins
  System& lone = systems.back();
  lone.start.position.push_back({1, 1, 1});
  lone.start.velocity.push_back({});
  lone.node_mass.push_back(0.001);
  lone.pins = {0, 13, 26};
  return systems;
}

class SlicedGraphOfLanes : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Widths, SlicedGraphOfLanes, testing::Values(1, 4, 8, 16, 64));

TEST_P(SlicedGraphOfLanes, NamesEverySpringOnceFromEachEndWithTheConstantsOfThatEnd) {
  for (const System& system : bodies()) {
    const SlicedGraph graph(system, GetParam());
    const std::vector<std::uint32_t> place = places_in(reverse_cuthill_mckee(system.nodes(), system.springs));
    ASSERT_EQ(graph.nodes(), system.nodes());
    std::map<std::pair<std::uint32_t, std::uint32_t>, float> expected, found;
    for (const Spring& spring : system.springs)
      for (const auto& [node, other] :
           {std::pair{spring.first, spring.second}, {spring.second, spring.first}})
        expected[{node, other}] =
            static_cast<float>(system.materials[spring.kind].stiffness *
                               static_cast<double>(spring.rest_length) / system.node_mass[node]);
    for (std::size_t slice = 0; slice < graph.slices(); ++slice)
      for (std::size_t lane = 0; lane < graph.lanes; ++lane) {
        const std::size_t slot = slice * graph.lanes + lane;
        std::uint32_t last = 0;
        for (std::size_t e = graph.first_entry[slice]; e < graph.first_entry[slice + 1]; ++e) {
          const std::size_t element = e * graph.lanes + lane;
          if (graph.stiffness_rest[element] < 0) continue;
          ASSERT_LT(graph.neighbour[element], graph.nodes());
          ASSERT_NE(graph.scene_node[slot], SlicedGraph::no_node);
          const std::pair spring{graph.scene_node[slot], graph.scene_node[graph.neighbour[element]]};
          EXPECT_TRUE(found.emplace(spring, graph.stiffness_rest[element]).second)
              << "a spring appears twice";
          EXPECT_GE(place[spring.second], last) << "the order of sums is that of the places";
          last = place[spring.second];
        }
      }
    EXPECT_EQ(found, expected);
    for (const Spring& spring : system.springs)
      for (const std::uint32_t node : {spring.first, spring.second}) {
        const SpringMaterial& material = system.materials[spring.kind];
        EXPECT_EQ(graph.stiffness[graph.slot[node]],
                  static_cast<float>(material.stiffness / system.node_mass[node]));
        EXPECT_EQ(graph.damping[graph.slot[node]],
                  static_cast<float>(material.damping / system.node_mass[node]));
      }
  }
}

TEST_P(SlicedGraphOfLanes, FillsUpSlicesWithWhatFeelsNothingAndDoesNotMove) {
  for (const System& system : bodies()) {
    const SlicedGraph graph(system, GetParam());
    EXPECT_EQ(graph.slots(), graph.slices() * graph.lanes);
    EXPECT_LT(graph.slots() - graph.nodes(), graph.lanes);
    std::vector<std::size_t> degree(graph.slots(), 0);
    for (std::size_t slice = 0; slice < graph.slices(); ++slice) {
      std::size_t largest = 0;
      for (std::size_t lane = 0; lane < graph.lanes; ++lane) {
        const std::size_t slot = slice * graph.lanes + lane;
        bool empty = false;
        for (std::size_t e = graph.first_entry[slice]; e < graph.first_entry[slice + 1]; ++e) {
          const std::size_t element = e * graph.lanes + lane;
          if (graph.stiffness_rest[element] < 0) {
            empty = true;
            EXPECT_EQ(graph.stiffness_rest[element], SlicedGraph::empty_entry);
            EXPECT_EQ(graph.neighbour[element], slot);
          } else {
            EXPECT_FALSE(empty) << "empty entries come last";
            ++degree[slot];
          }
        }
        largest = std::max(largest, degree[slot]);
      }
      EXPECT_EQ(largest, graph.first_entry[slice + 1] - graph.first_entry[slice]) << "no entry for nobody";
    }
    std::vector<std::uint32_t> held(graph.slots(), 0);
    for (const std::uint32_t pin : system.pins) held[graph.slot[pin]] = 1;
    std::size_t nodes = 0;
    for (std::size_t slot = 0; slot < graph.slots(); ++slot) {
      if (graph.scene_node[slot] != SlicedGraph::no_node) {
        ++nodes;
        EXPECT_EQ(graph.slot[graph.scene_node[slot]], slot);  // so no other slot has it
        continue;
      }
      EXPECT_GE(slot, graph.nodes());
      EXPECT_EQ(degree[slot], 0U);
      held[slot] = 1;
    }
    EXPECT_EQ(nodes, system.nodes());
    EXPECT_EQ(graph.held, held);
  }
}

/// The part of a block that has its nodes below `own`, the neighbours of these behind them.
std::pair<System, GraphPart> lower_part(const System& block, std::uint32_t own) {
  System part = block;
  const GraphPart graph{places_in(reverse_cuthill_mckee(block.nodes(), block.springs)), own};
  std::erase_if(part.springs,
                [&](const Spring& spring) { return spring.first >= own && spring.second >= own; });
  return {part, graph};
}

TEST_P(SlicedGraphOfLanes, OfAPartGivesItsNodesWhatTheyHaveInTheWhole) {
  const System block = solid_block(9, 9, 9);
  constexpr std::uint32_t own = 300;
  const auto [system, part] = lower_part(block, own);
  const SlicedGraph whole(block, GetParam()), graph(system, GetParam(), part);
  EXPECT_EQ(graph.ghosts, block.nodes() - own);
  EXPECT_GT(graph.first_edge_slice, 0U);
  EXPECT_LT(graph.first_edge_slice, graph.slices());
  // Of a node: its neighbours in the order of the entries, with their constants.
  const auto entries_of = [](const SlicedGraph& of, std::uint32_t node) {
    std::vector<std::uint32_t> node_at(of.slots() + of.ghosts);
    for (std::uint32_t i = 0; i < of.nodes(); ++i) node_at[of.slot[i]] = i;
    const std::size_t slice = of.slot[node] / of.lanes, lane = of.slot[node] % of.lanes;
    std::vector<std::pair<std::uint32_t, float>> found;
    for (std::size_t e = of.first_entry[slice]; e < of.first_entry[slice + 1]; ++e)
      if (const std::size_t element = e * of.lanes + lane; of.stiffness_rest[element] >= 0)
        found.emplace_back(node_at[of.neighbour[element]], of.stiffness_rest[element]);
    return found;
  };
  for (std::uint32_t node = 0; node < own; ++node) {
    const auto entries = entries_of(graph, node);
    EXPECT_EQ(entries, entries_of(whole, node));
    EXPECT_EQ(graph.stiffness[graph.slot[node]], whole.stiffness[whole.slot[node]]);
    EXPECT_EQ(graph.damping[graph.slot[node]], whole.damping[whole.slot[node]]);
    const bool edge = std::ranges::any_of(entries, [&](const auto& entry) { return entry.first >= own; });
    EXPECT_EQ(graph.slot[node] / graph.lanes >= graph.first_edge_slice, edge);
  }
  for (std::uint32_t node = own; node < graph.nodes(); ++node)
    EXPECT_EQ(graph.slot[node], graph.slots() + node - own);
}

TEST(SlicedGraph, HasFewEmptyEntriesInABody) {
  const System system = solid_block(9, 9, 9);
  const SlicedGraph graph(system, 16);
  EXPECT_LT(static_cast<double>(graph.entries() * graph.lanes),
            1.12 * 2 * static_cast<double>(system.springs.size()));
}

TEST(SlicedGraph, RefusesSpringsOfUnlikeMaterialsInOneNode) {
  System system = solid_block(2, 2, 2);
  system.materials.push_back({100, 0});
  system.springs.back().kind = 1;
  try {
    const SlicedGraph graph(system, 8);
    FAIL() << "it was taken";
  } catch (const Unsupported& refusal) {
    EXPECT_THAT(refusal.what(), HasSubstr("springs of different materials meet in node "));
  }
}

TEST(SlicedBodies, GiveEverySliceToOneLotInFairShares) {
  const System system = solid_block(9, 9, 9);
  for (const std::size_t threads : {1U, 2U, 3U, 7U, 46U, 1000U}) {
    const SlicedBodies bodies(system, integrators[0], 1e-4, 16, threads);
    ASSERT_EQ(bodies.threads, std::min(threads, bodies.slices()));
    ASSERT_EQ(bodies.chunks.size(), std::min(4 * threads, bodies.slices()));
    std::size_t next = 0;
    for (const SlicedBodies::Chunk& chunk : bodies.chunks) {
      EXPECT_EQ(chunk.begin, next);
      next = chunk.end;
      if (threads > 2) continue;  // a slice more or less is then a large share
      const auto entries =
          static_cast<double>(bodies.first_entry[chunk.end] - bodies.first_entry[chunk.begin]);
      EXPECT_NEAR(entries * static_cast<double>(bodies.chunks.size()) /
                      static_cast<double>(bodies.first_entry.back()),
                  1, 0.25);
    }
    EXPECT_EQ(next, bodies.slices());
  }
}

TEST(SlicedBodies, OfAPartGiveEverySliceToOneLotOfItsKind) {
  const auto [system, part] = lower_part(solid_block(9, 9, 9), 300);
  const SlicedGraph graph(system, 16, part);
  for (const std::size_t threads : {1U, 2U, 3U, 1000U}) {
    const SlicedBodies bodies(system, graph, integrators[0], 1e-4, threads);
    ASSERT_EQ(bodies.chunks.size(), bodies.edge_chunks.size());
    ASSERT_EQ(bodies.slot.size(), 300U);
    std::size_t next = 0;
    for (const auto* chunks : {&bodies.chunks, &bodies.edge_chunks}) {
      for (const SlicedBodies::Chunk& chunk : *chunks) {
        EXPECT_EQ(chunk.begin, next);
        next = chunk.end;
      }
      EXPECT_EQ(next, chunks == &bodies.chunks ? graph.first_edge_slice : bodies.slices());
    }
  }
}

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

}  // namespace
}  // namespace mssim
