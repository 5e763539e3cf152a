#include <algorithm>

#include "mesh/point_merger.h"
#include "mesh/surface_file.h"
#include "mesh/text_lines.h"
#include "text/number_in.h"

namespace mssim {
namespace {

class ObjReader {
 public:
  ObjReader(const std::string& name, std::string_view text) : lines_(name, text), merger_(surface_) {}

  Surface read() {
    while (lines_.next()) {
      const std::string_view keyword = lines_.words().front();
      if (keyword != "v" && keyword != "f") continue;
      if (lines_.words().back() == "\\")
        lines_.fail("the line continues after a backslash; join it with the next");
      if (keyword == "v")
        vertex();
      else
        face();
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

  void vertex() {
    vertices_.push_back({lines_.coordinate(1, "x"), lines_.coordinate(2, "y"), lines_.coordinate(3, "z")});
  }

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
        lines_.fail("the corner " + TextLines::quoted(word) +
                    " of a face cannot be read; write V, V/VT, V//VN or V/VT/VN");
      if (part == 0) vertex = *number;
      if (slash == rest.size()) break;
      rest.remove_prefix(slash + 1);
    }
    const auto latest = static_cast<std::int64_t>(vertices_.size());
    if (vertex < 0) vertex += latest + 1;
    if (vertex < 1)
      lines_.fail("the corner " + TextLines::quoted(word) +
                  " of a face names no vertex; they count from 1, or -1 for the latest");
    return vertex;
  }

  void face() {
    Face face{lines_.line(), {}};
    for (std::size_t i = 1; i < lines_.words().size(); ++i)
      face.vertices.push_back(corner(lines_.words()[i]));
    if (face.vertices.size() < 3)
      lines_.fail("the face has " + std::to_string(face.vertices.size()) + " corners; give three or more");
    faces_.push_back(std::move(face));
  }

  /// Faces may name vertices that come later, so they are looked up at the end.
  void add(const Face& face) {
    std::vector<std::uint32_t> points;
    for (const std::int64_t vertex : face.vertices) {
      if (vertex > static_cast<std::int64_t>(vertices_.size()))
        lines_.fail_at(face.line, "the face names vertex " + std::to_string(vertex) + " of " +
                                      std::to_string(vertices_.size()) +
                                      "; the file is truncated or the number wrong");
      points.push_back(merger_.add(vertices_[static_cast<std::size_t>(vertex - 1)]));
    }
    for (std::size_t i = 2; i < points.size(); ++i)
      surface_.triangles.push_back({points[0], points[i - 1], points[i]});
  }

  TextLines lines_;
  std::vector<Vec3d> vertices_;
  std::vector<Face> faces_;
  Surface surface_;
  PointMerger merger_;
};

}  // namespace

Surface parse_obj(const std::string& name, std::string_view text) { return ObjReader(name, text).read(); }

}  // namespace mssim
