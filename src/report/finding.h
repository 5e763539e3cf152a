#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/machine/provenance.h"
#include "bench/results/result.h"
#include "report/paper_scenes.h"

namespace mssim {

/// What measured rows say about something that a paper says, or about themselves.
enum class Outcome : std::uint8_t {
  reproduced,
  partly,  ///< by some backends, or as far as intervals tell, and contradicted by nothing else
  not_reproduced,
  undecided,  ///< the intervals are too wide to say
  fact,       ///< nothing published stands beside it
  warning
};

/// As it stands in front of a sentence.
std::string_view name_of(Outcome outcome);

/// A sentence of the verdict, computed. With the marks of a Document.
struct Finding {
  Outcome outcome = Outcome::fact;
  std::string sentence;
};

/// Which of each two configurations of a published table is faster, and from which size on.
std::vector<Finding> order_findings(const PaperScenes& scenes);

/// What a step of each integrator costs, in steps of the cheapest.
std::vector<Finding> cost_findings(const PaperScenes& scenes);

/// Where a speed-up falls as the scenes grow.
std::vector<Finding> trend_findings(const PaperScenes& scenes);

/// What garments say about Figure 6 of Vassilev and the time of a dressing. None without garments.
std::vector<Finding> garment_findings(std::span<const ResultRow> rows);

/// On which devices rows were measured, which are not verified or have no time, and which speed-ups cannot be
/// told from 1. None without rows.
std::vector<Finding> row_findings(std::span<const ResultRow> rows, const Provenance& provenance);

/// How many of so many comparisons are as published, and how many contradict it.
Outcome outcome_of(std::uint64_t all, std::uint64_t as_published, std::uint64_t contrary);

/// How far a measured ratio of costs may lie from the published one, as a factor, to reproduce it.
inline constexpr double cost_tolerance = 1.25;
/// A published speed-up that becomes smaller by more than this fraction falls: the papers give no intervals.
inline constexpr double published_fall = 0.05;

}  // namespace mssim
