#include "backends/implicit/local_global/block_factor.h"

#include <algorithm>

#include "backends/implicit/local_global/factorise.h"

namespace mssim {
namespace {

/// Regions of so many rows are one dense block: smaller ones have fewer entries, but more borders to pass on.
constexpr std::size_t smallest_region = 32;

}  // namespace

BlockFactor::BlockFactor(const StepMatrix& matrix, std::span<const Vec3d> places, std::size_t lanes)
    : BlockFactor(matrix, Dissection(matrix, places, smallest_region), lanes) {}

BlockFactor::BlockFactor(const StepMatrix& matrix, const Dissection& dissection, std::size_t lanes)
    : order(dissection.order), fronts(matrix, dissection) {
  std::size_t floats = 0;
  for (std::size_t part = 0; part < fronts.parts.size(); ++part) {
    const std::size_t rows = (fronts.rows(part) + lanes - 1) / lanes * lanes;
    blocks.push_back({floats, rows, front_floats});
    floats += rows * fronts.pivots(part);
    front_floats += 3 * rows;
    most_rows = std::max(most_rows, rows);
  }
  require_memory(floats + front_floats, sizeof(float));
  panels = AlignedArray(floats);
  eliminate_all(matrix);
}

std::size_t BlockFactor::cost(std::size_t part) const {
  constexpr std::size_t row_cost = 32;
  return blocks[part].rows * (fronts.pivots(part) + row_cost);
}

void BlockFactor::eliminate_all(const StepMatrix& matrix) {
  std::vector<std::uint32_t> place(matrix.rows()), part_of(matrix.rows());
  for (std::uint32_t i = 0; i < place.size(); ++i) place[order[i]] = i;
  for (std::uint32_t part = 0; part < blocks.size(); ++part)
    for (std::uint32_t i = fronts.parts[part].begin; i < fronts.parts[part].end; ++i) part_of[i] = part;
  std::vector<std::vector<StepMatrix::Coupling>> couplings(blocks.size());  // by places, the earlier first
  for (const auto& coupling : matrix.couplings) {
    const auto [low, high] = std::minmax(place[coupling.first], place[coupling.second]);
    couplings[part_of[low]].push_back({low, high, coupling.weight});
  }

  std::vector<std::vector<double>> left(blocks.size());  // of the border: its lower triangle, by columns
  std::vector<double> front, panel;
  for (std::size_t part = 0; part < blocks.size(); ++part) {
    const std::size_t rows = fronts.rows(part), pivots = fronts.pivots(part), border = rows - pivots;
    front.assign(rows * rows, 0);
    const auto add = [&](std::size_t i, std::size_t j, double value) {
      front[std::max(i, j) + std::min(i, j) * rows] += value;
    };
    const std::uint32_t begin = fronts.parts[part].begin;
    for (std::size_t i = 0; i < pivots; ++i) add(border + i, border + i, matrix.diagonal[order[begin + i]]);
    for (const auto& coupling : couplings[part])
      add(border + coupling.first - begin, fronts.at(part, coupling.second), -coupling.weight);
    for (const std::uint32_t child : fronts.children_of(part)) {
      const std::size_t size = fronts.border_size(child);
      const std::uint32_t* const at = fronts.at_parent.data() + fronts.first_border[child];
      for (std::size_t j = 0; j < size; ++j)
        for (std::size_t i = j; i < size; ++i) add(at[i], at[j], left[child][i + j * size]);
      left[child] = {};
    }
    panel.resize(rows * pivots);
    eliminate(front, rows, pivots, panel);
    for (std::size_t j = 0; j < pivots; ++j)
      std::transform(panel.begin() + static_cast<std::ptrdiff_t>(j * rows),
                     panel.begin() + static_cast<std::ptrdiff_t>((j + 1) * rows),
                     panels.data() + blocks[part].panel + j * blocks[part].rows,
                     [](double value) { return static_cast<float>(value); });
    left[part].resize(border * border);
    for (std::size_t j = 0; j < border; ++j)
      std::copy_n(front.begin() + static_cast<std::ptrdiff_t>(j * rows), border,
                  left[part].begin() + static_cast<std::ptrdiff_t>(j * border));
  }
}

}  // namespace mssim
