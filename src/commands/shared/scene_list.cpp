#include "commands/shared/scene_list.h"

#include <algorithm>
#include <cstddef>

#include "scene/scene_file.h"

namespace mssim {
namespace {

/// Length of the name or file that the text begins with. The file of a backend is known by what a scene's is:
/// a path that exists.
std::size_t length_of_first(std::string_view text) {
  const std::size_t shortest = std::min(text.find(','), text.size());
  for (std::size_t end = text.size(); end != std::string_view::npos && end > shortest;
       end = text.rfind(',', end - 1))
    if (is_scene(text.substr(0, end))) return end;
  return shortest;
}

}  // namespace

std::vector<std::string> names_and_files_in(std::string_view argument) {
  std::vector<std::string> names;
  while (!argument.empty()) {
    const std::size_t length = length_of_first(argument);
    if (length > 0) names.emplace_back(argument.substr(0, length));
    argument.remove_prefix(std::min(length + 1, argument.size()));
  }
  return names;
}

}  // namespace mssim
