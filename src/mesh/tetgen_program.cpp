#include "mesh/tetgen_program.h"

#include <sstream>

#include "mesh/text_lines.h"
#include "platform/files.h"
#include "platform/process.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// TetGen's own shared libraries, which hold most of it in Debian's package. Asked of the dynamic loader the
/// way ldd does: it then prints what it would load, one "NAME => FILE (ADDRESS)" a line, and runs nothing.
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
    // The name of a folder may have spaces.
    const std::size_t file = arrow + before.size();
    if (line.compare(name, 6, "libtet") == 0 && file < end)
      libraries.emplace_back(line.substr(file, end - file));
  }
  return libraries;
}

/// TetGen prints its version only with its help, after which Debian's crashes; the text of that help stands
/// in the program as a string that begins "Version".
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

}  // namespace

std::optional<TetgenProgram> find_tetgen() {
  const std::optional<fs::path> executable = find_program("tetgen");
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

}  // namespace mssim
