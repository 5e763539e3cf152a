#include "backends/implicit/local_global/factor.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <utility>

#include "backends/interface/backend.h"
#include "backends/layouts/spring_graph.h"
#include "platform/machine.h"

namespace mssim {
namespace {

using Index = int;  // required by Eigen's orderings
using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;

[[noreturn]] void refuse_indefinite() {
  throw Unsupported("the matrix of its global step is not positive definite in double precision");
}

std::ptrdiff_t signed_size(std::size_t size) { return static_cast<std::ptrdiff_t>(size); }

/// Builds both triangles.
Matrix whole_matrix(const StepMatrix& matrix) {
  std::vector<Eigen::Triplet<double, Index>> entries;
  entries.reserve(matrix.rows() + 2 * matrix.couplings.size());
  for (Index row = 0; const double value : matrix.diagonal) {
    entries.emplace_back(row, row, value);
    ++row;
  }
  for (const auto& coupling : matrix.couplings) {
    const auto first = static_cast<Index>(coupling.first), second = static_cast<Index>(coupling.second);
    entries.emplace_back(first, second, -coupling.weight);
    entries.emplace_back(second, first, -coupling.weight);
  }
  Matrix whole(signed_size(matrix.rows()), signed_size(matrix.rows()));
  whole.setFromTriplets(entries.begin(), entries.end());
  return whole;
}

/// The number of entries in the Cholesky factor of a matrix, given its upper triangle: row by row along the
/// elimination tree (Liu 1990), without storing any.
std::size_t count_entries(const Matrix& upper) {
  constexpr Index none = -1;
  const auto rows = static_cast<std::size_t>(upper.rows());
  std::vector<Index> parent(rows, none), seen_by(rows, none);
  std::size_t count = rows;
  for (Index row = 0; row < upper.rows(); ++row) {
    seen_by[static_cast<std::size_t>(row)] = row;
    for (Matrix::InnerIterator entry(upper, row); entry; ++entry)
      for (auto at = static_cast<std::size_t>(entry.index()); seen_by[at] != row;
           at = static_cast<std::size_t>(parent[at])) {
        if (parent[at] == none) parent[at] = row;
        seen_by[at] = row;
        ++count;
      }
  }
  return count;
}

/// Eliminates the last `pivots` of `rows` unknowns from a dense symmetric system F, [rows][rows] by columns,
/// given its lower triangle. With F = (F_rr, F_rp; F_pr, F_pp), where r are the remaining rows, first,
///
///     F_rr (its lower triangle) becomes  F_rr - F_rp F_pp^-1 F_pr,
///     panel, [rows][pivots] by columns, (-F_rp F_pp^-1; F_pp^-1).
///
/// The rest of F is overwritten. Throws Unsupported if F_pp is not positive definite.
void eliminate(std::span<double> front, std::size_t rows, std::size_t pivots, std::span<double> panel) {
  using Dense = Eigen::MatrixXd;
  const std::ptrdiff_t n = signed_size(rows), w = signed_size(pivots), r = n - w;
  Eigen::Map<Dense> whole(front.data(), n, n), result(panel.data(), n, w);
  const Eigen::LLT<Dense> cholesky(whole.bottomRightCorner(w, w));
  if (cholesky.info() != Eigen::Success) refuse_indefinite();
  auto solved = whole.bottomLeftCorner(w, r);  // F_pr
  cholesky.matrixL().solveInPlace(solved);
  whole.topLeftCorner(r, r).selfadjointView<Eigen::Lower>().rankUpdate(solved.transpose(), -1.0);
  cholesky.matrixU().solveInPlace(solved);
  result.topRows(r) = -solved.transpose();
  result.bottomRows(w) = cholesky.solve(Dense::Identity(w, w));
}

using Rows = std::span<std::uint32_t>;

class Dissector {
 public:
  Dissector(const StepMatrix& matrix, std::span<const Vec3d> places, std::size_t smallest)
      : couplings_(matrix.rows(), matrix.couplings),
        places_(places),
        smallest_(smallest),
        side_(matrix.rows()) {}

