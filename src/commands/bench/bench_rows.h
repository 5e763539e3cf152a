#pragma once

#include <string>
#include <vector>

#include "bench/job/scene_job.h"
#include "bench/results/result.h"

namespace mssim {

/// The rows of a bench: what an earlier run left, and what is measured now.
class BenchRows {
 public:
  explicit BenchRows(std::vector<ResultRow> earlier) : rows_(std::move(earlier)) {}

  const std::vector<ResultRow>& all() const { return rows_; }
  std::vector<ResultRow> of_scene(const std::string& name) const;
  /// Puts `rows` where the scene's rows were, or at the end.
  void replace(const std::string& scene, std::vector<ResultRow> rows);

 private:
  std::vector<ResultRow> rows_;
};

/// Whether an earlier run finished all that the settings ask for of a scene. Throws UsageError when it
/// measured other combinations of it: samples of one row are compared with those of the others round by
/// round.
bool is_finished(const BenchSettings& settings, const std::string& scene,
                 const std::vector<ResultRow>& earlier);

}  // namespace mssim
