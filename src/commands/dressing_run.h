#pragma once

#include <string>

#include "backends/dressing/dressing_backend.h"
#include "commands/prepared_scene.h"

namespace mssim {

/// Dresses a garment scene by a backend that was made for it, prints how it went and how the garment fits,
/// and says on stderr what is out of bounds. Returns an ExitCode. Throws NotVerified when the simulation
/// blows up, naming the step, and Interrupted.
int run_dressing(const PreparedScene& scene, DressingBackend& backend, const std::string& backend_name);

}  // namespace mssim
