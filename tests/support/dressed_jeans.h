#pragma once

#include "application/prepared_scene.h"
#include "backends/backends.h"
#include "garment/fitting/fitting.h"
#include "garment/stepping/dressing_backend.h"
#include "integrators/all_integrators.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"
#include "tests/support/files_fixture.h"
#include "tests/support/garment_system.h"
#include "tests/support/testing.h"

namespace mssim {

/// A garment scene that may be changed before it is dressed.
struct DressingCase {
  SceneSpec spec;
  System system;
  std::shared_ptr<const MeasuredBody> body;

  explicit DressingCase(const std::string& scene) : DressingCase(find_scene(scene)) {}
  explicit DressingCase(SceneSpec scene) : spec(std::move(scene)) {
    BuiltScene built = build_scene(spec);
    system = std::move(built.system);
    body = std::move(built.body);
  }

  Garment& garment() { return garment_in(system); }
  double dt_s() const { return spec.dt_s.value(); }
};

struct Dressed {
  DressingResult result;
  Fit fit;
  std::vector<std::string> found;  ///< out of bounds
};

/// Dresses it by a backend and measures the fit on the body's own mesh.
inline Dressed dressed(const DressingCase& of, const SettlingRule& rule = {},
                       std::string_view backend_name = "serial") {
  const auto backend = make_dressing_backend(*find_backend(backend_name), of.system,
                                             *find_integrator("semi-euler"), of.dt_s(), {2, {}});
  Dressed dressed;
  dressed.result = dress(*backend, of.system, of.dt_s(), rule, always);
  dressed.fit = fit_of(of.system, dressed.result.state.position, fit_body(of.body));
  dressed.found = misfits(dressed.result, dressed.fit, {});
  return dressed;
}

}  // namespace mssim
