#include "backends/implicit/local_global/dissection.h"

#include <algorithm>
#include <utility>

namespace mssim {
namespace {

using Rows = std::span<std::uint32_t>;

/// The rows that each row has a coupling with: those of row i are others[first[i]] to others[first[i+1] - 1].
struct Couplings {
  std::vector<std::uint32_t> first, others;

  explicit Couplings(const StepMatrix& matrix) : first(matrix.rows() + 1) {
    for (const auto& coupling : matrix.couplings) ++first[coupling.first + 1], ++first[coupling.second + 1];
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    others.resize(first.back());
    std::vector<std::uint32_t> next = first;
    for (const auto& coupling : matrix.couplings) {
      others[next[coupling.first]++] = coupling.second;
      others[next[coupling.second]++] = coupling.first;
    }
  }
  std::span<const std::uint32_t> of(std::uint32_t row) const {
    return std::span(others).subspan(first[row], first[row + 1] - first[row]);
  }
};

class Dissector {
 public:
  Dissector(const StepMatrix& matrix, std::span<const Vec3d> places, std::size_t smallest)
      : couplings_(matrix), places_(places), smallest_(smallest), side_(matrix.rows()) {}

  /// Appends the parts of everything, one piece that hangs together after the other.
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
  /// Appends the parts of a region, those that it consists of before what separates them. Returns the last
  /// part of each piece that hangs together with nothing else of the region.
  std::vector<std::uint32_t> dissect(Rows region, Dissection& into) {
    if (region.empty()) return {};
    if (region.size() <= smallest_) return {append(region, into)};
    const std::size_t middle = cut(region);
    Rows one = region.first(middle), other = region.subspan(middle);
    const std::size_t from_one = border(one, other), from_other = border(other, one);
    // The smaller of both borders; ties go to the larger half.
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

  /// Moves the rows of `from` that have couplings into `to` to its end and returns how many they are.
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

  const Couplings couplings_;
  const std::span<const Vec3d> places_;
  const std::size_t smallest_;
  std::vector<std::uint32_t> side_;  ///< [rows] `present_` where a row is of the side that is looked at
  std::uint32_t present_ = 0;
};

}  // namespace

Dissection::Dissection(const StepMatrix& matrix, std::span<const Vec3d> places, std::size_t smallest) {
  order.reserve(matrix.rows());
  Dissector(matrix, places, std::max<std::size_t>(smallest, 1)).dissect_all(*this);
}

}  // namespace mssim
