#include "mesh/surface_file.h"

#include <algorithm>

#include "mesh/text_lines.h"
#include "text/input_error.h"

namespace mssim {

Surface read_surface(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (extension == ".obj") return parse_obj(file.string(), read_text(file));
  if (extension == ".stl") return parse_stl(file.string(), read_text(file));
  throw InputError(file.string() + " ends in neither .obj nor .stl; give a surface in one of those formats");
}

}  // namespace mssim
