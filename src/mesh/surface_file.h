#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "geometry/surface.h"

namespace mssim {

/// Reads a surface from the text of a Wavefront OBJ file: its v and f lines. A backslash at a line's end
/// continues it. Polygons are cut into triangles: a fan from their first corner if it covers them, else
/// (concave ones) ears in their plane; a bent quadrangle whose edges pass each other is cut along any
/// diagonal. All other lines (texture, normals, groups, materials, curves) are ignored. Points at one
/// location become one. Throws InputError that names file, line and value, also for a polygon that crosses
/// itself.
Surface parse_obj(const std::string& name, std::string_view text);

/// Reads a surface from the content of an STL file, ASCII or binary; up to 49 bytes, too few for a triangle,
/// may follow a binary one. Points at one location become one. Normals are ignored: the order of the corners
/// determines the outside. Throws InputError that names file, line or byte, and value.
Surface parse_stl(const std::string& name, std::string_view content);

/// The surface in a file.
struct FileSurface {
  Surface surface;   ///< in the file's unit
  std::string note;  ///< number of merged corners, in a sentence; or empty
};

/// Reads a surface from a file that ends in .obj or .stl (in any case), and merges corners that differ in
/// their last digits (join_corners). It is not validated (validate_surface).
FileSurface read_surface(const std::filesystem::path& file);

}  // namespace mssim
