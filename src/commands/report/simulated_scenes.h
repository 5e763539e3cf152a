#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/report_folder.h"

namespace mssim {

/// What a report shows of scenes that it simulates itself.
struct SimulatedScenes {
  std::vector<FoundPicture> pictures;
  std::vector<FoundCurve> curves;  ///< of energy, as long as their references
};

/// Simulates scenes of the folders anew, by `openmp`: of each kind of scene the largest that takes no more
/// than about half a second, as the folder's times tell, for half a second of its time, or until its garment
/// hangs, to draw it; and of each kind the largest of those that has one of `references`, named as the scene,
/// for its energies. Adds to `problems` why one cannot be simulated, for example because the scene of that
/// name is not the one that was measured. Throws Interrupted.
SimulatedScenes simulated_scenes(std::span<const ReportFolder> folders,
                                 std::span<const FoundCurve> references, std::vector<std::string>& problems);

}  // namespace mssim
