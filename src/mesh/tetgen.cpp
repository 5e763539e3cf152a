#include "mesh/tetgen.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "geometry/geometry.h"
#include "geometry/surface.h"
#include "platform/files.h"
#include "platform/machine.h"
#include "platform/process.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// TetGen's own shared libraries, which hold most of it in Debian's package. Runs the dynamic loader in the
/// way of ldd: it prints what it would load, one "NAME => FILE (ADDRESS)" per line, and runs nothing.
std::vector<fs::path> libraries_of(const fs::path& executable) {
  constexpr unsigned cpu_s = 5, elapsed_s = 60;
  const ChildResult listing = run({executable, {}, {"LD_TRACE_LOADED_OBJECTS=1"}, "/", cpu_s, elapsed_s});
  std::vector<fs::path> libraries;
  std::istringstream lines(listing.output);
  constexpr std::string_view before = " => ", after = " (";
  for (std::string line; std::getline(lines, line);) {
    const std::size_t name = line.find_first_not_of(" \t"), arrow = line.find(before),
                      end = line.rfind(after);
    if (name == std::string::npos || arrow == std::string::npos || end == std::string::npos) continue;
    // The name of a folder may contain spaces.
    const std::size_t file = arrow + before.size();
    if (line.compare(name, 6, "libtet") == 0 && file < end)
      libraries.emplace_back(line.substr(file, end - file));
  }
  return libraries;
}

/// TetGen prints its version only with its help, after which Debian's crashes. The text of that help is a
/// string in the program that begins "Version".
std::optional<std::string> version_in(std::string_view program) {
  using namespace std::string_view_literals;
  constexpr auto before = "\0Version "sv;
  for (std::size_t at = 0; (at = program.find(before, at)) != std::string_view::npos;) {
    at += before.size();
    const std::string_view rest = program.substr(at);
    const std::string_view number = rest.substr(0, rest.find_first_not_of("0123456789."));
    if (!number.empty()) return std::string(number);
  }
  return std::nullopt;
}

/// The count at the start of a file. A line has at least one byte, so a count beyond the file's length is
/// refused before memory is allocated.
std::size_t count_of(const TextLines& lines, const std::string& things) {
  const std::int64_t count = lines.integer(0, "the number of " + things);
  if (count <= 0) lines.fail("the number of {} is {}; a mesh has at least one", things, count);
  const auto smallest_line = static_cast<std::int64_t>(sizeof "0 0 0 0" - 1);
  if (count > static_cast<std::int64_t>(lines.bytes()) / smallest_line + 1)
    lines.fail(
        "the number of {} is {}, more than a file of {} bytes can hold; it is truncated or the number is "
        "wrong",
        things, count, lines.bytes());
  if (count > std::numeric_limits<std::uint32_t>::max())
    lines.fail("the number of {} is {}; at most 4294967295 are allowed", things, count);
  return static_cast<std::size_t>(count);
}

/// An optional number in a file's first line.
std::int64_t optional_integer(const TextLines& lines, std::size_t index, std::string_view what,
                              std::int64_t absent) {
  if (index >= lines.words().size()) return absent;
  const std::int64_t value = lines.integer(index, what);
  constexpr std::int64_t most = 1000;
  if (value < 0 || value > most) lines.fail("{} is {}; give one from 0 to {}", what, value, most);
  return value;
}

void require_words(const TextLines& lines, std::int64_t expected) {
  if (static_cast<std::int64_t>(lines.words().size()) != expected)
    lines.fail("there are {} numbers; the file's first line promises {} on each line", lines.words().size(),
               expected);
}

void require_end(TextLines& lines, const std::string& things, std::size_t count) {
  if (lines.next())
    lines.fail(
        "the file continues after the {} {} that its first line promises; correct the number or remove the "
        "rest",
        count, things);
}

