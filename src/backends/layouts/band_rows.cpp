#include "backends/layouts/band_rows.h"

#include <algorithm>
#include <map>

namespace mssim {
namespace {

/// Whether a row of the cloth is there.
bool has_row(const BandLayout& layout, std::ptrdiff_t row) {
  return row >= 0 && row < static_cast<std::ptrdiff_t>(layout.rows);
}

/// The vectors of a row of the bands.
std::vector<float> values_of_row(const BandLayout& layout, const std::vector<SpringConstants>& springs,
                                 float gravity, const ColumnsToEnd& to_end, std::ptrdiff_t band_row) {
  const std::size_t lanes = layout.lanes;
  std::vector<float> values((BandRows::gravity_vector + 1) * lanes);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(lane % layout.bands * layout.height) + band_row;
    const std::size_t columns = to_end[lane / layout.bands];
    if (columns == 0 || !has_row(layout, row)) continue;
    values[BandRows::gravity_vector * lanes + lane] = gravity;
    for (std::size_t i = 0; i < grid_stencil.size(); ++i) {
      if (!has_row(layout, row + grid_stencil[i].rows)) continue;
      if (static_cast<std::size_t>(grid_stencil[i].columns) >= columns) continue;
      const SpringConstants& spring = springs[grid_stencil[i].kind];
      float* of_lane = values.data() + i * BandRows::spring_vectors * lanes + lane;
      of_lane[0] = spring.stiffness;
      of_lane[lanes] = spring.stiffness_rest;
      of_lane[2 * lanes] = spring.damping;
    }
  }
  return values;
}

}  // namespace

BandRows::BandRows(const BandLayout& layout, const std::vector<SpringConstants>& springs, float gravity,
                   ColumnsToEnd to_end) {
  std::vector<float> all;
  std::map<std::vector<float>, std::uint32_t> offset_of;
  const auto beyond = static_cast<std::ptrdiff_t>(BandLayout::halo);
  const auto height = static_cast<std::ptrdiff_t>(layout.height);
  for (std::ptrdiff_t row = -beyond; row < height + beyond; ++row) {
    const std::vector<float> values = values_of_row(layout, springs, gravity, to_end, row);
    const auto [found, is_new] = offset_of.try_emplace(values, static_cast<std::uint32_t>(all.size()));
    if (is_new) all.insert(all.end(), values.begin(), values.end());
    offsets_.push_back(found->second);
  }
  values_ = AlignedArray(all.size());
  std::ranges::copy(all, values_.data());
}

}  // namespace mssim
