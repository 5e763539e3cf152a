#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "geometry/surface.h"

namespace mssim {

/// Reads a surface from the text of a Wavefront OBJ file: its v and f lines. Polygons are cut into triangles
/// fanning out from their first corner; all other lines (texture, normals, groups, materials, curves) are
/// left out. Points at one place become one. Throws InputError that names file, line and value.
Surface parse_obj(const std::string& name, std::string_view text);

/// Reads a surface from the content of an STL file, ASCII or binary. Points at one place become one; normals
/// are left out, the order of the corners says where outside is. Throws InputError that names file, line or
/// byte, and value.
Surface parse_stl(const std::string& name, std::string_view content);

/// Reads a surface from a file that ends in .obj or .stl (in any case). It is not validated
/// (validate_surface).
Surface read_surface(const std::filesystem::path& file);

}  // namespace mssim
