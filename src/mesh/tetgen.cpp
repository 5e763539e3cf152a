#include "mesh/tetgen.h"

#include <cmath>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "geometry/geometry.h"
#include "mesh/tetgen_files.h"
#include "mesh/text_lines.h"
#include "platform/files.h"
#include "platform/machine.h"
#include "platform/process.h"
#include "text/error.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// The mesh of the largest committed body takes 0.2 s; what takes this long never ends.
constexpr unsigned cpu_seconds = 300;
constexpr unsigned elapsed_seconds = 4 * cpu_seconds;  // where other programs want the processors, too

constexpr std::uint64_t bytes_a_point = 3800;

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out)
    throw std::runtime_error("cannot write " + file.string() +
                             "; make room in the folder of temporary files");
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
    // The name under which TetGen looks for the points of its switch i.
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
    TetMesh mesh = parsed(node_file, ele_file);
    require_volume(mesh);
    return mesh;
  }

 private:
  TetMesh parsed(const std::string& node_file, const std::string& ele_file) const {
    try {
      return parse_tetgen_files({"TetGen's .node file", node_file}, {"TetGen's .ele file", ele_file});
    } catch (const InputError& error) {
      throw InputError("the output of " + program_.executable.string() + " cannot be used: " + error.what());
    }
  }

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
      throw InputError("TetGen was stopped after " + std::to_string(cpu_seconds) +
                       " s of processor time or " + std::to_string(elapsed_seconds) + " s in all" +
                       std::string(remedy));
    if (ended.signal == SIGKILL && !ended.out_of_memory)
      throw InputError("TetGen was stopped by signal 9, as the system does where memory runs out" +
                       std::string(remedy));
    if (ended.out_of_memory)
      throw InputError("TetGen needs more memory than the " +
                       shown(std::round(1e-8 * static_cast<double>(memory_bytes_)) / 10) +
                       " GB that were available" + std::string(remedy));
    const std::string search = tetgen("-d").output;
    if (const auto crossing = crossing_triangles(search)) throw InputError(*crossing);
    std::string how = "without writing a mesh";
    if (ended.signal != 0)
      how = "with signal " + std::to_string(ended.signal);
    else if (ended.exit_code != 0)
      how = "with exit code " + std::to_string(ended.exit_code);
    const std::string ending = "TetGen " + program_.version + " ended " + how + last_words(ended.output);
    if (search.find("No faces are intersecting") == std::string::npos)
      throw InputError(ending + " and does not say whether triangles cross; make sure that " +
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
    return last.empty() ? last : " after writing \"" + last + "\"";
  }

  /// Which triangles cross, from what TetGen prints when it is asked with -d: "Facet #3 intersects facet
  /// #17", counted from 1. (A run that is to make a mesh just crashes on them.)
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

  /// TetGen fills what lies inside the outermost triangles, holes and parts within parts included.
  void require_volume(const TetMesh& mesh) const {
    const double enclosed = volume_of(surface_);
    const double filled = volume_of(mesh);
    constexpr double rounding = 1e-6;
    if (std::abs(filled - enclosed) > rounding * enclosed)
      throw InputError(
          "the surface encloses " + shown(enclosed) + " m^3 but TetGen filled " + shown(filled) +
          " m^3: a closed part lies inside another one; remove the inner part, since bodies are solid");
  }

  const TetgenProgram& program_;
  const Surface& surface_;
  bool has_interior_;
  std::uint64_t memory_bytes_ = available_memory();
  TemporaryFolder folder_;
};

}  // namespace

void require_meshable(std::uint64_t points, std::string_view remedy) {
  if (points > most_meshable_points)
    throw InputError("its mesh would have " + std::to_string(points) +
                     " points or more, with which TetGen takes longer than the " +
                     std::to_string(cpu_seconds) +
                     " s of processor time that it is given; make it of at most " +
                     std::to_string(most_meshable_points) + ", " + std::string(remedy));
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
