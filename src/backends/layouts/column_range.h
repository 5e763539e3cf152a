#pragma once

#include <algorithm>
#include <cstddef>

namespace mssim {

/// Columns of a cloth that follow each other.
struct ColumnRange {
  std::size_t first = 0, count = 0;
  std::size_t end() const { return first + count; }
};

/// One of `parts` parts of these columns, which differ by at most one column: what a process of several takes
/// of a cloth, and a thread of that.
inline ColumnRange part_of(ColumnRange all, std::size_t part, std::size_t parts) {
  const std::size_t begin = all.count * part / parts, end = all.count * (part + 1) / parts;
  return {all.first + begin, end - begin};
}

/// These columns, and beside them so many of the others that a cloth of `columns` has.
inline ColumnRange with_ghosts(ColumnRange own, std::size_t ghosts, std::size_t columns) {
  const std::size_t begin = own.first - std::min(own.first, ghosts);
  return {begin, std::min(own.end() + ghosts, columns) - begin};
}

}  // namespace mssim
