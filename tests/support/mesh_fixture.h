#pragma once

#include <stdlib.h>

#include "mesh/meshing.h"
#include "tests/support/files_fixture.h"
#include "tests/support/testing.h"
#include "text/error.h"

namespace mssim {

/// A test whose mesh cache lies in a folder of its own, and which may change the variables that find programs
/// and folders: they are put back.
class MeshTest : public TemporaryFolderTest {
 protected:
  MeshTest() { ::setenv("XDG_CACHE_HOME", (folder() / "cache").c_str(), 1); }
  std::filesystem::path cache() const { return folder() / "cache" / "mssim" / "meshes"; }

  /// Puts a program named tetgen that runs this shell script before all others.
  void install_tetgen(const std::string& script) const {
    const std::filesystem::path program = put("programs/tetgen", "#!/bin/sh\n" + script);
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    ::setenv("PATH", (program.parent_path().string() + ":" + ::getenv("PATH")).c_str(), 1);
  }

 private:
  KeptVariables kept_{"HOME", "PATH", "TMPDIR", "XDG_CACHE_HOME"};
};

/// A cube with sides of 1 m and one cell, its lowest corner at `corner`.
inline Surface unit_cube(const Vec3d& corner = {}) {
  Surface cube = surface_of(BoxShape{{1, 1, 1}, {1, 1, 1}});
  for (Vec3d& point : cube.points) point += corner + Vec3d{0.5, 0.5, 0.5};
  return cube;
}

/// Both surfaces as one.
inline Surface both(Surface first, const Surface& second) {
  const auto offset = static_cast<std::uint32_t>(first.points.size());
  first.points.insert(first.points.end(), second.points.begin(), second.points.end());
  for (const auto& [a, b, c] : second.triangles)
    first.triangles.push_back({a + offset, b + offset, c + offset});
  return first;
}

}  // namespace mssim
