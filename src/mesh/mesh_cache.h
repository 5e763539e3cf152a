#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "mesh/tet_mesh.h"

namespace mssim {

/// Meshes that were made before, one file each, in mssim/meshes in the user's cache folder ($XDG_CACHE_HOME
/// or ~/.cache). A file's name is INPUT-PROGRAM: the hash of what TetGen was given and that of the TetGen
/// that made it. The cache only saves time: an entry that is missing, damaged or cannot be written is no
/// error, and several processes may use it at once.
class MeshCache {
 public:
  MeshCache();

  /// The mesh that this TetGen made of this input.
  std::optional<TetMesh> find(std::uint64_t input, std::uint64_t program) const;

  /// The newest mesh that any TetGen made of this input: for machines without TetGen.
  std::optional<TetMesh> find_of_any_program(std::uint64_t input) const;

  /// Keeps a mesh; the file appears as a whole or not at all.
  void store(std::uint64_t input, std::uint64_t program, const TetMesh& mesh) const;

 private:
  std::filesystem::path folder_;  ///< empty when the user has neither variable nor home
};

}  // namespace mssim
