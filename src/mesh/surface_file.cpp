#include "mesh/surface_file.h"

#include "geometry/openings.h"
#include "mesh/text_lines.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {

FileSurface read_surface(const std::filesystem::path& file) {
  const std::string extension = to_lower(file.extension().string());
  FileSurface read;
  if (extension == ".obj")
    read.surface = parse_obj(file.string(), read_text(file));
  else if (extension == ".stl")
    read.surface = parse_stl(file.string(), read_text(file));
  else
    throw InputError(file.string() +
                     " ends in neither .obj nor .stl; give a surface in one of those formats");
  if (const std::size_t merged = join_corners(read.surface); merged > 0)
    read.note = file.string() + ": " + pluralize(merged, "point") + (merged == 1 ? " was" : " were") +
                " merged with others within a hundred-thousandth of its size, so that its triangles join";
  return read;
}

}  // namespace mssim
