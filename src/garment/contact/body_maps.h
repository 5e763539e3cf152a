#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geometry/depth_raster.h"
#include "geometry/surface.h"
#include "geometry/vec3.h"
#include "kernels/parameters.h"
#include "laws/host_laws.h"

namespace mssim {

/// Depth and normal map of a body from one side, row by row.
struct SideMap {
  /// m, z of the nearest face at the pixel's centre; without a body -infinity from the front, +infinity from
  /// the back.
  std::vector<double> depth;
  /// Unit normal there, interpolated between those of the face's corners; (0, 0, 0) without a body.
  std::vector<Vec3d> normal;
};

/// The maps of `surface` with these normals at its points. They are bitwise identical for every number of
/// OpenMP's threads. Throws as rasterise() does.
SideMap side_map(const Surface& surface, const std::vector<Vec3d>& normals, const PixelGrid& grid,
                 ViewFrom view);

/// Settings of the maps of a body.
struct BodyMapSettings {
  double pixel = 0.0025;  ///< m, width and height of a pixel
  double offset = 0;      ///< m, by which the surface is moved outwards, along the normals at its points
};

/// A pixel's record, aligned to its own size: a cache line holds two.
struct alignas(BODY_FLOATS * sizeof(float)) BodyPixel : BodyPlanes<float> {};
static_assert(sizeof(BodyPixel) == BODY_FLOATS * sizeof(float));

/// A body as cloth collides with it: orthographic images from the front (z = +infinity) and the back. Each
/// pixel holds the tangent plane of the nearest face (Vassilev, Spanlang and Chrysanthou, "Fast cloth
/// animation on walking avatars", 2001, compare with the depth instead). A point is tested against the two
/// planes of the pixel in which it lies, so that the cost of a test does not depend on the number of
/// triangles.
///
/// Beyond the silhouette, two pixels repeat the planes of their neighbours. Otherwise a point that
/// slides from pixel to pixel there would touch in every other step and chatter. The plane of a face seen
/// edge-on leans 6 degrees towards the camera, so that points far in front of the body do not count as behind
/// the plane.
///
/// Limitations of images:
/// - Each pixel has one interval of depth. The space between the nearest and the farthest face counts as
///   solid: between an arm and the hip behind it, between crossed legs, under an overhang that the cameras do
///   not see.
/// - The distance is from the plane of one pixel, not from the body. It is accurate near the surface, but
///   rough at silhouettes (to about a pixel) and where the body bends within a pixel. A point deep inside may
///   be nearer to the plane of the wrong side and leave there: cloth must start outside.
/// - Only points are tested. A vertex or ridge of the body may pass through a face or edge of the cloth
///   between points: the offset must be at least the sagitta of the cloth's edges.
/// - Thighs that touch over a length are one solid, and cloth is not drawn between them. If two bodies are
///   less than four pixels apart, the pixels between them hold the planes of one.
///
/// Immutable: threads may use it concurrently.
class BodyMaps {
 public:
  /// Throws InputError unless validate_surface accepts the surface, std::invalid_argument for settings out of
  /// range and for more than most_pixels_a_side pixels along a side.
  explicit BodyMaps(const Surface& surface, const BodyMapSettings& settings = {});

  const BodyFrame& frame() const { return frame_; }
  /// frame().rows x frame().columns, row-major (kernels/parameters.h).
  std::span<const BodyPixel> pixels() const { return pixels_; }

  /// The pixel in which a point (m) lies; an empty one of the border, without contact, if the point is
  /// outside the maps or not finite.
  template <class Real>
  const BodyPixel& pixel_at(Real x, Real y) const {
    const auto column = static_cast<std::size_t>(body_column(
        x, Real{frame_.left}, Real{frame_.pixels_per_metre}, static_cast<Real>(frame_.columns - 1)));
    const auto row = static_cast<std::size_t>(body_column(
        y, Real{frame_.bottom}, Real{frame_.pixels_per_metre}, static_cast<Real>(frame_.rows - 1)));
    return pixels_[row * static_cast<std::size_t>(frame_.columns) + column];
  }

  /// The contact of a point (m) with the body. Outside the maps the distance is 1e30 m, and for coordinates
  /// that are not finite it is not less than zero: no contact.
  template <class Real>
  BodyContact<Real> contact(Real x, Real y, Real z) const {
    const BodyPixel& p = pixel_at(x, y);
    return body_contact(BodyPlanes<Real>{p.front_x, p.front_y, p.front_z, p.front_at, p.back_x, p.back_y,
                                         p.back_z, p.back_at},
                        x, y, z);
  }

  /// Tests the position after the step, x + dt v, and changes position (m) and velocity (m/s) as
  /// kernels/body_contact.h describes. push_speed in m/s, dt in s. Returns whether friction holds the point.
  template <class Real>
  bool respond(Vec3<Real>& x, Vec3<Real>& v, Real friction, Real push_speed, Real dt) const {
    const auto met = contact(x.x + dt * v.x, x.y + dt * v.y, x.z + dt * v.z);
    const auto after =
        body_response(ClothPoint<Real>{x.x, x.y, x.z, v.x, v.y, v.z}, met, friction, push_speed, dt);
    x = {after.x, after.y, after.z};
    v = {after.u, after.v, after.w};
    return after.stuck > 0;
  }

 private:
  BodyFrame frame_{};
  std::vector<BodyPixel> pixels_;
};

}  // namespace mssim
