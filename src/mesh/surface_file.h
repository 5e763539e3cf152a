#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "geometry/surface.h"

namespace mssim {

/// Reads a surface from the text of a Wavefront OBJ file: its v and f lines. A backslash at a line's end
/// continues it. Polygons are cut into triangles fanning out from their first corner, or, where that does not
/// cover them (concave ones), into ears in their plane; of a bent quadrangle whose edges pass each other any
/// diagonal will do. All other lines (texture, normals, groups, materials, curves) are left out. Points at
/// one place become one. Throws InputError that names file, line and value, also for a polygon that crosses
/// itself.
Surface parse_obj(const std::string& name, std::string_view text);

/// Reads a surface from the content of an STL file, ASCII or binary; up to 49 bytes may follow a binary one,
/// too few for a triangle. Points at one place become one; normals
/// are left out, the order of the corners says where outside is. Throws InputError that names file, line or
/// byte, and value.
Surface parse_stl(const std::string& name, std::string_view content);

/// A surface as a file has it.
struct FileSurface {
  Surface surface;   ///< in the file's unit
  std::string note;  ///< how many corners were merged, in a sentence; or empty
};

/// Reads a surface from a file that ends in .obj or .stl (in any case), and merges corners that differ in
/// their last digits (join_corners). It is not validated (validate_surface).
FileSurface read_surface(const std::filesystem::path& file);

}  // namespace mssim
