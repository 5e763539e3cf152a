#pragma once

#include <functional>
#include <optional>

#include "bench/job/combination.h"
#include "bench/job/scene_job.h"

namespace mssim {

/// The job's garment, dressed and settled, by the backend that is the same to the last bit for any number of
/// threads; where it does not settle, where the longest time has left it. None when it was asked to stop.
std::optional<State> draped_state(const SceneJob& job, const std::function<bool()>& stop);

/// Dresses the job's garment with the combination's backend and keeps how that went; where an earlier row has
/// it already, keeps that. The row has failed where a number of the fit is out of bounds or not finite.
/// Returns false when it was asked to stop.
bool dress_combination(Combination& combination, const SceneJob& job, const std::function<bool()>& stop);

}  // namespace mssim
