#include "mesh/tetgen_files.h"

#include <algorithm>
#include <limits>

#include "geometry/geometry.h"
#include "mesh/mesh_defect.h"
#include "mesh/text_lines.h"

namespace mssim {
namespace {

/// The count at the start of a file. A file of so many bytes cannot hold more lines than a byte each: a count
/// beyond is refused before memory is taken for it.
std::size_t count_of(const TextLines& lines, const std::string& things) {
  const std::int64_t count = lines.integer(0, "the number of " + things);
  if (count <= 0)
    lines.fail("the number of " + things + " is " + std::to_string(count) + "; a mesh has at least one");
  const auto smallest_line = static_cast<std::int64_t>(sizeof "0 0 0 0" - 1);
  if (count > static_cast<std::int64_t>(lines.bytes()) / smallest_line + 1)
    lines.fail("the number of " + things + " is " + std::to_string(count) + ", more than a file of " +
               std::to_string(lines.bytes()) + " bytes can hold; it is truncated or the number is wrong");
  if (count > std::numeric_limits<std::uint32_t>::max())
    lines.fail("the number of " + things + " is " + std::to_string(count) +
               "; at most 4294967295 are allowed");
  return static_cast<std::size_t>(count);
}

/// A number in a file's first line that may be left out.
std::int64_t optional_integer(const TextLines& lines, std::size_t index, std::string_view what,
                              std::int64_t absent) {
  if (index >= lines.words().size()) return absent;
  const std::int64_t value = lines.integer(index, what);
  constexpr std::int64_t most = 1000;
  if (value < 0 || value > most)
    lines.fail(std::string(what) + " is " + std::to_string(value) + "; give one from 0 to " +
               std::to_string(most));
  return value;
}

void require_words(const TextLines& lines, std::int64_t expected) {
  if (static_cast<std::int64_t>(lines.words().size()) != expected)
    lines.fail("there are " + std::to_string(lines.words().size()) +
               " numbers; the file's first line promises " + std::to_string(expected) + " on each line");
}

void require_end(TextLines& lines, const std::string& things, std::size_t count) {
  if (lines.next())
    lines.fail("the file continues after the " + std::to_string(count) + " " + things +
               " that its first line promises; correct the number or remove the rest");
}

/// What both files give for each thing: where it stands.
struct Lines {
  std::vector<std::size_t> node, tetrahedron;
};

class NodeFile {
 public:
  explicit NodeFile(const NamedText& file) : lines_(file.name, file.text) {}

  /// Returns the number that the first node has, 0 or 1.
  std::int64_t read(std::vector<Vec3d>& nodes, std::vector<std::size_t>& at_line) {
    lines_.require_next("the number of nodes");
    const std::size_t count = count_of(lines_, "nodes");
    if (const std::int64_t dimension = optional_integer(lines_, 1, "the dimension", 3); dimension != 3)
      lines_.fail("the dimension is " + std::to_string(dimension) + "; give nodes with x, y and z");
    const std::int64_t attributes = optional_integer(lines_, 2, "the number of attributes", 0);
    const std::int64_t markers = optional_integer(lines_, 3, "the number of boundary markers", 0);

    std::int64_t first = 0;
    nodes.reserve(count);
    at_line.reserve(count);
    for (std::size_t n = 0; n < count; ++n) {
      lines_.require_next("node " + std::to_string(n + 1) + " of " + std::to_string(count));
      require_words(lines_, 4 + attributes + markers);
      const std::int64_t index = lines_.integer(0, "the number of a node");
      if (n == 0) first = index;
      if (first != 0 && first != 1)
        lines_.fail("the first node has the number " + std::to_string(first) + "; number nodes from 0 or 1");
      if (index != first + static_cast<std::int64_t>(n))
        lines_.fail("node " + std::to_string(index) + " is where node " +
                    std::to_string(first + static_cast<std::int64_t>(n)) +
                    " is expected; number nodes in ascending order");
      nodes.push_back({lines_.coordinate(1, "x"), lines_.coordinate(2, "y"), lines_.coordinate(3, "z")});
      at_line.push_back(lines_.line());
    }
    require_end(lines_, "nodes", count);
    return first;
  }

  const TextLines& lines() const { return lines_; }

