#include "backends/layouts/sliced_graph.h"

#include "backends/interface/backend.h"
#include "backends/layouts/spring_graph.h"
#include "backends/openmp/bodies.h"
#include "backends/openmp/openmp.h"
#include "integrators/all_integrators.h"
#include "tests/support/expect_coloured.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

class SlicedGraphOfLanes : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Widths, SlicedGraphOfLanes, testing::Values(1, 4, 8, 16, 64));

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
    EXPECT_EQ(numbers_of(graph.constants[graph.slot[node]]), numbers_of(whole.constants[whole.slot[node]]));
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
  EXPECT_THAT(sentence_of<Unsupported>([&] { const SlicedGraph graph(system, 8); }),
              HasSubstr("springs of different materials meet in node "));
}

TEST(SlicedBodies, GiveEverySliceToOneLotInFairShares) {
  const System system = solid_block(9, 9, 9);
  for (const std::size_t threads : {1U, 2U, 3U, 7U, 46U, 1000U}) {
    const SlicedBodies bodies(system, integrators[0], 1e-4, 16, threads);
    ASSERT_EQ(bodies.threads, std::min(threads, bodies.slices()));
    ASSERT_EQ(bodies.chunks.size(), std::min(4 * threads, bodies.slices()));
    std::size_t next = 0;
    for (const IndexRange& chunk : bodies.chunks) {
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

/// The same springs between nodes numbered at random, as a mesher might number them.
std::vector<Spring> shuffled(std::vector<Spring> springs, std::size_t nodes) {
  std::vector<std::uint32_t> number(nodes);
  std::iota(number.begin(), number.end(), 0U);
  std::shuffle(number.begin(), number.end(), std::mt19937(7));
  for (Spring& spring : springs) {
    spring.first = number[spring.first];
    spring.second = number[spring.second];
  }
  return springs;
}

/// Largest distance between the two ends of a spring, by their slots in the order.
std::uint32_t bandwidth(const std::vector<Spring>& springs, const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> slot(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) slot[order[i]] = i;
  std::uint32_t largest = 0;
  for (const Spring& spring : springs)
    largest = std::max(largest, std::max(slot[spring.first], slot[spring.second]) -
                                    std::min(slot[spring.first], slot[spring.second]));
  return largest;
}

bool is_permutation(std::vector<std::uint32_t> order, std::size_t nodes) {
  std::sort(order.begin(), order.end());
  for (std::uint32_t i = 0; i < order.size(); ++i)
    if (order[i] != i) return false;
  return order.size() == nodes;
}

TEST(ReverseCuthillMckee, ShrinksTheBandwidthOfABodyToAboutALayerOfNodes) {
  const System system = solid_block(6, 6, 20);
  const std::vector<Spring> springs = shuffled(system.springs, system.nodes());
  std::vector<std::uint32_t> as_numbered(system.nodes());
  std::iota(as_numbered.begin(), as_numbered.end(), 0U);
  const auto order = reverse_cuthill_mckee(system.nodes(), springs);
  ASSERT_TRUE(is_permutation(order, system.nodes()));
  EXPECT_GT(bandwidth(springs, as_numbered), 600U);
  EXPECT_LT(bandwidth(springs, order), 3U * 6 * 6);
}

TEST(ReverseCuthillMckee, PutsTheNodesOfAChainInARow) {
  constexpr std::uint32_t nodes = 50;
  std::vector<Spring> chain;
  for (std::uint32_t i = 0; i + 1 < nodes; ++i) chain.push_back({i, i + 1, 1, 0});
  chain = shuffled(chain, nodes);
  const auto order = reverse_cuthill_mckee(nodes, chain);
  ASSERT_TRUE(is_permutation(order, nodes));
  EXPECT_EQ(bandwidth(chain, order), 1U);
}

TEST(ReverseCuthillMckee, KeepsBodiesOneAfterTheOtherAndLosesNoLoneNode) {
  const System system = two_solid_blocks();
  const std::size_t first = 4 * 5 * 3;
  const auto order = reverse_cuthill_mckee(system.nodes() + 1, system.springs);
  ASSERT_TRUE(is_permutation(order, system.nodes() + 1));
  EXPECT_TRUE(
      std::all_of(order.begin(), order.begin() + first, [](std::uint32_t node) { return node < 60; }));
  EXPECT_EQ(order.back(), system.nodes());
  EXPECT_TRUE(reverse_cuthill_mckee(0, {}).empty());
}

TEST(ReverseCuthillMckee, TellsWhereNoSpringGoesOn) {
  // Nodes 0 to 3, of which a spring reaches over two others, 4 alone, and 5 and 6.
  const std::vector<Spring> springs{{0, 3, 1, 0}, {1, 0, 1, 0}, {1, 2, 1, 0}, {6, 5, 1, 0}};
  std::vector<std::uint32_t> place{0, 1, 2, 3, 4, 5, 6};
  EXPECT_THAT(component_ends(springs, place), ElementsAre(4, 5, 7));
  std::ranges::reverse(place);
  EXPECT_THAT(component_ends(springs, place), ElementsAre(2, 3, 7));
}

/// Expects colours that are not empty, and neither too few nor too many.
void expect_greedy_colours(const std::vector<Spring>& list, std::size_t nodes) {
  const SpringColouring colouring = colour_springs(list, nodes);
  expect_coloured(colouring, list);
  std::vector<std::size_t> degree(nodes, 0);
  for (const Spring& spring : list) {
    ++degree[spring.first];
    ++degree[spring.second];
  }
  const std::size_t largest = *std::ranges::max_element(degree);
  EXPECT_GE(colouring.groups(), largest);
  EXPECT_LE(colouring.groups(), 2 * largest - 1);
  for (std::size_t colour = 0; colour < colouring.groups(); ++colour)
    EXPECT_FALSE(colouring.of(colour).empty()) << "colour " << colour;
}

TEST(SpringColouring, LetsNoTwoSpringsOfAColourShareANode) {
  for (const System& system : {cloth_system(20, 13), cloth_system(2, 2), solid_block(5, 6, 7)})
    expect_greedy_colours(system.springs, system.nodes());
}

TEST(SpringColouring, HasColoursEnoughForANodeOfManySprings) {
  std::vector<Spring> star;  // needs a colour for each spring, more than a machine word has bits
  for (std::uint32_t node = 1; node <= 200; ++node) star.push_back({0, node, 1, 0});
  expect_greedy_colours(star, 201);
  EXPECT_EQ(colour_springs(star, 201).groups(), 200U);
}

TEST(SpringColouring, OfNoSpringsHasNoColours) { EXPECT_EQ(colour_springs({}, 5).groups(), 0U); }

}  // namespace
}  // namespace mssim