  /// Appends the parts of all connected components, one after the other.
  void dissect_all(Dissection& into) {
    std::vector<bool> seen(side_.size());
    std::vector<std::uint32_t> piece;
    for (std::uint32_t start = 0; start < side_.size(); ++start) {
      if (seen[start]) continue;
      piece.assign(1, start);
      seen[start] = true;
      for (std::size_t i = 0; i < piece.size(); ++i)
        for (const std::uint32_t other : couplings_.of(piece[i])) {
          if (!seen[other]) piece.push_back(other);
          seen[other] = true;
        }
      dissect(piece, into);
    }
  }

 private:
  /// Appends the parts of a region: its components before their separator. Returns the last part of each
  /// component without couplings to the rest of the region.
  std::vector<std::uint32_t> dissect(Rows region, Dissection& into) {
    if (region.empty()) return {};
    if (region.size() <= smallest_) return {append(region, into)};
    const std::size_t middle = cut(region);
    Rows one = region.first(middle), other = region.subspan(middle);
    const std::size_t from_one = border(one, other), from_other = border(other, one);
    // The smaller of the two borders; ties go to the larger half.
    const bool of_one = from_one < from_other || (from_one == from_other && one.size() > other.size());
    Rows& cut_from = of_one ? one : other;
    const std::size_t rest = cut_from.size() - std::min(from_one, from_other);
    const Rows separator = cut_from.subspan(rest);
    cut_from = cut_from.first(rest);

    std::vector<std::uint32_t> tops = dissect(one, into);
    const std::vector<std::uint32_t> other_tops = dissect(other, into);
    tops.insert(tops.end(), other_tops.begin(), other_tops.end());
    if (separator.empty()) return tops;
    const std::uint32_t part = append(separator, into);
    for (const std::uint32_t top : tops) into.parts[top].parent = part;
    return {part};
  }

  /// Sorts the rows of a region into two halves along its longest side and returns the size of the first.
  /// Rows at the same coordinate, the lines of a cloth, stay together where possible.
  std::size_t cut(Rows region) const {
    Vec3d low = places_[region[0]], high = low;
    for (const std::uint32_t row : region) {
      const Vec3d& place = places_[row];
      low = {std::min(low.x, place.x), std::min(low.y, place.y), std::min(low.z, place.z)};
      high = {std::max(high.x, place.x), std::max(high.y, place.y), std::max(high.z, place.z)};
    }
    const Vec3d sides = high - low;
    const auto axis = sides.x >= sides.y && sides.x >= sides.z ? &Vec3d::x
                      : sides.y >= sides.z                     ? &Vec3d::y
                                                               : &Vec3d::z;
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(places_[a].*axis, a) < std::pair(places_[b].*axis, b);
    };
    const auto half = static_cast<std::ptrdiff_t>(region.size() / 2);
    std::nth_element(region.begin(), region.begin() + half, region.end(), before);
    const double line = places_[region[region.size() / 2]].*axis;
    const auto end_of_first = std::partition(region.begin(), region.begin() + half,
                                             [&](std::uint32_t row) { return places_[row].*axis < line; });
    return static_cast<std::size_t>((end_of_first == region.begin() ? region.begin() + half : end_of_first) -
                                    region.begin());
  }

  /// Moves the rows of `from` with couplings into `to` to its end and returns their number.
  std::size_t border(Rows from, Rows to) {
    ++present_;
    for (const std::uint32_t row : to) side_[row] = present_;
    const auto borders = std::stable_partition(from.begin(), from.end(), [&](std::uint32_t row) {
      return std::ranges::none_of(couplings_.of(row),
                                  [&](std::uint32_t other) { return side_[other] == present_; });
    });
    return static_cast<std::size_t>(from.end() - borders);
  }

  static std::uint32_t append(Rows rows, Dissection& into) {
    std::ranges::sort(rows);
    const auto begin = static_cast<std::uint32_t>(into.order.size());
    into.order.insert(into.order.end(), rows.begin(), rows.end());
    into.parts.push_back({begin, static_cast<std::uint32_t>(into.order.size()), Dissection::no_part});
    return static_cast<std::uint32_t>(into.parts.size() - 1);
  }

