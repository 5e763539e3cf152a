#pragma once

#include <string>

#include "commands/run/run_recorder.h"
#include "commands/shared/prepared_scene.h"
#include "commands/shared/stop_request.h"
#include "garment/fitting/fitting.h"
#include "garment/stepping/dressing_backend.h"
#include "model/system.h"

namespace mssim {

/// Dresses a garment scene by a backend that was made for it, as long as the rule says, prints how it went
/// and how the garment fits unless it is to be silent, and says on stderr what is out of bounds. Records the
/// start, the frames of the grid and how the garment rests. Returns an ExitCode. Throws NotVerified when the
/// simulation blows up, naming the step, WriteError and Interrupted.
int run_dressing(const PreparedScene& scene, DressingBackend& backend, const std::string& backend_name,
                 const SettlingRule& rule, const FrameGrid& frames, RunRecorder& recorder, StopRequest& stop,
                 bool silent = false);

}  // namespace mssim
