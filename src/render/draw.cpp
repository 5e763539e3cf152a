#include "render/draw.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <system_error>

#include "platform/machine.h"

namespace mssim {
namespace {

std::uint8_t channel_of(float light) {
  constexpr std::size_t entries = 8192;  // fine enough for 8 bits
  static const auto codes = [] {
    std::array<std::uint8_t, entries> all{};
    for (std::size_t i = 0; i < entries; ++i)
      all[i] =
          static_cast<std::uint8_t>(std::lround(255 * srgb_code(static_cast<double>(i) / (entries - 1))));
    return all;
  }();
  return codes[static_cast<std::size_t>(std::clamp(light, 0.0F, 1.0F) * (entries - 1) + 0.5F)];
}

/// The TABLE of views.
struct NamedView {
  std::string_view name;
  ViewDirection direction;
};
constexpr auto views = std::to_array<NamedView>({
    {"front", {0, 8}},
    {"side", {90, 8}},
    {"back", {180, 8}},
    {"three-quarter", {35, 18}},
});

std::optional<double> degrees(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// The largest of 1, 2 and 5 times a power of ten up to `length`.
double round_length(double length) {
  const double power = std::pow(10, std::floor(std::log10(length)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= length) return factor * power;
  return power;
}

/// The fraction of an interval (`width`, centred `at` from the middle of a line) that the line covers.
double covered(double at, double width, double line) {
  const double low = std::max(at - width / 2, -line / 2), high = std::min(at + width / 2, line / 2);
  return std::max(high - low, 0.0) / width;
}

constexpr double lines_across = 8;   // lines of the grid across the subject
constexpr double line_pixels = 1.2;  // width of a line
constexpr float line_darkness = 0.22F, shadow_darkness = 0.45F;

constexpr float key_strength = 0.6F, fill_strength = 0.22F, sky_strength = 0.42F, ground_strength = 0.26F;
constexpr std::uint32_t shadow_pixels = 1024;
/// Offset of depths in pixels of the shadow map, so that slanted surfaces do not shade themselves.
constexpr double bias = 2.5;

/// Light of two lamps and the sky on a point, for each of its sides.
struct PointLight {
  float key_front = 0, rest_front = 0;  ///< from the key light, which casts shadows; from all others
  float key_back = 0, rest_back = 0;
};

/// The lights of a picture taken from `direction`: the key light is high to the left of the camera, the fill
/// light low to its right, and the sky is brighter than the ground.
class Lights {
 public:
  explicit Lights(const ViewDirection& direction)
      : key_({direction.azimuth - 40, 52}), fill_({direction.azimuth + 55, 15}) {}

  const Camera& key() const { return key_; }

  /// The light on a surface with this normal.
  PointLight on(const Vec3d& normal) const {
    const auto key = static_cast<float>(dot(normal, key_.near()));
    const auto fill = static_cast<float>(dot(normal, fill_.near()));
    const float up = 0.5F * static_cast<float>(normal.y);
    const auto rest = [&](float sign) {
      return fill_strength * std::max(sign * fill, 0.0F) + sky_strength * (0.5F + sign * up) +
             ground_strength * (0.5F - sign * up);
    };
    return {key_strength * std::max(key, 0.0F), rest(1), key_strength * std::max(-key, 0.0F), rest(-1)};
  }

 private:
  Camera key_, fill_;
};

Surface seen_by(const Camera& camera, const Surface& surface) {
  Surface seen{{}, surface.triangles};
  seen.points.reserve(surface.points.size());
  for (const Vec3d& point : surface.points) seen.points.push_back(camera.seen(point));
  return seen;
}

/// The shadow map of the key light: the nearest surface to it, on its own grid.
class Shadow {
 public:
  /// Maps the shadow of the subject's triangles. `threads` as in rasterise().
  Shadow(const Surface& surface, const Camera& key, int threads)
      : key_(key),
        grid_(grid_around(seen_box(key, surface.points), shadow_pixels, shadow_pixels, 2.0 / shadow_pixels)),
        depth_(grid_.pixels()) {
    rasterise(seen_by(key, surface), grid_, ViewFrom::front, threads,
              [&](std::uint32_t row, std::span<const Fragment> fragments) {
                float* out = depth_.data() + std::size_t{row} * grid_.columns;
                for (const Fragment& fragment : fragments)
                  *out++ = fragment.triangle == Fragment::nothing ? -std::numeric_limits<float>::infinity()
                                                                  : static_cast<float>(fragment.z);
              });
  }

  /// The fraction of the key light that reaches a point; between 0 and 1 at the edge of a shadow.
  float reaching(const Vec3d& point) const {
    constexpr double reach = 0.75;  // pixels over which the edge is smoothed
    const Vec3d seen = key_.seen(point);
    const double depth = seen.z + bias * grid_.pixel;
    const double x = (seen.x - grid_.left) / grid_.pixel - 0.5,
                 y = (seen.y - grid_.bottom) / grid_.pixel - 0.5;
    if (!(x > -2 && y > -2 && x < shadow_pixels + 1 && y < shadow_pixels + 1)) return 1;
    return 0.25F * (smoothed(x - reach, y - reach, depth) + smoothed(x + reach, y - reach, depth) +
                    smoothed(x - reach, y + reach, depth) + smoothed(x + reach, y + reach, depth));
  }

 private:
  float lit(std::int64_t column, std::int64_t row, double depth) const {
    if (column < 0 || row < 0 || column >= grid_.columns || row >= grid_.rows) return 1;
    return depth_[static_cast<std::size_t>(row) * grid_.columns + static_cast<std::size_t>(column)] > depth
               ? 0.0F
               : 1.0F;
  }

  /// Interpolates between the four pixels around (x, y).
  float smoothed(double x, double y, double depth) const {
    const auto column = static_cast<std::int64_t>(std::floor(x)),
               row = static_cast<std::int64_t>(std::floor(y));
    const auto right = static_cast<float>(x - std::floor(x)), up = static_cast<float>(y - std::floor(y));
    const float low = (1 - right) * lit(column, row, depth) + right * lit(column + 1, row, depth);
    const float high = (1 - right) * lit(column, row + 1, depth) + right * lit(column + 1, row + 1, depth);
    return (1 - up) * low + up * high;
  }

  const Camera& key_;
  PixelGrid grid_;
  std::vector<float> depth_;  ///< [rows][columns], m towards the light; -infinity if empty
};

/// Samples per pixel in each direction.
constexpr std::uint32_t samples = 4;
static_assert(band_rows % samples == 0, "a band is whole rows of pixels");

constexpr Light backdrop{0.91F, 0.92F, 0.94F};

/// Everything on which the light of a sample depends.
struct Stage {
  const Subject& subject;
  const Shot& shot;
  const Camera& camera;
  const PixelGrid& grid;  ///< of samples
  const std::vector<PointLight>& light;
  const Shadow& shadow;
  const Surface& seen;  ///< the subject as the camera sees it
  PointLight ground_light;

  Light of_ground(const Vec3d& point) const {
    const float key = ground_light.key_front, rest = ground_light.rest_front;
    const float light_there = (rest + key * shadow.reaching(point)) / (rest + key);
    return shot.ground->colour_at(point, backdrop, light_there, camera, samples * grid.pixel);
  }

  Light of_triangle(const Fragment& fragment, const Vec3d& point) const {
    const auto& corners = seen.triangles[fragment.triangle];
    const Vec3d &a = seen.points[corners[0]], &b = seen.points[corners[1]], &c = seen.points[corners[2]];
    const bool front = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0;
    float key = 0, rest = 0;
    Light colour;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const PointLight& at = light[corners[i]];
      const float weight = fragment.weights[i];
      key += weight * (front ? at.key_front : at.key_back);
      rest += weight * (front ? at.rest_front : at.rest_back);
      colour += weight * (front ? subject.front : subject.back)[corners[i]];
    }
    if (key > 0) key *= shadow.reaching(point);
    return (key + rest) * colour;
  }

  Light of(const Fragment& fragment, double x, double y) const {
    const bool hit = fragment.triangle != Fragment::nothing;
    if (shot.ground)
      if (const std::optional<Vec3d> point = shot.ground->met_by(camera, x, y))
        if (!hit || dot(camera.near(), *point) > fragment.z) return of_ground(*point);
    if (!hit) return backdrop;
    return of_triangle(fragment, x * camera.right() + y * camera.up() + fragment.z * camera.near());
  }
};

/// The sixteen fragments of a pixel.
struct PixelFragments {
  const Fragment* first;  ///< of the lowest row
  std::size_t row_pitch;  ///< from a row of fragments to the next
  double x, y;            ///< m, the centre of the first
  const Fragment& at(std::uint32_t i, std::uint32_t j) const { return first[j * row_pitch + i]; }
};

/// The mean light of a pixel's samples. Pixels with only ground, or one smooth surface, are shaded at fewer
/// points.
Light mean_light(const Stage& stage, const PixelFragments& pixel) {
  std::uint32_t hits = 0;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::uint32_t j = 0; j < samples; ++j)
    for (std::uint32_t i = 0; i < samples; ++i)
      if (const Fragment& fragment = pixel.at(i, j); fragment.triangle != Fragment::nothing) {
        ++hits;
        low = std::min(low, fragment.z);
        high = std::max(high, fragment.z);
      }
  const double step = stage.grid.pixel;
  const auto light_at = [&](std::uint32_t i, std::uint32_t j) {
    return stage.of(pixel.at(i, j), pixel.x + i * step, pixel.y + j * step);
  };
  if (hits == 0) return stage.of(*pixel.first, pixel.x + 1.5 * step, pixel.y + 1.5 * step);
  if (hits == samples * samples && high - low < 2 * samples * step)
    return 0.25F * (light_at(1, 0) + light_at(3, 1) + light_at(0, 2) + light_at(2, 3));
  Light sum;
  for (std::uint32_t j = 0; j < samples; ++j)
    for (std::uint32_t i = 0; i < samples; ++i) sum += light_at(i, j);
  return (1.0F / (samples * samples)) * sum;
}

}  // namespace

Light light_of(const Rgb& colour) {
  const auto light = [](std::uint8_t code) { return static_cast<float>(srgb_light(code / 255.0)); };
  return {light(colour.red), light(colour.green), light(colour.blue)};
}

Rgb colour_of(const Light& light) { return {channel_of(light.x), channel_of(light.y), channel_of(light.z)}; }

std::optional<ViewDirection> view_direction(std::string_view text) {
  if (const auto* row = std::ranges::find(views, text, &NamedView::name); row != views.end())
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
  constexpr double smallest = 1e-9;  // m, for a picture of one point
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

Ground::Ground(const Box<double>& box, double height) : height_(height), middle_(box.middle()) {
  const Vec3d size = box.size();
  const double across = std::max({size.x, size.z, 0.25 * size.y, 1e-6});
  spacing_ = round_length(across / lines_across);
  radius_ = 0.75 * std::hypot(across, across);
}

std::optional<Vec3d> Ground::met_by(const Camera& camera, double x, double y) const {
  constexpr double least_slope = 0.01;
  if (camera.near().y < least_slope) return std::nullopt;
  const double z = (height_ - y * camera.up().y) / camera.near().y;  // the camera's right is horizontal
  return x * camera.right() + y * camera.up() + z * camera.near();
}

Light Ground::colour_at(const Vec3d& point, const Light& background, float light, const Camera& camera,
                        double pixel) const {
  const double far = std::hypot(point.x - middle_.x, point.z - middle_.z) / radius_;
  const auto fade = static_cast<float>(std::clamp(2 - far, 0.0, 1.0));  // 1 nearby, 0 beyond two radii
  if (fade == 0) return background;
  // The size of a pixel on the ground, which grows towards the horizon.
  const Vec3d down = camera.up() - (camera.up().y / camera.near().y) * camera.near();
  const auto line_at = [&](double at, double right, double up) {
    return covered(at - spacing_ * std::round(at / spacing_), pixel * (std::abs(right) + std::abs(up)),
                   line_pixels * pixel);
  };
  const double lines =
      std::max(line_at(point.x, camera.right().x, down.x), line_at(point.z, camera.right().z, down.z));
  const float darkness = std::max(line_darkness * static_cast<float>(lines), shadow_darkness * (1 - light));
  return (1 - fade * darkness) * background;
}

Vec3d shadow_light(const ViewDirection& direction) { return Lights(direction).key().near(); }

Box<double> seen_box(const Camera& camera, const std::vector<Vec3d>& points) {
  const Vec3d first = camera.seen(points.front());
  Box<double> box{first, first};
  for (const Vec3d& point : points) extend(box, camera.seen(point));
  return box;
}

PixelGrid drawn_points(const Shot& shot) {
  constexpr double margin = 0.06;
  return grid_around(shot.seen, samples * shot.width, samples * shot.height, margin);
}

Picture drawn(const Subject& subject, const Shot& shot) {
  const Camera camera(shot.direction);
  const Lights lights(shot.direction);
  const std::vector<Vec3d> normals = vertex_normals(subject.surface);
  std::vector<PointLight> light(normals.size());
#pragma omp parallel for num_threads(openmp_team(shot.threads))
  for (std::size_t point = 0; point < normals.size(); ++point) light[point] = lights.on(normals[point]);
  const Shadow shadow(subject.surface, lights.key(), shot.threads);
  const Surface seen = seen_by(camera, subject.surface);
  const PixelGrid grid = drawn_points(shot);
  const Stage stage{subject, shot, camera, grid, light, shadow, seen, lights.on({0, 1, 0})};
  Picture picture(shot.width, shot.height);
  rasterise(seen, grid, ViewFrom::front, shot.threads,
            [&](std::uint32_t first_row, std::span<const Fragment> fragments) {
              const auto rows = static_cast<std::uint32_t>(fragments.size() / grid.columns);
              for (std::uint32_t row = 0; row < rows; row += samples)
                for (std::uint32_t x = 0; x < shot.width; ++x) {
                  const PixelFragments pixel{&fragments[std::size_t{row} * grid.columns + samples * x],
                                             grid.columns, grid.centre_x(samples * x),
                                             grid.centre_y(first_row + row)};
                  picture.at(x, shot.height - 1 - (first_row + row) / samples) =
                      colour_of(mean_light(stage, pixel));
                }
            });
  return picture;
}

}  // namespace mssim
