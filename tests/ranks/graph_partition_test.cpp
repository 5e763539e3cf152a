#include "ranks/shares.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

using Parts = std::vector<std::uint32_t>;

std::vector<std::size_t> sizes_of(const Parts& part_of, std::size_t parts) {
  std::vector<std::size_t> sizes(parts, 0);
  for (const std::uint32_t part : part_of) ++sizes.at(part);
  return sizes;
}

std::size_t cut_springs(const System& system, const Parts& part_of) {
  return static_cast<std::size_t>(std::ranges::count_if(
      system.springs, [&](const Spring& spring) { return part_of[spring.first] != part_of[spring.second]; }));
}

TEST(GraphPartition, CutsABodyIntoPartsOfTheSharesAlongFewSprings) {
  const System body = solid_block(12, 12, 12);
  std::mt19937 random(3);
  for (const std::vector<std::size_t>& shares :
       {std::vector<std::size_t>{1, 1}, {1, 2}, {5, 3, 1}, std::vector<std::size_t>(7, 10)}) {
    const Parts part_of = graph_partition(body.nodes(), body.springs, shares);
    ASSERT_EQ(part_of.size(), body.nodes());
    const auto all = static_cast<double>(std::reduce(shares.begin(), shares.end()));
    const std::vector<std::size_t> sizes = sizes_of(part_of, shares.size());
    for (std::size_t part = 0; part < shares.size(); ++part) {
      const double wanted = static_cast<double>(body.nodes()) * static_cast<double>(shares[part]) / all;
      EXPECT_NEAR(static_cast<double>(sizes[part]), wanted, 0.12 * wanted) << "part " << part;
    }
    Parts shuffled = part_of;
    std::ranges::shuffle(shuffled, random);
    EXPECT_LT(3 * cut_springs(body, part_of), cut_springs(body, shuffled));
    EXPECT_EQ(graph_partition(body.nodes(), body.springs, shares), part_of) << "again";
  }
}

TEST(GraphPartition, LeavesNoPartEmpty) {
  for (const auto& [nx, ny, nz] : {std::array{2U, 2U, 2U}, {2U, 2U, 4U}, {3U, 3U, 3U}, {4U, 4U, 4U}}) {
    const System body = solid_block(nx, ny, nz);
    for (std::size_t parts = 1; parts <= body.nodes(); ++parts) {
      SCOPED_TRACE(std::to_string(body.nodes()) + " nodes in " + std::to_string(parts));
      const std::vector<std::size_t> shares(parts, 1);
      EXPECT_GT(std::ranges::min(sizes_of(graph_partition(body.nodes(), body.springs, shares), parts)), 0U);
    }
  }
}

TEST(GraphPartition, CutsWhatIsNotConnected) {
  const System blocks = two_solid_blocks();
  const std::vector<std::size_t> shares(4, 1);
  EXPECT_GT(std::ranges::min(sizes_of(graph_partition(blocks.nodes(), blocks.springs, shares), 4)), 0U);
}

}  // namespace
}  // namespace mssim
