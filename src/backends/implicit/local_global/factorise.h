#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "backends/implicit/local_global/step_matrix.h"

namespace mssim {

/// All that is done by Eigen, which takes seconds to compile: it stands in factorise.cpp alone.

/// A = P^T L L^T P (Cholesky), L by columns. P takes row order[i] of the matrix to place i.
struct ColumnFactor {
  std::vector<std::uint32_t> order;  ///< [rows]
  std::vector<std::size_t> first;    ///< [rows + 1] where a column of L begins
  std::vector<std::uint32_t> place;  ///< [entries] ascending in a column, whose diagonal comes first
  std::vector<double> value;         ///< [entries]
};

/// Factorises the matrix in an approximate minimum degree order (Amestoy, Davis and Duff 1996). Throws
/// Unsupported where there is not the memory for it, or where the matrix is not positive definite.
ColumnFactor factorise(const StepMatrix& matrix);

/// Eliminates the last `pivots` of `rows` unknowns from a dense symmetric system F, [rows][rows] by columns,
/// of which the lower triangle is given. With F = (F_rr, F_rp; F_pr, F_pp), r: the rows that remain, first,
///
///     F_rr (its lower triangle) becomes  F_rr - F_rp F_pp^-1 F_pr,
///     panel, [rows][pivots] by columns, (-F_rp F_pp^-1; F_pp^-1).
///
/// The rest of F is changed. Throws Unsupported where F_pp is not positive definite.
void eliminate(std::span<double> front, std::size_t rows, std::size_t pivots, std::span<double> panel);

/// Throws Unsupported where a factor's `entries`, which take so many bytes each, are more than there is
/// memory for.
void require_memory(std::size_t entries, std::size_t entry_bytes);

}  // namespace mssim
