// The factors of fast-springs' matrix against the matrix itself.
#include "backends/implicit/local_global/factor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "backends/interface/backend.h"
#include "tests/support/cloth_system.h"
#include "tests/support/dense_solve.h"
#include "tests/support/solid_system.h"

namespace mssim {
namespace {

using DenseMatrix = std::vector<std::vector<double>>;

DenseMatrix dense(const StepMatrix& matrix) {
  DenseMatrix all(matrix.rows(), std::vector<double>(matrix.rows()));
  for (std::size_t i = 0; i < matrix.rows(); ++i) all[i][i] = matrix.diagonal[i];
  for (const auto& [first, second, weight] : matrix.couplings) {
    all[first][second] -= weight;
    all[second][first] -= weight;
  }
  return all;
}

std::vector<Vec3d> places_of(const System& system, const StepMatrix& matrix) {
  std::vector<Vec3d> places;
  for (const std::uint32_t node : matrix.node) places.push_back(system.start.position[node]);
  return places;
}

TEST(StepMatrix, HasTheMassesOfFreeNodesAndTheirSprings) {
  const double dt_s = 1e-3;
  const System system = cloth_system(4, 5);
  const StepMatrix matrix(system, dt_s);
  ASSERT_EQ(matrix.rows(), system.nodes() - system.pins.size());
  // A displacement of all free nodes stretches the springs to pins alone.
  double sum = 0, expected = 0;
  for (const auto& row : dense(matrix)) sum += std::accumulate(row.begin(), row.end(), 0.0);
  std::vector<bool> pinned(system.nodes());
  for (const std::uint32_t pin : system.pins) pinned[pin] = true;
  for (std::size_t i = 0; i < system.nodes(); ++i)
    if (!pinned[i]) expected += (1 + dt_s * system.viscous_damping) * system.node_mass[i];
  for (const Spring& spring : system.springs)
    if (pinned[spring.first] != pinned[spring.second])
      expected += dt_s * dt_s * system.materials[spring.kind].stiffness +
                  dt_s * system.materials[spring.kind].damping;
  EXPECT_NEAR(sum, expected, 1e-12 * expected);
}

TEST(Factorise, GivesTheMatrixBack) {
  for (const System& system : {cloth_system(9, 7), two_solid_blocks()}) {
    const StepMatrix matrix(system, 1e-2);
    const ColumnFactor factor = factorise(matrix);
    const std::size_t rows = matrix.rows();
    DenseMatrix product(rows, std::vector<double>(rows));
    for (std::size_t column = 0; column < rows; ++column) {
      EXPECT_EQ(factor.place[factor.first[column]], column);
      for (std::size_t i = factor.first[column]; i < factor.first[column + 1]; ++i)
        for (std::size_t j = factor.first[column]; j < factor.first[column + 1]; ++j)
          product[factor.order[factor.place[i]]][factor.order[factor.place[j]]] +=
              factor.value[i] * factor.value[j];
    }
    const DenseMatrix expected = dense(matrix);
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t j = 0; j < rows; ++j)
        EXPECT_NEAR(product[i][j], expected[i][j], 1e-13 * expected[i][i]) << i << " " << j;
  }
}

TEST(Factorise, RefusesAMatrixThatIsNotPositiveDefinite) {
  StepMatrix matrix(cloth_system(5, 5), 1e-3);
  matrix.diagonal[7] = -1;
  EXPECT_THROW(factorise(matrix), Unsupported);
  EXPECT_THROW(BlockFactor(matrix, std::vector<Vec3d>(matrix.rows()), 8), Unsupported);
}

TEST(Factorise, RefusesWhatMemoryCannotHold) {
  try {
    require_factor_memory(std::size_t{1} << 50, 8);
    FAIL() << "there are no such machines";
  } catch (const Unsupported& reason) {
    EXPECT_TRUE(std::string(reason.what()).starts_with("the factor of its global step needs at least "))
        << reason.what();
  }
}

TEST(Dissection, EliminatesEveryRowOnceAndCouplesPartsWithTheirAncestorsAlone) {
  for (const System& system : {cloth_system(31, 18), two_solid_blocks(), cloth_system(1, 9)}) {
    const StepMatrix matrix(system, 1e-3);
    const Dissection dissection(matrix, places_of(system, matrix), 6);
    std::vector<std::uint32_t> part_of(matrix.rows(), Dissection::no_part);
    ASSERT_EQ(dissection.order.size(), matrix.rows());
    std::uint32_t end = 0;
    for (std::uint32_t part = 0; part < dissection.parts.size(); ++part) {
      EXPECT_EQ(dissection.parts[part].begin, end);
      EXPECT_LT(end, dissection.parts[part].end);
      end = dissection.parts[part].end;
      EXPECT_GT(dissection.parts[part].parent, part);
      for (std::uint32_t i = dissection.parts[part].begin; i < end; ++i) part_of[dissection.order[i]] = part;
    }
    EXPECT_EQ(end, matrix.rows());
    for (const std::uint32_t part : part_of) EXPECT_NE(part, Dissection::no_part);
    for (const auto& coupling : matrix.couplings) {
      auto [low, high] = std::minmax(part_of[coupling.first], part_of[coupling.second]);
      std::uint32_t at = low;
      while (at < high) at = dissection.parts[at].parent;
      EXPECT_EQ(at, high);
    }
  }
}

/// s of A s = e by the blocks, one coordinate, as BlockFactor says it.
std::vector<double> solve(const BlockFactor& factor, const std::vector<double>& right) {
  const Fronts& fronts = factor.fronts;
  std::vector<std::vector<double>> front(fronts.parts.size());
  const auto entry = [&](std::size_t part, std::size_t i, std::size_t j) {
    return static_cast<double>(
        factor.panels.data()[factor.blocks[part].panel + j * factor.blocks[part].rows + i]);
  };
  for (std::size_t part = 0; part < front.size(); ++part) {
    const std::size_t border = fronts.border_size(part), pivots = fronts.pivots(part);
    front[part].resize(border + pivots);
    for (std::size_t i = 0; i < pivots; ++i)
      front[part][border + i] = right[factor.order[fronts.parts[part].begin + i]];
    for (const std::uint32_t child : fronts.children_of(part))
      for (std::size_t i = 0; i < fronts.border_size(child); ++i)
        front[part][fronts.at_parent[fronts.first_border[child] + i]] += front[child][i];
    const std::vector<double> e(front[part].begin() + static_cast<std::ptrdiff_t>(border), front[part].end());
    std::fill(front[part].begin() + static_cast<std::ptrdiff_t>(border), front[part].end(), 0);
    for (std::size_t i = 0; i < front[part].size(); ++i)
      for (std::size_t j = 0; j < pivots; ++j) front[part][i] += entry(part, i, j) * e[j];
  }
  std::vector<double> solution(right.size());
  for (std::size_t part = front.size(); part-- > 0;) {
    const std::size_t border = fronts.border_size(part);
    for (std::size_t i = 0; i < border; ++i)
      front[part][i] = front[fronts.parts[part].parent][fronts.at_parent[fronts.first_border[part] + i]];
    for (std::size_t j = 0; j < fronts.pivots(part); ++j) {
      for (std::size_t i = 0; i < border; ++i) front[part][border + j] += entry(part, i, j) * front[part][i];
      solution[factor.order[fronts.parts[part].begin + j]] = front[part][border + j];
    }
  }
  return solution;
}

TEST(BlockFactor, SolvesLikeADenseMatrix) {
  for (const System& system : {cloth_system(17, 12), two_solid_blocks(), cloth_system(1, 9)}) {
    const StepMatrix matrix(system, 1e-2);
    std::vector<double> right(matrix.rows());
    for (std::size_t i = 0; i < right.size(); ++i) right[i] = std::sin(3.0 * static_cast<double>(i));
    const std::vector<double> expected = dense_solve(dense(matrix), right);
    const std::vector<double> solution = solve(BlockFactor(matrix, places_of(system, matrix), 4), right);
    double largest = 0;
    for (const double value : expected) largest = std::max(largest, std::abs(value));
    for (std::size_t i = 0; i < right.size(); ++i) EXPECT_NEAR(solution[i], expected[i], 2e-6 * largest) << i;
  }
}

}  // namespace
}  // namespace mssim
