#include "backends/implicit/constraints/spring_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "tests/support/cloth_system.h"
#include "tests/support/expect_coloured.h"
#include "tests/support/solid_system.h"

namespace mssim {
namespace {

TEST(SpringOrder, HasTwelveColoursOfAClothInWhichNoTwoSpringsShareANode) {
  for (const auto& [rows, columns] : std::vector<std::pair<std::uint32_t, std::uint32_t>>{
           {1, 7}, {7, 1}, {2, 2}, {3, 40}, {40, 3}, {37, 23}, {50, 50}}) {
    const System system = cloth_system(rows, columns);
    const SpringColouring order = spring_order(system);
    EXPECT_EQ(order.colours(), 12U) << rows << " x " << columns;
    expect_coloured(order, system.springs);
  }
}

TEST(SpringOrder, GivesEachSpringTheColourOfItsPlace) {
  using Ends = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  const auto ends = [](const System& system, ClothColour colour) {
    const SpringColouring order = spring_order(system);
    Ends found;
    for (const Spring& spring : order.of_colour(colour))
      found.emplace_back(std::minmax(spring.first, spring.second));
    std::ranges::sort(found);
    return found;
  };
  // A row or a column of seven nodes.
  const System row = cloth_system(1, 7), column = cloth_system(7, 1);
  EXPECT_EQ(ends(row, structural_from_even_columns), (Ends{{0, 1}, {2, 3}, {4, 5}}));
  EXPECT_EQ(ends(row, structural_from_odd_columns), (Ends{{1, 2}, {3, 4}, {5, 6}}));
  EXPECT_EQ(ends(row, bending_from_columns_01), (Ends{{0, 2}, {1, 3}, {4, 6}}));
  EXPECT_EQ(ends(row, bending_from_columns_23), (Ends{{2, 4}, {3, 5}}));
  EXPECT_EQ(ends(column, structural_below_even_rows), (Ends{{0, 1}, {2, 3}, {4, 5}}));
  EXPECT_EQ(ends(column, structural_below_odd_rows), (Ends{{1, 2}, {3, 4}, {5, 6}}));
  EXPECT_EQ(ends(column, bending_below_rows_01), (Ends{{0, 2}, {1, 3}, {4, 6}}));
  EXPECT_EQ(ends(column, bending_below_rows_23), (Ends{{2, 4}, {3, 5}}));
  // Three rows of two: 0 1 / 2 3 / 4 5.
  const System rows = cloth_system(3, 2);
  EXPECT_EQ(ends(rows, falling_below_even_rows), (Ends{{0, 3}}));
  EXPECT_EQ(ends(rows, falling_below_odd_rows), (Ends{{2, 5}}));
  EXPECT_EQ(ends(rows, rising_below_even_rows), (Ends{{1, 2}}));
  EXPECT_EQ(ends(rows, rising_below_odd_rows), (Ends{{3, 4}}));
}

TEST(SpringOrder, FillsAllTwelveColoursOfAClothWithEqualSharesOfEachKind) {
  const System system = cloth_system(49, 49);
  const SpringColouring order = spring_order(system);
  for (std::size_t colour = 0; colour < order.colours(); ++colour)
    EXPECT_NEAR(static_cast<double>(order.of_colour(colour).size()), 49.0 * 48 / 2, 49) << colour;
}

TEST(SpringOrder, OfBodiesIsThatOfTheGreedyColouring) {
  for (const System& system : {solid_block(5, 6, 7), two_solid_blocks()}) {
    const SpringColouring order = spring_order(system);
    expect_coloured(order, system.springs);
    EXPECT_EQ(order.colours(), colour_springs(system.springs, system.nodes()).colours());
  }
}

}  // namespace
}  // namespace mssim
