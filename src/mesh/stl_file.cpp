#include <algorithm>
#include <bit>
#include <cmath>

#include "geometry/geometry.h"
#include "mesh/point_merger.h"
#include "mesh/surface_file.h"
#include "mesh/text_lines.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

// A binary file: 80 bytes of any text, the number of triangles, and for each a normal, three corners and two
// bytes; numbers are little-endian.
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
  const std::string promise = name + ", byte " + std::to_string(bytes_before_count) + ": the file promises " +
                              pluralize(count, "triangle") + " in " + std::to_string(due) + " bytes, and ";
  if (content.size() < due)
    throw InputError(promise + "has " + std::to_string(content.size()) +
                     "; it is truncated or not an STL file");
  // Some writers fill up the last block; a whole triangle more is one that the number leaves out.
  if (content.size() - due >= bytes_of_triangle)
    throw InputError(promise + std::to_string(content.size() - due) +
                     " bytes follow the last; the number is wrong, so write the file again");
  if (count == 0) throw InputError(name + ": the file has no triangles; give a surface");
  Surface surface;
  PointMerger merger(surface);
  surface.triangles.reserve(count);
  for (std::size_t t = 0; t < count; ++t) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::size_t byte =
          bytes_before_triangles + t * bytes_of_triangle + (corner + 1) * bytes_of_vector;
      const Vec3d point = vector_at(content, byte);
      if (!is_coordinate(point.x) || !is_coordinate(point.y) || !is_coordinate(point.z))
        throw InputError(name + ", byte " + std::to_string(byte) + ": a corner is at " + place(point) +
                         "; for each axis " + std::string(coordinate_wanted));
      triangle[corner] = merger.add(point);
    }
    surface.triangles.push_back(triangle);
  }
  return surface;
}

class AsciiReader {
 public:
  AsciiReader(const std::string& name, std::string_view text)
      : lines_(name, text, {'\0', '\0'}), merger_(surface_) {}

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
  static bool equal(std::string_view word, std::string_view keyword) {
    return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                      [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
  }

  /// Does the line begin so? Some writers have "end loop" for "endloop".
  bool begins(std::string_view keyword) const {
    const auto& words = lines_.words();
    constexpr std::string_view end = "end";
    return equal(words[0], keyword) || (words.size() > 1 && keyword.starts_with(end) &&
                                        equal(words[0], end) && equal(words[1], keyword.substr(end.size())));
  }

  /// Goes to the next line and says whether it begins so.
  bool next_is(std::string_view keyword) {
    lines_.require_next("\"endsolid\"");
    return begins(keyword);
  }

  /// The line must begin with these words (the second may be empty: anything).
  void require(std::string_view first, std::string_view second) const {
    const auto& words = lines_.words();
    if (begins(first) && (second.empty() || (words.size() > 1 && equal(words[1], second)))) return;
    const std::string due = std::string(first) + (second.empty() ? "" : " ") + std::string(second);
    lines_.fail("it begins with " + TextLines::quoted(words[0]) + " where \"" + due +
                "\" is expected; the file is damaged or not an STL file");
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
      point = merger_.add({lines_.coordinate(1, "x"), lines_.coordinate(2, "y"), lines_.coordinate(3, "z")});
    }
    next("endloop", "");
    next("endfacet", "");
    surface_.triangles.push_back(triangle);
  }

  TextLines lines_;
  Surface surface_;
  PointMerger merger_;
};

/// Binary files may begin with "solid" as well, so the length decides, and where that is wrong too
/// (truncated), a zero byte, which no text has.
bool is_binary(std::string_view content) {
  if (content.size() < bytes_before_triangles) return content.find('\0') != std::string_view::npos;
  const std::size_t count = number_at(content, bytes_before_count);
  return content.size() == bytes_before_triangles + count * bytes_of_triangle ||
         content.find('\0') != std::string_view::npos;
}

}  // namespace

Surface parse_stl(const std::string& name, std::string_view content) {
  if (content.empty()) throw InputError(name + " is empty; give a surface");
  if (!is_binary(content)) return AsciiReader(name, content).read();
  if (content.size() < bytes_before_triangles)
    throw InputError(name + " has " + pluralize(content.size(), "byte") +
                     ", and a binary STL file at least 84; it is truncated or not an STL file");
  return parse_binary(name, content);
}

}  // namespace mssim
