// A program that links mssim: steps a scene file with a backend, and says how far it is from the
// double-precision reference.
//   verify_scene SCENE.json [BACKEND]

#include <iostream>

#include "backends/backends.h"
#include "bench/verification/verification.h"
#include "integrators/all_integrators.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"

int main(int argc, char** argv) {
  using namespace mssim;
  try {
    if (argc < 2) throw UsageError("give a scene file");
    const BackendInfo* const info = find_backend(argc > 2 ? argv[2] : "openmp");
    if (info == nullptr) throw UsageError("there is no such backend");
    const SceneSpec spec = load_scene(argv[1]);
    const System system = build_system(spec);
    const Integrator& integrator = *find_integrator("semi-euler");
    const double dt_s = spec.dt_s.value_or(5e-5);
    const auto backend = make_backend(*info, system, integrator, dt_s, {.threads = 2});
    const Verification result = verify(*backend, system, run_reference(system, integrator, dt_s), dt_s);
    std::cout << spec.name << ' ' << info->name << ' ' << result.position_error << '\n';
    if (result.failure) throw Error(exit_not_verified, *result.failure);
  } catch (const Error& error) {
    std::cerr << "verify_scene: " << error.what() << '\n';
    return error.exit_code;
  }
}
