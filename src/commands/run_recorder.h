#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "commands/prepared_scene.h"
#include "commands/simulation.h"
#include "output/energy_curve.h"
#include "output/h5md_trace.h"

namespace mssim {

/// The files that a run writes from its frames, each only where it has a name.
struct RunFiles {
  std::string trace;
  std::string energy_curve;

  bool any() const { return !trace.empty() || !energy_curve.empty(); }
};

/// Writes the frames of a run into its files and keeps their energies.
class RunRecorder {
 public:
  /// Begins the trace of a scene, if there is to be one. Throws WriteError.
  RunRecorder(RunFiles files, const PreparedScene& scene, const TraceHeader& header);

  /// Whether anything is written.
  bool wanted() const { return files_.any(); }
  void record(const Frame& frame);
  const std::vector<EnergySample>& energies() const { return energies_; }

  /// Runs `simulation`, which records, and finishes the files: also when it blows up or is interrupted,
  /// because the frames before that are good and show what happened. Passes on what it throws.
  void finish_after(const std::function<void()>& simulation);

 private:
  void finish();

  RunFiles files_;
  std::optional<H5mdTrace> trace_;
  std::vector<EnergySample> energies_;
};

}  // namespace mssim
