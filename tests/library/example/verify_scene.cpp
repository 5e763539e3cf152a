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
  try {
    if (argc < 2) throw mssim::UsageError("give a scene file");
    const mssim::BackendInfo* const info = mssim::find_backend(argc > 2 ? argv[2] : "openmp");
    if (info == nullptr) throw mssim::UsageError("there is no such backend");
    const mssim::SceneSpec spec = mssim::load_scene(argv[1]);
    const mssim::System system = mssim::build_system(spec);
    const mssim::Integrator& integrator = *mssim::find_integrator("semi-euler");
    const double dt_s = spec.dt_s.value_or(5e-5);
    const auto backend = mssim::make_backend(*info, system, integrator, dt_s, {.threads = 2});
    const mssim::Verification result =
        mssim::verify(*backend, system, mssim::run_reference(system, integrator, dt_s), dt_s);
    if (result.failure) throw mssim::Error(mssim::exit_not_verified, *result.failure);
    std::cout << spec.name << ' ' << info->name << ' ' << *result.position_error << '\n';
  } catch (const mssim::Error& error) {
    std::cerr << "verify_scene: " << error.what() << '\n';
    return error.exit_code;
  }
}
