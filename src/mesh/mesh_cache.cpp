#include "mesh/mesh_cache.h"

#include <cstdlib>
#include <string>

#include "mesh/tetgen_files.h"
#include "mesh/text_lines.h"
#include "platform/files.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view extension = ".mesh";

fs::path cache_folder() {
  // The XDG base directory specification has a relative path ignored.
  const char* xdg = std::getenv("XDG_CACHE_HOME");
  if (xdg && *xdg == '/') return fs::path(xdg) / "mssim" / "meshes";
  const char* home = std::getenv("HOME");
  if (home && *home == '/') return fs::path(home) / ".cache" / "mssim" / "meshes";
  return {};
}

/// "mssim mesh 1 BYTES HASH": bytes of the .node text, hash of both texts.
std::string header_of(const std::string& nodes, const std::string& tetrahedra) {
  return "mssim mesh 1 " + std::to_string(nodes.size()) + ' ' + to_hex(fnv1a_64(nodes + tetrahedra)) + '\n';
}

/// The mesh, or nothing for a file that is not, or no longer, what was written.
std::optional<TetMesh> read_entry(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  try {
    const std::string text = read_text(file);
    const std::size_t header = text.find('\n') + 1;
    constexpr std::string_view begin = "mssim mesh 1 ";
    if (header == 0 || !text.starts_with(begin)) return std::nullopt;
    const std::size_t node_bytes = std::strtoull(text.c_str() + begin.size(), nullptr, 10);
    if (node_bytes > text.size() - header) return std::nullopt;
    const std::string nodes = text.substr(header, node_bytes);
    const std::string tetrahedra = text.substr(header + node_bytes);
    if (!text.starts_with(header_of(nodes, tetrahedra))) return std::nullopt;
    return parse_tetgen_files({file.string(), nodes}, {file.string(), tetrahedra});
  } catch (const InputError&) {
    return std::nullopt;
  }
}

std::string file_name(std::uint64_t input, std::uint64_t program) {
  return to_hex(input) + '-' + to_hex(program) + std::string(extension);
}

}  // namespace

MeshCache::MeshCache() : folder_(cache_folder()) {}

std::optional<TetMesh> MeshCache::find(std::uint64_t input, std::uint64_t program) const {
  if (folder_.empty()) return std::nullopt;
  return read_entry(folder_ / file_name(input, program));
}

std::optional<TetMesh> MeshCache::find_of_any_program(std::uint64_t input) const {
  if (folder_.empty()) return std::nullopt;
  std::optional<TetMesh> newest;
  fs::file_time_type newest_time = fs::file_time_type::min();
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(to_hex(input) + '-') || !name.ends_with(extension)) continue;
    std::error_code no_time;
    const fs::file_time_type time = entry->last_write_time(no_time);
    if (no_time || (newest && time <= newest_time)) continue;
    if (auto mesh = read_entry(entry->path())) {
      newest = std::move(mesh);
      newest_time = time;
    }
  }
  return newest;
}

void MeshCache::store(std::uint64_t input, std::uint64_t program, const TetMesh& mesh) const {
  if (folder_.empty()) return;
  std::error_code ignored;
  fs::create_directories(folder_, ignored);
  const std::string nodes = node_text(mesh.nodes);
  const std::string tetrahedra = ele_text(mesh.tetrahedra);
  const fs::path file = folder_ / file_name(input, program);
  try {
    write_file_atomically(file, header_of(nodes, tetrahedra) + nodes + tetrahedra);
  } catch (const WriteError&) {
    // The mesh is made anew next time; or another process is storing the same.
  }
}

}  // namespace mssim
