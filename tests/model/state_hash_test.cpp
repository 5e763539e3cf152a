#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <string>

#include "model/system.h"
#include "text/text.h"

namespace mssim {
namespace {

State state_of(std::size_t nodes) {
  State state;
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto x = static_cast<double>(i);
    state.position.push_back({x, 0.5 * x, 1 / (x + 1)});
    state.velocity.push_back({-x, 3, 0});
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

}  // namespace
}  // namespace mssim