  const Adjacency couplings_;
  const std::span<const Vec3d> places_;
  const std::size_t smallest_;
  std::vector<std::uint32_t> side_;  ///< [rows] `present_` for rows of the current side
  std::uint32_t present_ = 0;
};

struct Placement {
  std::vector<std::uint32_t> place;    ///< [rows] index in the order of elimination
  std::vector<std::uint32_t> part_of;  ///< [places] the part of each
};
Placement placement_of(const Dissection& dissection) {
  const auto& [order, parts] = dissection;
  Placement all{places_in(order), std::vector<std::uint32_t>(order.size())};
  for (std::uint32_t part = 0; part < parts.size(); ++part)
    std::fill(all.part_of.begin() + parts[part].begin, all.part_of.begin() + parts[part].end, part);
  return all;
}

/// Regions of this many rows become one dense block: smaller ones have fewer entries, but more borders.
constexpr std::size_t smallest_region = 32;

}  // namespace

StepMatrix::StepMatrix(const System& system, double dt_s) {
  constexpr std::uint32_t no_row = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> row(system.nodes(), 0);
  for (const std::uint32_t pin : system.pins) row[pin] = no_row;
  for (std::uint32_t i = 0; i < row.size(); ++i) {
    if (row[i] == no_row) continue;
    row[i] = static_cast<std::uint32_t>(node.size());
    node.push_back(i);
    diagonal.push_back((1 + dt_s * system.viscous_damping) * system.node_mass[i]);
  }
  for (const Spring& spring : system.springs) {
    const double weight = spring_step_along(dt_s, system.materials[spring.kind]);
    const std::uint32_t first = row[spring.first], second = row[spring.second];
    if (first != no_row) diagonal[first] += weight;
    if (second != no_row) diagonal[second] += weight;
    if (first != no_row && second != no_row) couplings.push_back({first, second, weight});
  }
}

void require_factor_memory(std::size_t entries, std::size_t entry_bytes) {
  if (const auto shortage = memory_shortage(entries * entry_bytes))
    throw Unsupported("the factor of its global step " + *shortage);
}

ColumnFactor factorise(const StepMatrix& matrix) {
  const Matrix whole = whole_matrix(matrix);
  // Maps places to rows: its inverse maps rows to places.
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, Index> order;
  Eigen::AMDOrdering<Index>()(whole, order);
  Matrix upper(whole.rows(), whole.cols());
  upper.selfadjointView<Eigen::Upper>() = whole.selfadjointView<Eigen::Upper>().twistedBy(order.inverse());
  const std::size_t entries = count_entries(upper);
  if (entries > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    throw Unsupported("the factor of its global step would have {} entries, more than Eigen can number",
                      entries);
  // Eigen's factor, this one, and a backend's copy.
  require_factor_memory(entries, 2 * (sizeof(double) + sizeof(Index)) + sizeof(double));
  const Eigen::SimplicialLLT<Matrix, Eigen::Upper, Eigen::NaturalOrdering<Index>> cholesky(upper);
  if (cholesky.info() != Eigen::Success) refuse_indefinite();

  const Matrix& factor = cholesky.matrixL().nestedExpression();
  ColumnFactor result;
  result.order.assign(order.indices().begin(), order.indices().end());
  result.first.assign(factor.outerIndexPtr(), factor.outerIndexPtr() + factor.outerSize() + 1);
  result.place.assign(factor.innerIndexPtr(), factor.innerIndexPtr() + factor.nonZeros());
  result.value.assign(factor.valuePtr(), factor.valuePtr() + factor.nonZeros());
  return result;
}

Dissection::Dissection(const StepMatrix& matrix, std::span<const Vec3d> places, std::size_t smallest) {
  order.reserve(matrix.rows());
  Dissector(matrix, places, std::max<std::size_t>(smallest, 1)).dissect_all(*this);
}

Fronts::Fronts(const StepMatrix& matrix, Dissection dissection)
    : Dissection(std::move(dissection)), children(parts.size(), [&](const auto& visit) {
        for (std::uint32_t part = 0; part < parts.size(); ++part)
          if (parts[part].parent != Dissection::no_part) visit(parts[part].parent, part);
      }) {
  const auto [place, part_of] = placement_of(*this);
  std::vector<std::vector<std::uint32_t>> later(parts.size());
  for (const auto& coupling : matrix.couplings) {
    const auto [low, high] = std::minmax(place[coupling.first], place[coupling.second]);
    if (part_of[low] != part_of[high]) later[part_of[low]].push_back(high);
  }

  first_border.push_back(0);
  for (std::uint32_t part = 0; part < parts.size(); ++part) {
    std::vector<std::uint32_t>& mine = later[part];
    std::ranges::sort(mine);
    mine.erase(std::unique(mine.begin(), mine.end()), mine.end());
    border.insert(border.end(), mine.begin(), mine.end());
    first_border.push_back(border.size());
    if (parts[part].parent == Dissection::no_part) continue;
    std::vector<std::uint32_t>& inherited = later[parts[part].parent];
    inherited.insert(inherited.end(), std::ranges::lower_bound(mine, parts[parts[part].parent].end),
                     mine.end());
    mine = {};
  }

  at_parent.resize(border.size());
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const std::uint32_t parent = parts[part].parent;
    if (parent == Dissection::no_part) continue;
    for (std::size_t i = first_border[part]; i < first_border[part + 1]; ++i)
      at_parent[i] = static_cast<std::uint32_t>(at(parent, border[i]));
  }
}

