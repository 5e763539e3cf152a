#pragma once

#include "backends/layouts/spring_graph.h"
#include "tests/support/testing.h"

namespace mssim {

/// Expects every spring of the list once, and no node twice in a colour.
inline void expect_coloured(const SpringColouring& colouring, const std::vector<Spring>& list) {
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, float>;
  const auto key = [](const Spring& spring) {
    return Key(spring.first, spring.second, spring.kind, spring.rest_length);
  };
  std::multiset<Key> expected, found;
  for (const Spring& spring : list) expected.insert(key(spring));
  for (std::size_t colour = 0; colour < colouring.groups(); ++colour) {
    std::set<std::uint32_t> taken;
    for (const Spring& spring : colouring.of(colour)) {
      EXPECT_TRUE(taken.insert(spring.first).second) << "node " << spring.first << ", colour " << colour;
      EXPECT_TRUE(taken.insert(spring.second).second) << "node " << spring.second << ", colour " << colour;
      found.insert(key(spring));
    }
  }
  EXPECT_EQ(found, expected);
}

}  // namespace mssim
