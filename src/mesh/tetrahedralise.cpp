#include "mesh/tetrahedralise.h"

#include "mesh/mesh_cache.h"
#include "mesh/tetgen.h"
#include "mesh/tetgen_files.h"
#include "mesh/tetgen_program.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {

TetMesh tetrahedralise(const Surface& surface, const std::vector<Vec3d>& interior,
                       const std::string& switches, std::uint64_t added_points) {
  const std::uint64_t input = fnv1a_64(switches + '\n' + smesh_text(surface) + node_text(interior));
  const MeshCache cache;
  const auto program = find_tetgen();
  if (!program) {
    if (auto mesh = cache.find_of_any_program(input)) return *mesh;
    throw MissingProgram(
        "the program tetgen, which makes the meshes of bodies, is not in PATH; install Debian's package "
        "tetgen");
  }
  if (auto mesh = cache.find(input, program->fnv1a_64)) return *mesh;
  require_meshing_memory(surface.points.size() + interior.size() + added_points);
  TetMesh mesh = run_tetgen(*program, surface, interior, switches);
  cache.store(input, program->fnv1a_64, mesh);
  return mesh;
}

}  // namespace mssim
