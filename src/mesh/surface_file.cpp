#include "mesh/surface_file.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "geometry/geometry.h"
#include "mesh/text_lines.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Points by their locations, each once, so files that list the corners of every triangle separately become
/// surfaces with shared points.
using MergedPoints = PointNumbers<std::array<double, 3>>;

/// The number of the point at exactly this location.
std::uint32_t number_of(const Vec3d& point, MergedPoints& points) {
  // Adding zero turns -0 into 0.
  const std::array<double, 3> at{point.x + 0.0, point.y + 0.0, point.z + 0.0};
  return points.of(at, [&] { return Vec3d{at[0], at[1], at[2]}; });
}

using Corners = std::array<std::size_t, 3>;

/// Triangles that fan out from the first corner.
std::vector<Corners> fan(std::size_t corners) {
  std::vector<Corners> triangles;
  for (std::size_t i = 2; i < corners; ++i) triangles.push_back({0, i - 1, i});
  return triangles;
}

/// Cuts a polygon of four or more corners in its plane, whose normal is Newell's: the sum of the cross
/// products along its edges.
class PolygonCutter {
 public:
  explicit PolygonCutter(const std::vector<Vec3d>& corners) {
    const Vec3d& first = corners.front();
    Vec3d normal;
    double longest = 0, farthest = length(first);
    for (std::size_t i = 1; i < corners.size(); ++i) {
      normal += cross(corners[i - 1] - first, corners[i] - first);
      longest = std::max(longest, length(corners[i] - first));
      farthest = std::max(farthest, length(corners[i]));
    }
    constexpr double rounding = 1e-12, six_digits = 1e-6;
    touching_ = rounding * longest * longest;
    as_written_ = six_digits * longest * farthest;
    if (length(normal) <= touching_) return;
    normal = 1 / length(normal) * normal;
    const bool is_level = std::abs(normal.z) >= std::max(std::abs(normal.x), std::abs(normal.y));
    const Vec3d aside = cross(is_level ? Vec3d{1, 0, 0} : Vec3d{0, 0, 1}, normal);
    const Vec3d right = 1 / length(aside) * aside, up = cross(normal, right);
    for (const Vec3d& corner : corners)
      flat_.push_back({dot(corner - first, right), dot(corner - first, up), 0});
  }

  bool has_plane() const { return !flat_.empty(); }

  /// Does the fan from the first corner cover the polygon, as for a convex one? The other corners are then
  /// seen in order from there, in at most one turn.
  bool fan_covers() const {
    double angle = 0;
    for (const auto& [a, b, c] : fan(flat_.size())) {
      if (!has_area({a, b, c})) return false;
      angle += std::atan2(area(a, b, c), dot(flat_[b] - flat_[a], flat_[c] - flat_[a]));
    }
    return angle < 2 * std::numbers::pi;
  }

