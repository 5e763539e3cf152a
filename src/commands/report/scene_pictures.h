#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/report_folder.h"

namespace mssim {

/// Draws scenes of the folders: of each kind of scene the largest that this takes no more than about half a
/// second, as the folder's times tell. Each is simulated anew, by `openmp`, for half a second of its time, or
/// until its garment hangs. Adds to `problems` why one cannot be drawn, for example because the scene of that
/// name is not the one that was measured. Throws Interrupted.
std::vector<FoundPicture> scene_pictures(std::span<const ReportFolder> folders,
                                         std::vector<std::string>& problems);

}  // namespace mssim
