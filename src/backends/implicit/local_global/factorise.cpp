#include "backends/implicit/local_global/factorise.h"

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <limits>
#include <string>

#include "backends/interface/backend.h"
#include "platform/machine.h"

namespace mssim {
namespace {

using Index = int;  // as Eigen's orderings want it
using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;

[[noreturn]] void refuse_indefinite() {
  throw Unsupported("the matrix of its global step is not positive definite in double precision");
}

std::ptrdiff_t signed_size(std::size_t size) { return static_cast<std::ptrdiff_t>(size); }

/// Both triangles.
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

/// How many entries the Cholesky factor of a matrix has, of which the upper triangle is given: row by row
/// along the elimination tree (Liu 1990), without storing any.
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

}  // namespace

void require_memory(std::size_t entries, std::size_t entry_bytes) {
  if (const auto shortage = memory_shortage(entries * entry_bytes))
    throw Unsupported("the factor of its global step " + *shortage);
}

ColumnFactor factorise(const StepMatrix& matrix) {
  const Matrix whole = whole_matrix(matrix);
  // From places to rows: its inverse takes rows to places.
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, Index> order;
  Eigen::AMDOrdering<Index>()(whole, order);
  Matrix upper(whole.rows(), whole.cols());
  upper.selfadjointView<Eigen::Upper>() = whole.selfadjointView<Eigen::Upper>().twistedBy(order.inverse());
  const std::size_t entries = count_entries(upper);
  if (entries > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    throw Unsupported("the factor of its global step would have " + std::to_string(entries) +
                      " entries, more than Eigen can number");
  // Eigen's factor and this one, and what a backend makes of it.
  require_memory(entries, 2 * (sizeof(double) + sizeof(Index)) + sizeof(double));
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

}  // namespace mssim
