#include "geometry/vertex_normals.h"

#include <cmath>
#include <cstddef>

namespace mssim {

std::vector<Vec3d> vertex_normals(const Surface& surface) {
  std::vector<Vec3d> normals(surface.points.size());
  for (const auto& triangle : surface.triangles)
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Vec3d& at = surface.points[triangle[corner]];
      const Vec3d to_next = surface.points[triangle[(corner + 1) % 3]] - at;
      const Vec3d to_last = surface.points[triangle[(corner + 2) % 3]] - at;
      const Vec3d normal = cross(to_next, to_last);
      const double sine = length(normal);  // times both lengths, like the cosine
      if (sine > 0) normals[triangle[corner]] += (std::atan2(sine, dot(to_next, to_last)) / sine) * normal;
    }
  for (Vec3d& normal : normals)
    if (const double sum = length(normal); sum > 0) normal = (1 / sum) * normal;
  return normals;
}

Surface inflated(const Surface& surface, const std::vector<Vec3d>& normals, double offset) {
  Surface result = surface;
  for (std::size_t point = 0; point < result.points.size(); ++point)
    result.points[point] += offset * normals[point];
  return result;
}

}  // namespace mssim
