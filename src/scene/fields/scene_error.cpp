#include "scene/fields/scene_error.h"

#include "text/printable.h"

namespace mssim {

void refuse(const std::filesystem::path& file, std::string_view pointer, const std::string& problem) {
  throw SceneError(printable(file.string(), 1000) + ": " + printable(pointer, 200) + ' ' + problem);
}

}  // namespace mssim