/// Reads the nodes, and the line of each. Returns the number of the first one, 0 or 1.
std::int64_t read_nodes(TextLines& lines, std::vector<Vec3d>& nodes, std::vector<std::size_t>& at_line) {
  lines.require_next("the number of nodes");
  const std::size_t count = count_of(lines, "nodes");
  if (const std::int64_t dimension = optional_integer(lines, 1, "the dimension", 3); dimension != 3)
    lines.fail("the dimension is {}; give nodes with x, y and z", dimension);
  const std::int64_t attributes = optional_integer(lines, 2, "the number of attributes", 0);
  const std::int64_t markers = optional_integer(lines, 3, "the number of boundary markers", 0);

  std::int64_t first = 0;
  nodes.reserve(count);
  at_line.reserve(count);
  for (std::size_t n = 0; n < count; ++n) {
    lines.require_next(fmt::format("node {} of {}", n + 1, count));
    require_words(lines, 4 + attributes + markers);
    const std::int64_t index = lines.integer(0, "the number of a node");
    if (n == 0) first = index;
    if (first != 0 && first != 1)
      lines.fail("the first node has the number {}; number nodes from 0 or 1", first);
    if (index != first + static_cast<std::int64_t>(n))
      lines.fail("node {} is where node {} is expected; number nodes in ascending order", index,
                 first + static_cast<std::int64_t>(n));
    nodes.push_back(lines.point());
    at_line.push_back(lines.line());
  }
  require_end(lines, "nodes", count);
  return first;
}

/// Reads tetrahedra between `nodes` nodes.
void read_tetrahedra(TextLines& lines, std::vector<Tetrahedron>& tetrahedra,
                     std::vector<std::size_t>& at_line, std::size_t nodes, std::int64_t first_node) {
  lines.require_next("the number of tetrahedra");
  const std::size_t count = count_of(lines, "tetrahedra");
  if (const std::int64_t corners = optional_integer(lines, 1, "the number of nodes of a tetrahedron", 4);
      corners != 4)
    lines.fail("the number of nodes of a tetrahedron is {}; give linear tetrahedra (4 nodes)", corners);
  const std::int64_t attributes = optional_integer(lines, 2, "the number of attributes", 0);

  tetrahedra.reserve(count);
  at_line.reserve(count);
  for (std::size_t t = 0; t < count; ++t) {
    lines.require_next(fmt::format("tetrahedron {} of {}", t + 1, count));
    require_words(lines, 5 + attributes);
    // TetGen leaves gaps in these numbers where it dropped tetrahedra; nothing refers to them.
    lines.integer(0, "the number of a tetrahedron");
    Tetrahedron tetrahedron{};
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const std::int64_t node = lines.integer(1 + corner, "a node of a tetrahedron");
      const std::int64_t end = first_node + static_cast<std::int64_t>(nodes);
      if (node < first_node || node >= end)
        lines.fail("node {} is not one of the nodes {} to {}; give .node and .ele files of one mesh", node,
                   first_node, end - 1);
      tetrahedron[corner] = static_cast<std::uint32_t>(node - first_node);
    }
    tetrahedra.push_back(tetrahedron);
    at_line.push_back(lines.line());
  }
  require_end(lines, "tetrahedra", count);
}

/// The mesh of the largest committed body takes 0.2 s; a run of this length does not end.
constexpr unsigned cpu_seconds = 300;
constexpr unsigned elapsed_seconds = 4 * cpu_seconds;  // other programs may use the CPUs too

constexpr std::uint64_t bytes_a_point = 3800;

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out)
    throw std::runtime_error(
        fmt::format("cannot write {}; make room in the folder of temporary files", file.string()));
}

std::string corners_of(const Surface& surface, std::size_t triangle) {
  const auto& [a, b, c] = surface.triangles[triangle];
  return place(surface.points[a]) + ", " + place(surface.points[b]) + ", " + place(surface.points[c]);
}

/// One run of TetGen on files of its folder.
class Run {
 public:
  Run(const TetgenProgram& program, const Surface& surface, const std::vector<Vec3d>& interior)
      : program_(program), surface_(surface), has_interior_(!interior.empty()) {
    write_text(folder_.path() / "body.smesh", smesh_text(surface));
    // TetGen's switch i reads the points from a file of this name.
    if (has_interior_) write_text(folder_.path() / "body.a.node", node_text(interior));
  }