 private:
  TextLines lines_;
};

class EleFile {
 public:
  explicit EleFile(const NamedText& file) : lines_(file.name, file.text) {}

  void read(std::vector<Tetrahedron>& tetrahedra, std::vector<std::size_t>& at_line, std::size_t nodes,
            std::int64_t first_node) {
    lines_.require_next("the number of tetrahedra");
    const std::size_t count = count_of(lines_, "tetrahedra");
    if (const std::int64_t corners = optional_integer(lines_, 1, "the number of nodes of a tetrahedron", 4);
        corners != 4)
      lines_.fail("the number of nodes of a tetrahedron is " + std::to_string(corners) +
                  "; give linear tetrahedra, of 4 nodes");
    const std::int64_t attributes = optional_integer(lines_, 2, "the number of attributes", 0);

    tetrahedra.reserve(count);
    at_line.reserve(count);
    for (std::size_t t = 0; t < count; ++t) {
      lines_.require_next("tetrahedron " + std::to_string(t + 1) + " of " + std::to_string(count));
      require_words(lines_, 5 + attributes);
      // TetGen leaves gaps in these numbers where it has dropped tetrahedra, and nothing refers to them.
      lines_.integer(0, "the number of a tetrahedron");
      Tetrahedron tetrahedron{};
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const std::int64_t node = lines_.integer(1 + corner, "a node of a tetrahedron");
        const std::int64_t end = first_node + static_cast<std::int64_t>(nodes);
        if (node < first_node || node >= end)
          lines_.fail("node " + std::to_string(node) + " is not one of the nodes " +
                      std::to_string(first_node) + " to " + std::to_string(end - 1) +
                      "; give .node and .ele files of one mesh");
        tetrahedron[corner] = static_cast<std::uint32_t>(node - first_node);
      }
      tetrahedra.push_back(tetrahedron);
      at_line.push_back(lines_.line());
    }
    require_end(lines_, "tetrahedra", count);
  }

  const TextLines& lines() const { return lines_; }

 private:
  TextLines lines_;
};

void append(std::string& text, std::uint64_t value) { text += ' ' + std::to_string(value); }

void append(std::string& text, const Vec3d& point) {
  for (const double x : {point.x, point.y, point.z}) text += ' ' + decimal(x);
}

}  // namespace

TetMesh parse_tetgen_files(const NamedText& node_file, const NamedText& ele_file) {
  TetMesh mesh;
  Lines at_line;
  NodeFile node(node_file);
  EleFile ele(ele_file);
  const std::int64_t first = node.read(mesh.nodes, at_line.node);
  ele.read(mesh.tetrahedra, at_line.tetrahedron, mesh.nodes.size(), first);
  turn_if_mirrored(mesh);
  if (const auto defect = find_defect(mesh)) {
    if (defect->of == MeshDefect::node) node.lines().fail_at(at_line.node[defect->index], defect->what);
    ele.lines().fail_at(at_line.tetrahedron[defect->index], defect->what);
  }
  return mesh;
}

TetMesh read_tetgen_files(const std::filesystem::path& node_file, const std::filesystem::path& ele_file) {
  const std::string nodes = read_text(node_file);
  const std::string tetrahedra = read_text(ele_file);
  return parse_tetgen_files({node_file.string(), nodes}, {ele_file.string(), tetrahedra});
}

std::string node_text(const std::vector<Vec3d>& nodes) {
  std::string text = std::to_string(nodes.size()) + " 3 0 0\n";
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    text += std::to_string(n);
    append(text, nodes[n]);
    text += '\n';
  }
  return text;
}

std::string ele_text(const std::vector<Tetrahedron>& tetrahedra) {
  std::string text = std::to_string(tetrahedra.size()) + " 4 0\n";
  for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
    text += std::to_string(t);
    for (const std::uint32_t node : tetrahedra[t]) append(text, node);
    text += '\n';
  }
  return text;
}

std::string smesh_text(const Surface& surface) {
  std::string text = node_text(surface.points);
  text += std::to_string(surface.triangles.size()) + " 0\n";
  for (const auto& triangle : surface.triangles) {
    text += '3';
    for (const std::uint32_t point : triangle) append(text, point);
    text += '\n';
  }
  return text + "0\n0\n";  // no holes, no regions
}

}  // namespace mssim