  bool crosses_itself() const {
    const std::size_t n = flat_.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j)
        if (cross_each_other(i, (i + 1) % n, j, (j + 1) % n, as_written_)) return true;
    return false;
  }

  /// Cuts off ears one after the other: three consecutive corners with nothing of the polygon between them.
  /// Ears without area (corners on a line) come last. Nothing if no ear is left.
  std::optional<std::vector<Corners>> ears() const {
    std::vector<std::size_t> left(flat_.size());
    std::iota(left.begin(), left.end(), std::size_t{0});
    std::vector<Corners> cut;
    for (std::size_t begin = 0; left.size() > 3;) {
      auto at = find_ear(left, begin, true);
      if (!at) at = find_ear(left, begin, false);
      if (!at) return std::nullopt;
      cut.push_back(corners_at(left, *at));
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(*at));
      begin = *at + 1;  // the next ear is not adjacent, which would make a fan of long triangles
    }
    cut.push_back({left[0], left[1], left[2]});
    if (area(left[0], left[1], left[2]) < -as_written_) return std::nullopt;
    return cut;
  }

 private:
  /// Twice the triangle's area; positive if it is oriented like the polygon.
  double area(std::size_t a, std::size_t b, std::size_t c) const {
    const Vec3d ab = flat_[b] - flat_[a], ac = flat_[c] - flat_[a];
    return ab.x * ac.y - ab.y * ac.x;
  }
  bool has_area(const Corners& triangle) const {
    constexpr double least = 1e-9;
    const auto& [a, b, c] = triangle;
    const Vec3d ab = flat_[b] - flat_[a], ac = flat_[c] - flat_[a];
    return area(a, b, c) > least * std::max(dot(ab, ab), dot(ac, ac));
  }

  /// Does the segment from a to b cross the one from c to d, rather than only touch it?
  bool cross_each_other(std::size_t a, std::size_t b, std::size_t c, std::size_t d, double touching) const {
    const auto on_two_sides = [&](double one, double other) {
      return std::min(one, other) < -touching && std::max(one, other) > touching;
    };
    return on_two_sides(area(a, b, c), area(a, b, d)) && on_two_sides(area(c, d, a), area(c, d, b));
  }

  static Corners corners_at(const std::vector<std::size_t>& left, std::size_t at) {
    const std::size_t n = left.size();
    return {left[(at + n - 1) % n], left[at], left[(at + 1) % n]};
  }

  /// Can this ear be cut off the remaining corners?
  bool is_ear(const std::vector<std::size_t>& left, const Corners& ear, bool with_area) const {
    const auto& [a, b, c] = ear;
    if (with_area ? !has_area(ear) : area(a, b, c) < -as_written_) return false;
    const double margin = with_area ? -touching_ : touching_;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const std::size_t p = left[i];
      if (cross_each_other(a, c, p, left[(i + 1) % left.size()], touching_)) return false;
      // A cut to a hole and the way back have corners at the same location.
      if (flat_[p] == flat_[a] || flat_[p] == flat_[b] || flat_[p] == flat_[c]) continue;
      if (area(a, b, p) >= margin && area(b, c, p) >= margin && area(c, a, p) >= margin) return false;
    }
    return true;
  }

  std::optional<std::size_t> find_ear(const std::vector<std::size_t>& left, std::size_t begin,
                                      bool with_area) const {
    for (std::size_t i = 0; i < left.size(); ++i) {
      const std::size_t at = (begin + i) % left.size();
      if (is_ear(left, corners_at(left, at), with_area)) return at;
    }
    return std::nullopt;
  }

  std::vector<Vec3d> flat_;  ///< the corners in the plane (z is 0); empty without a plane
  double touching_ = 0;      ///< twice the area that rounding may give three corners on a line
  double as_written_ = 0;    ///< twice the area that a file of six digits may give them
};

/// Are the corners in a plane, within a thousandth of their extent?
bool is_flat_quad(const std::vector<Vec3d>& corners) {
  constexpr double level = 1e-3;
  const Vec3d a = corners[1] - corners[0], b = corners[2] - corners[0], c = corners[3] - corners[0];
  const double longest = std::max({length(a), length(b), length(c)});
  return std::abs(dot(a, cross(b, c))) <= level * longest * longest * longest;
}

bool on_a_line(const std::vector<Vec3d>& corners) {
  constexpr double rounding = 1e-9;
  const auto from_first = [&](const Vec3d& corner) { return corner - corners[0]; };
  const Vec3d along = from_first(*std::ranges::max_element(
      corners, {}, [&](const Vec3d& corner) { return length(from_first(corner)); }));
  return std::ranges::all_of(corners, [&](const Vec3d& corner) {
    return length(cross(along, from_first(corner))) <= rounding * dot(along, along);
  });
}

class ObjReader {
 public:
  ObjReader(const std::string& name, std::string_view text)
      : lines_(name, text, {'#', '\\'}), points_(surface_) {}

  Surface read() {
    while (lines_.next()) {
      const std::string_view keyword = lines_.words().front();
      if (keyword == "v") vertices_.push_back(lines_.point());
      if (keyword == "f") face();
    }
    if (faces_.empty())
      lines_.fail(
          "the file ends without an f line; give an OBJ file with a surface of triangles or polygons");
    for (const Face& face : faces_) add(face);
    return std::move(surface_);
  }

 private:
  struct Face {
    std::size_t line;
    std::vector<std::int64_t> vertices;  ///< from 1
  };

  /// A corner reads V, V/VT, V//VN or V/VT/VN; negative numbers count back from the latest.
  std::int64_t corner(std::string_view word) const {
    std::int64_t vertex = 0;
    std::size_t part = 0;
    for (std::string_view rest = word;; ++part) {
      const std::size_t slash = std::min(rest.find('/'), rest.size());
      const bool may_be_empty = part == 1 && slash < rest.size();
      const bool is_empty = may_be_empty && slash == 0;
      const auto number = number_in<std::int64_t>(rest.substr(0, slash));
      if (part > 2 || (!number && !is_empty))
        lines_.fail("the corner {} of a face cannot be read; write V, V/VT, V//VN or V/VT/VN",
                    TextLines::quoted(word));
      if (part == 0) vertex = *number;
      if (slash == rest.size()) break;
      rest.remove_prefix(slash + 1);
    }
    const auto latest = static_cast<std::int64_t>(vertices_.size());
    if (vertex < 0) vertex += latest + 1;
    if (vertex < 1)
      lines_.fail("the corner {} of a face names no vertex; they count from 1, or -1 for the latest",
                  TextLines::quoted(word));
    return vertex;
  }