  TetMesh mesh(const std::string& switches) const {
    const ChildResult ended = tetgen(switches + (has_interior_ ? "i" : ""));
    const fs::path nodes = folder_.path() / "body.1.node";
    const fs::path tetrahedra = folder_.path() / "body.1.ele";
    if (ended.signal != 0 || ended.exit_code != 0 || !fs::exists(nodes) || !fs::exists(tetrahedra))
      fail(ended);
    const std::string node_file = read_text(nodes);
    const std::string ele_file = read_text(tetrahedra);
    TetMesh mesh;
    try {
      mesh = parse_tetgen_files({"TetGen's .node file", node_file}, {"TetGen's .ele file", ele_file});
    } catch (const InputError& error) {
      throw InputError("the output of {} cannot be used: {}", program_.executable.string(), error.what());
    }
    require_volume(mesh);
    return mesh;
  }

 private:
  ChildResult tetgen(const std::string& switches) const {
    return run({program_.executable,
                {switches, "body.smesh"},
                {},
                folder_.path(),
                cpu_seconds,
                elapsed_seconds,
                memory_bytes_});
  }

  [[noreturn]] void fail(const ChildResult& ended) const {
    constexpr std::string_view remedy =
        "; give a surface of fewer triangles, a thicker body or a larger largest volume";
    if (ended.out_of_time)
      throw InputError("TetGen was stopped after {} s of CPU time or {} s in all{}", cpu_seconds,
                       elapsed_seconds, remedy);
    if (ended.signal == SIGKILL && !ended.out_of_memory)
      throw InputError("TetGen was stopped by signal 9, as the system does when memory runs out" +
                       std::string(remedy));
    if (ended.out_of_memory)
      throw InputError("TetGen needs more memory than the {} GB that were available{}",
                       shown(std::round(1e-8 * static_cast<double>(memory_bytes_)) / 10), remedy);
    const std::string search = tetgen("-d").output;
    if (const auto crossing = crossing_triangles(search)) throw InputError(*crossing);
    std::string how = "without writing a mesh";
    if (ended.signal != 0)
      how = fmt::format("with signal {}", ended.signal);
    else if (ended.exit_code != 0)
      how = fmt::format("with exit code {}", ended.exit_code);
    const std::string ending = "TetGen " + program_.version + " ended " + how + last_words(ended.output);
    if (search.find("No faces are intersecting") == std::string::npos)
      throw InputError(ending + " and does not report whether triangles cross; make sure that " +
                       program_.executable.string() + " is TetGen, or change the surface");
    throw InputError(ending +
                     " though it finds no triangles that cross; change the surface or the points inside a "
                     "little");
  }

  static std::string last_words(const std::string& output) {
    std::istringstream lines(output);
    std::string last;
    for (std::string line; std::getline(lines, line);)
      if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
    return last.empty() ? last : fmt::format(" after writing \"{}\"", last);
  }

  /// Finds the crossing triangles in TetGen's output with -d: "Facet #3 intersects facet #17", counted from
  /// 1. (Without -d it just crashes on them.)
  std::optional<std::string> crossing_triangles(const std::string& search) const {
    std::istringstream lines(search);
    for (std::string line; std::getline(lines, line);) {
      std::size_t first = 0;
      std::size_t second = 0;
      if (std::sscanf(line.c_str(), " Facet #%zu intersects facet #%zu", &first, &second) != 2) continue;
      const std::size_t count = surface_.triangles.size();
      if (first < 1 || second < 1 || first > count || second > count) continue;
      return "the surface crosses or touches itself: the triangle " + corners_of(surface_, first - 1) +
             " meets the triangle " + corners_of(surface_, second - 1) +
             "; move them apart or join their parts";
    }
    return std::nullopt;
  }

  /// TetGen fills everything inside the outermost triangles, including holes and inner parts, and joins
  /// triangles that are within about 0.1 degrees of one plane.
  void require_volume(const TetMesh& mesh) const {
    const double enclosed = volume_of(surface_), filled = volume_of(mesh);
    const double difference = std::abs(filled - enclosed);
    constexpr double rounding = 1e-6, of_joined = 1e-3;
    if (difference <= rounding * enclosed) return;
    const std::vector<Surface> parts = closed_parts(surface_);
    const bool has_inner_part = parts.size() > 1 && std::ranges::any_of(parts, [&](const Surface& part) {
                                  return difference > 0.5 * volume_of(part);
                                });
    if (!has_inner_part && difference <= of_joined * enclosed) return;
    throw InputError(
        "the surface encloses {} m^3 but TetGen filled {} m^3: {}", shown(enclosed), shown(filled),
        has_inner_part
            ? "a closed part lies inside another one; remove the inner part, since bodies are solid"
            : "it joined triangles that are almost in one plane; put them into one plane, or make "
              "the body thicker");
  }