std::size_t Fronts::at(std::size_t part, std::uint32_t place) const {
  if (place < parts[part].end) return border_size(part) + (place - parts[part].begin);
  const auto begin = border.begin() + static_cast<std::ptrdiff_t>(first_border[part]);
  const auto end = border.begin() + static_cast<std::ptrdiff_t>(first_border[part + 1]);
  return static_cast<std::size_t>(std::lower_bound(begin, end, place) - begin);
}

BlockFactor::BlockFactor(const StepMatrix& matrix, std::span<const Vec3d> places, std::size_t lanes)
    : fronts(matrix, Dissection(matrix, places, smallest_region)) {
  std::size_t floats = 0;
  for (std::size_t part = 0; part < fronts.parts.size(); ++part) {
    const std::size_t rows = round_up(fronts.rows(part), lanes);
    blocks.push_back({floats, rows, front_floats});
    floats += rows * fronts.pivots(part);
    front_floats += 3 * rows;
    most_rows = std::max(most_rows, rows);
  }
  require_factor_memory(floats + front_floats, sizeof(float));
  panels = AlignedArray(floats);
  eliminate_all(matrix);
}

std::size_t BlockFactor::cost(std::size_t part) const {
  constexpr std::size_t row_cost = 32;
  return blocks[part].rows * (fronts.pivots(part) + row_cost);
}

void BlockFactor::eliminate_all(const StepMatrix& matrix) {
  const auto [place, part_of] = placement_of(fronts);
  std::vector<std::vector<StepMatrix::Coupling>> couplings(blocks.size());  // by place, the earlier first
  for (const auto& coupling : matrix.couplings) {
    const auto [low, high] = std::minmax(place[coupling.first], place[coupling.second]);
    couplings[part_of[low]].push_back({low, high, coupling.weight});
  }

  std::vector<std::vector<double>> left(blocks.size());  // for the border: lower triangle, by columns
  std::vector<double> front, panel;
  for (std::size_t part = 0; part < blocks.size(); ++part) {
    const std::size_t rows = fronts.rows(part), pivots = fronts.pivots(part), border = rows - pivots;
    front.assign(rows * rows, 0);
    const auto add = [&](std::size_t i, std::size_t j, double value) {
      front[std::max(i, j) + std::min(i, j) * rows] += value;
    };
    const std::uint32_t begin = fronts.parts[part].begin;
    for (std::size_t i = 0; i < pivots; ++i)
      add(border + i, border + i, matrix.diagonal[fronts.order[begin + i]]);
    for (const auto& coupling : couplings[part])
      add(border + coupling.first - begin, fronts.at(part, coupling.second), -coupling.weight);
    for (const std::uint32_t child : fronts.children.of(part)) {
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
