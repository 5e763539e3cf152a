#include "backends/layouts/spring_colouring.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace mssim {
namespace {

constexpr std::size_t word_bits = 64;

std::size_t largest_degree(std::span<const Spring> list, std::size_t nodes) {
  std::vector<std::uint32_t> degree(nodes, 0);
  for (const Spring& spring : list) {
    ++degree[spring.first];
    ++degree[spring.second];
  }
  return degree.empty() ? 0 : *std::ranges::max_element(degree);
}

}  // namespace

SpringColouring colour_springs(std::span<const Spring> list, std::size_t nodes) {
  const std::size_t words = (2 * largest_degree(list, nodes) + word_bits - 1) / word_bits;
  std::vector<std::uint64_t> taken(nodes * words, 0);  // [nodes][words] a bit for each colour of a node
  std::vector<std::uint32_t> colour_of;
  colour_of.reserve(list.size());
  SpringColouring colouring;
  colouring.first.push_back(0);
  for (const Spring& spring : list) {
    std::uint64_t* const first = &taken[spring.first * words];
    std::uint64_t* const second = &taken[spring.second * words];
    std::size_t word = 0;
    while (~(first[word] | second[word]) == 0) ++word;
    const auto bit = static_cast<std::size_t>(std::countr_one(first[word] | second[word]));
    first[word] |= std::uint64_t{1} << bit;
    second[word] |= std::uint64_t{1} << bit;
    const std::size_t colour = word * word_bits + bit;
    colour_of.push_back(static_cast<std::uint32_t>(colour));
    if (colour + 1 >= colouring.first.size()) colouring.first.resize(colour + 2, 0);
    ++colouring.first[colour + 1];
  }
  for (std::size_t colour = 0; colour < colouring.colours(); ++colour)
    colouring.first[colour + 1] += colouring.first[colour];
  std::vector<std::size_t> next(colouring.first);
  colouring.springs.resize(list.size());
  for (std::size_t s = 0; s < list.size(); ++s) colouring.springs[next[colour_of[s]]++] = list[s];
  return colouring;
}

}  // namespace mssim
