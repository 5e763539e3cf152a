#include "render/camera.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <system_error>

namespace mssim {
namespace {

constexpr std::array<NamedView, 4> table{{
    {"front", {0, 8}},
    {"side", {90, 8}},
    {"back", {180, 8}},
    {"three-quarter", {35, 18}},
}};

std::optional<double> degrees(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

std::vector<NamedView> named_views() { return {table.begin(), table.end()}; }

std::optional<ViewDirection> view_direction(std::string_view text) {
  if (const auto* row = std::ranges::find(table, text, &NamedView::name); row != table.end())
    return row->direction;
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const auto azimuth = degrees(text.substr(0, comma)), elevation = degrees(text.substr(comma + 1));
  if (!azimuth || !elevation || std::abs(*azimuth) > 360 || std::abs(*elevation) > 90) return std::nullopt;
  return ViewDirection{*azimuth, *elevation};
}

Camera::Camera(const ViewDirection& direction) {
  const double around = direction.azimuth * std::numbers::pi / 180;
  const double above = direction.elevation * std::numbers::pi / 180;
  right_ = {std::cos(around), 0, -std::sin(around)};
  near_ = {std::sin(around) * std::cos(above), std::sin(above), std::cos(around) * std::cos(above)};
  up_ = cross(near_, right_);
}

PixelGrid grid_around(const Box<double>& seen, std::uint32_t columns, std::uint32_t rows, double margin) {
  constexpr double smallest = 1e-9;  // m, of a picture of one point
  const double inside = 1 - 2 * margin;
  const Vec3d size = seen.size(), middle = seen.middle();
  PixelGrid grid;
  grid.pixel = std::max({size.x / (columns * inside), size.y / (rows * inside), smallest});
  grid.columns = columns;
  grid.rows = rows;
  grid.left = middle.x - 0.5 * columns * grid.pixel;
  grid.bottom = middle.y - 0.5 * rows * grid.pixel;
  return grid;
}

}  // namespace mssim