  const TetgenProgram& program_;
  const Surface& surface_;
  bool has_interior_;
  std::uint64_t memory_bytes_ = available_memory();
  TemporaryFolder folder_;
};

}  // namespace

std::optional<TetgenProgram> find_tetgen() {
  // An archive of mssim brings its own, which meshes a body alike on every machine.
  std::optional<fs::path> executable = find_program(helper_program("tetgen"));
  if (!executable) executable = find_program("tetgen");
  if (!executable) return std::nullopt;
  TetgenProgram program{*executable, "unknown", 0};
  std::vector<fs::path> files = libraries_of(*executable);
  files.insert(files.begin(), *executable);
  std::string hashes;
  for (const fs::path& file : files) {
    const std::string bytes = read_text(file);
    hashes += to_hex(fnv1a_64(bytes));
    if (const auto version = version_in(bytes)) program.version = *version;
  }
  program.fnv1a_64 = fnv1a_64(hashes);
  return program;
}

TetMesh parse_tetgen_files(TextLines node_file, TextLines ele_file) {
  TetMesh mesh;
  std::vector<std::size_t> line_of_node, line_of_tetrahedron;
  const std::int64_t first = read_nodes(node_file, mesh.nodes, line_of_node);
  read_tetrahedra(ele_file, mesh.tetrahedra, line_of_tetrahedron, mesh.nodes.size(), first);
  turn_if_mirrored(mesh);
  if (const auto defect = find_defect(mesh)) {
    if (defect->of == MeshDefect::node) node_file.fail_at(line_of_node[defect->index], defect->what);
    ele_file.fail_at(line_of_tetrahedron[defect->index], defect->what);
  }
  return mesh;
}

TetMesh read_tetgen_files(const std::filesystem::path& node_file, const std::filesystem::path& ele_file) {
  const std::string nodes = read_text(node_file);
  const std::string tetrahedra = read_text(ele_file);
  return parse_tetgen_files({node_file.string(), nodes}, {ele_file.string(), tetrahedra});
}

std::string node_text(const std::vector<Vec3d>& nodes) {
  std::string text = fmt::format("{} 3 0 0\n", nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n)
    text += fmt::format("{} {} {} {}\n", n, decimal(nodes[n].x), decimal(nodes[n].y), decimal(nodes[n].z));
  return text;
}

std::string ele_text(const std::vector<Tetrahedron>& tetrahedra) {
  std::string text = fmt::format("{} 4 0\n", tetrahedra.size());
  for (std::size_t t = 0; t < tetrahedra.size(); ++t)
    text += fmt::format("{} {}\n", t, fmt::join(tetrahedra[t], " "));
  return text;
}

std::string smesh_text(const Surface& surface) {
  std::string text = node_text(surface.points);
  text += fmt::format("{} 0\n", surface.triangles.size());
  for (const auto& triangle : surface.triangles) text += fmt::format("3 {}\n", fmt::join(triangle, " "));
  return text + "0\n0\n";  // no holes, no regions
}

void require_meshable(std::uint64_t points, std::string_view remedy) {
  if (points > most_meshable_points)
    throw InputError(
        "its mesh would have {} points or more, for which TetGen needs more than its limit of {} s of CPU "
        "time; make it of at most {}, {}",
        points, cpu_seconds, most_meshable_points, remedy);
}

void require_meshing_memory(std::uint64_t points) {
  if (const auto shortage = memory_shortage(points * bytes_a_point))
    throw InputError("TetGen makes its mesh of " + std::to_string(points) + " points or more, which " +
                     *shortage + "; close other programs, or give fewer cells, triangles or points");
}

TetMesh run_tetgen(const TetgenProgram& program, const Surface& surface, const std::vector<Vec3d>& interior,
                   const std::string& switches) {
  return Run(program, surface, interior).mesh(switches);
}

}  // namespace mssim