  void face() {
    Face face{lines_.line(), {}};
    for (std::size_t i = 1; i < lines_.words().size(); ++i)
      face.vertices.push_back(corner(lines_.words()[i]));
    if (face.vertices.size() < 3)
      lines_.fail("the face has {} corners; give three or more", face.vertices.size());
    faces_.push_back(std::move(face));
  }

  /// Faces may name later vertices, so they are resolved at the end.
  void add(const Face& face) {
    std::vector<std::uint32_t> points;
    for (const std::int64_t vertex : face.vertices) {
      if (vertex > static_cast<std::int64_t>(vertices_.size()))
        lines_.fail_at(
            face.line,
            fmt::format("the face names vertex {} of {}; the file is truncated or the number wrong", vertex,
                        vertices_.size()));
      points.push_back(number_of(vertices_[static_cast<std::size_t>(vertex - 1)], points_));
    }
    if (points.size() > 3) leave_out_repeated(points);
    for (const auto& [a, b, c] : triangles_of(face.line, points))
      surface_.triangles.push_back({points[a], points[b], points[c]});
  }

  /// Keeps one of consecutive corners at the same location, unless that leaves no triangle.
  static void leave_out_repeated(std::vector<std::uint32_t>& points) {
    std::vector<std::uint32_t> apart = points;
    apart.erase(std::unique(apart.begin(), apart.end()), apart.end());
    while (apart.size() > 1 && apart.back() == apart.front()) apart.pop_back();
    if (apart.size() >= 3) points = std::move(apart);
  }

  std::vector<Corners> triangles_of(std::size_t line, const std::vector<std::uint32_t>& points) const {
    if (points.size() == 3) return fan(3);
    std::vector<Vec3d> corners;
    for (const std::uint32_t point : points) corners.push_back(surface_.points[point]);
    const PolygonCutter polygon(corners);
    if (polygon.has_plane() ? polygon.fan_covers() : on_a_line(corners)) return fan(points.size());
    const std::string which = fmt::format("the polygon of {} corners ", points.size());
    constexpr std::string_view remedy = "; cut it into triangles where the surface was made";
    constexpr std::size_t most = 1000;  // ears take the square of it, or more
    if (points.size() > most)
      lines_.fail_at(line, fmt::format("{}is concave, and at most {} can be cut{}", which, most, remedy));
    if (polygon.has_plane() && !polygon.crosses_itself())
      if (const auto ears = polygon.ears()) return *ears;
    // Opposite edges of a bent quadrangle do not meet, so any diagonal will do.
    if (points.size() == 4 && !is_flat_quad(corners)) return fan(4);
    lines_.fail_at(line, fmt::format("{}crosses itself{}", which, remedy));
  }

  TextLines lines_;
  std::vector<Vec3d> vertices_;
  std::vector<Face> faces_;
  Surface surface_;
  MergedPoints points_;
};

// A binary file: 80 bytes of any text, the number of triangles, then a normal, three corners and two bytes
// for each; numbers are little-endian.
constexpr std::size_t bytes_before_count = 80;
constexpr std::size_t bytes_before_triangles = 84;
constexpr std::size_t bytes_of_triangle = 50;
constexpr std::size_t bytes_of_vector = 12;

std::uint32_t number_at(std::string_view content, std::size_t byte) {
  std::uint32_t number = 0;
  for (std::size_t i = 4; i-- > 0;) number = number << 8 | static_cast<unsigned char>(content[byte + i]);
  return number;
}

Vec3d vector_at(std::string_view content, std::size_t byte) {
  const auto real = [&](std::size_t axis) {
    return static_cast<double>(std::bit_cast<float>(number_at(content, byte + 4 * axis)));
  };
  return {real(0), real(1), real(2)};
}

