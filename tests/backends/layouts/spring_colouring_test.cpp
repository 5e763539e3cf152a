#include "backends/layouts/spring_colouring.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/cloth_system.h"
#include "tests/support/expect_coloured.h"
#include "tests/support/solid_system.h"

namespace mssim {
namespace {

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
  EXPECT_GE(colouring.colours(), largest);
  EXPECT_LE(colouring.colours(), 2 * largest - 1);
  for (std::size_t colour = 0; colour < colouring.colours(); ++colour)
    EXPECT_FALSE(colouring.of_colour(colour).empty()) << "colour " << colour;
}

TEST(SpringColouring, LetsNoTwoSpringsOfAColourShareANode) {
  for (const System& system : {cloth_system(20, 13), cloth_system(2, 2), solid_block(5, 6, 7)})
    expect_greedy_colours(system.springs, system.nodes());
}

TEST(SpringColouring, HasColoursEnoughForANodeOfManySprings) {
  std::vector<Spring> star;  // needs a colour for each spring, more than a machine word has bits
  for (std::uint32_t node = 1; node <= 200; ++node) star.push_back({0, node, 1, 0});
  expect_greedy_colours(star, 201);
  EXPECT_EQ(colour_springs(star, 201).colours(), 200U);
}

TEST(SpringColouring, OfNoSpringsHasNoColours) { EXPECT_EQ(colour_springs({}, 5).colours(), 0U); }

}  // namespace
}  // namespace mssim
