#include "backends/implicit/constraints/spring_order.h"

#include <gtest/gtest.h>

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