Surface parse_binary(const std::string& name, std::string_view content) {
  const std::size_t count = number_at(content, bytes_before_count);
  const std::size_t due = bytes_before_triangles + count * bytes_of_triangle;
  const std::string promise = fmt::format("{}, byte {}: the file announces {} in {} bytes, and ", name,
                                          bytes_before_count, pluralize(count, "triangle"), due);
  if (content.size() < due)
    throw InputError("{}has {}; it is truncated or not an STL file", promise, content.size());
  // Some writers fill up the last block; a whole extra triangle means that the number is wrong.
  if (content.size() - due >= bytes_of_triangle)
    throw InputError("{}{} bytes follow the last; the number is wrong, so write the file again", promise,
                     content.size() - due);
  if (count == 0) throw InputError(name + ": the file has no triangles; give a surface");
  Surface surface;
  MergedPoints points(surface);
  surface.triangles.reserve(count);
  for (std::size_t t = 0; t < count; ++t) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::size_t byte =
          bytes_before_triangles + t * bytes_of_triangle + (corner + 1) * bytes_of_vector;
      const Vec3d point = vector_at(content, byte);
      if (!is_coordinate(point.x) || !is_coordinate(point.y) || !is_coordinate(point.z))
        throw InputError("{}, byte {}: a corner is at {}; for each axis {}", name, byte, place(point),
                         coordinate_wanted);
      triangle[corner] = number_of(point, points);
    }
    surface.triangles.push_back(triangle);
  }
  return surface;
}

class AsciiReader {
 public:
  AsciiReader(const std::string& name, std::string_view text)
      : lines_(name, text, {'\0', '\0'}), points_(surface_) {}

  Surface read() {
    while (lines_.next()) {
      require("solid", "");
      while (next_is("facet")) facet();
      require("endsolid", "");
    }
    if (surface_.triangles.empty()) lines_.fail("the file has no facets; give a surface");
    return std::move(surface_);
  }

 private:
  /// Does the line begin with the keyword? Some writers have "end loop" for "endloop".
  bool begins(std::string_view keyword) const {
    const auto& words = lines_.words();
    constexpr std::string_view end = "end";
    const std::string first = to_lower(words[0]);
    return first == keyword || (words.size() > 1 && keyword.starts_with(end) && first == end &&
                                to_lower(words[1]) == keyword.substr(end.size()));
  }

  /// Advances to the next line and tests whether it begins with the keyword.
  bool next_is(std::string_view keyword) {
    lines_.require_next("\"endsolid\"");
    return begins(keyword);
  }

  /// The line must begin with these words (the second may be empty: anything).
  void require(std::string_view first, std::string_view second) const {
    const auto& words = lines_.words();
    if (begins(first) && (second.empty() || (words.size() > 1 && to_lower(words[1]) == second))) return;
    const std::string due = std::string(first) + (second.empty() ? "" : " ") + std::string(second);
    lines_.fail("it begins with {} where \"{}\" is expected; the file is damaged or not an STL file",
                TextLines::quoted(words[0]), due);
  }

  void next(std::string_view first, std::string_view second) {
    lines_.require_next("\"" + std::string(first) + "\"");
    require(first, second);
  }

  void facet() {
    next("outer", "loop");
    std::array<std::uint32_t, 3> triangle{};
    for (std::uint32_t& point : triangle) {
      next("vertex", "");
      point = number_of(lines_.point(), points_);
    }
    next("endloop", "");
    next("endfacet", "");
    surface_.triangles.push_back(triangle);
  }

  TextLines lines_;
  Surface surface_;
  MergedPoints points_;
};

/// Binary files may begin with "solid" as well, so the length decides; if it is wrong too (truncated), a zero
/// byte, which no text has.
bool is_binary(std::string_view content) {
  if (content.size() < bytes_before_triangles) return content.find('\0') != std::string_view::npos;
  const std::size_t count = number_at(content, bytes_before_count);
  return content.size() == bytes_before_triangles + count * bytes_of_triangle ||
         content.find('\0') != std::string_view::npos;
}

}  // namespace

FileSurface read_surface(const std::filesystem::path& file) {
  const std::string ending = to_lower(file.extension().string());
  FileSurface read;
  if (ending == ".obj")
    read.surface = parse_obj(file.string(), read_text(file));
  else if (ending == ".stl")
    read.surface = parse_stl(file.string(), read_text(file));
  else
    throw InputError(file.string() +
                     " ends in neither .obj nor .stl; give a surface in one of those formats");
  if (const std::size_t merged = join_corners(read.surface); merged > 0)
    read.note = file.string() + ": " + pluralize(merged, "point") + (merged == 1 ? " was" : " were") +
                " merged with others within a hundred-thousandth of its size, so that its triangles join";
  return read;
}

Surface parse_obj(const std::string& name, std::string_view text) { return ObjReader(name, text).read(); }

Surface parse_stl(const std::string& name, std::string_view content) {
  if (content.empty()) throw InputError(name + " is empty; give a surface");
  if (!is_binary(content)) return AsciiReader(name, content).read();
  if (content.size() < bytes_before_triangles)
    throw InputError("{} has {}, and a binary STL file at least 84; it is truncated or not an STL file", name,
                     pluralize(content.size(), "byte"));
  return parse_binary(name, content);
}

}  // namespace mssim
