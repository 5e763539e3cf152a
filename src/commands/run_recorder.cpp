#include "commands/run_recorder.h"

#include <utility>

#include "commands/exit_code.h"
#include "commands/run_provenance.h"
#include "mesh/interruption.h"
#include "scene/garment_body.h"

namespace mssim {

RunRecorder::RunRecorder(RunFiles files, const PreparedScene& scene, const TraceHeader& header)
    : files_(std::move(files)) {
  if (files_.trace.empty()) return;
  trace_.emplace(files_.trace, scene.system, header,
                 is_garment(scene.system) ? body_of_garment(scene.spec) : Surface{});
}

void RunRecorder::record(const Frame& frame) {
  if (trace_) trace_->write_frame(frame.step, frame.time_s, frame.state, frame.energy, frame.losses);
  energies_.push_back({frame.time_s, frame.energy});
}

void RunRecorder::finish_after(const std::function<void()>& simulation) {
  try {
    simulation();
  } catch (const NotVerified&) {
    finish();
    throw;
  } catch (const Interrupted&) {
    finish();
    throw;
  }
  finish();
}

void RunRecorder::finish() {
  if (trace_) trace_->close();
  if (!files_.energy_curve.empty()) write_energy_curve(files_.energy_curve, energies_, command_line());
}

}  // namespace mssim
