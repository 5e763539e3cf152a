#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "commands/shared/prepared_scene.h"
#include "commands/shared/simulation.h"
#include "output/pictures/picture_folder.h"
#include "output/traces/energy_curve.h"
#include "output/traces/h5md_trace.h"

namespace mssim {

/// What a run writes from its frames, each only where it has a name.
struct RunFiles {
  std::string trace;
  std::string energy_curve;
  std::string pictures;    ///< a folder
  bool temporary = false;  ///< nobody is told of them

  bool any() const { return !trace.empty() || !energy_curve.empty() || !pictures.empty(); }
};

/// What the files say about how they came about, beside what the scene says, and how pictures look.
struct FileHeaders {
  TraceHeader trace;
  std::string command_line;  ///< of the energy curve
  PictureOptions pictures;
};

/// Throws UsageError when two of the files, the XDMF of the trace, and the files that the scene is read from,
/// are the same.
void require_distinct(const RunFiles& files, const SceneSpec& scene);

/// Writes the frames of a run into its files and keeps their energies.
class RunRecorder {
 public:
  /// Begins the files of a scene that there are to be. Throws WriteError, also where another writer has one.
  RunRecorder(const RunFiles& files, const PreparedScene& scene, const FileHeaders& headers);

  /// Whether anything is written.
  bool wanted() const { return trace_ || curve_ || pictures_; }
  /// Throws WriteError.
  void record(const Frame& frame);
  const std::vector<EnergySample>& energies() const { return energies_; }

  /// Runs `simulation`, which records, and finishes the files: also when it blows up or is interrupted,
  /// because the frames before that are good and show what happened. Says on stderr what has been written.
  /// Where a file cannot be written any more, files stay under their temporary names with all frames that
  /// were recorded before, and the WriteError says so. Passes on what `simulation` throws.
  void finish_after(const std::function<void()>& simulation);

 private:
  void finish();
  /// What the files hold that did not get their names, for the end of a message.
  std::string kept();

  bool temporary_;
  std::optional<H5mdTrace> trace_;
  std::optional<EnergyCurve> curve_;
  std::optional<PictureFolder> pictures_;
  std::vector<EnergySample> energies_;
};

}  // namespace mssim
