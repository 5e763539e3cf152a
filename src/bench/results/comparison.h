#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/results/result.h"
#include "statistics/statistics.h"

namespace mssim {

/// What may be said of a combination that was measured twice.
enum class Verdict { same, faster, slower, undecided, lost };

/// As it stands in tables.
std::string_view name_of(Verdict verdict);

/// Probability below which a difference of ranks counts as one.
inline constexpr double significance = 0.01;

/// Two measurements of one combination of scene, backend and integrator.
struct ComparedRow {
  std::string scene, backend, integrator;
  double base_ms = 0;                  ///< median
  std::optional<double> new_ms;        ///< median; none where it is lost
  std::optional<RatioEstimate> ratio;  ///< NEW / BASE; none where it is lost
  Verdict verdict = Verdict::undecided;
  /// Samples a side by which an undecided one is likely to be decided; none beyond `most_samples_asked`.
  std::optional<std::size_t> samples_needed;
  std::string reason;  ///< why it is lost
};

/// More samples than these are "many": nobody takes them.
inline constexpr std::size_t most_samples_asked = 1000;

/// The geometric mean of the ratios of a backend, or of all (an empty name).
struct MeanRatio {
  std::string backend;
  std::size_t rows = 0;
  double ratio = 1;
};

struct RunComparison {
  double threshold = 0.05;  ///< a change that matters, as a fraction
  std::vector<ComparedRow> rows;
  std::vector<MeanRatio> means;  ///< all first, then each backend; none without ratios
  /// Combinations that cannot be compared, as "scene, backend, integrator".
  std::vector<std::string> only_base, only_new;
  std::vector<std::string> untimed;  ///< those that were not timed or not verified in BASE
};

/// `slower` and `faster` differ significantly and by more than the threshold; `same` is where the whole
/// interval lies within the threshold, up or down by the same factor.
Verdict verdict_of(const RatioEstimate& ratio, double threshold);

/// Whether the verdict is certain to stay: the whole interval lies within the threshold, up or down by the
/// same factor, or beyond it, and then the change is significant.
bool is_certain(const RatioEstimate& ratio, double threshold);

/// Samples a side with which such times would be decided, taking intervals to shrink with the square root
/// of the number; `samples` are those that there were. None beyond most_samples_asked.
std::optional<std::size_t> samples_needed(const RatioEstimate& ratio, std::size_t samples, double threshold);

/// Compares every combination that was timed in `base` and stands in `next`, in the order of `base`; one that
/// has no time or no verification in `next` is lost. Throws std::invalid_argument for a time that is not
/// finite and positive.
RunComparison compare(std::span<const ResultRow> base, std::span<const ResultRow> next, double threshold);

/// Completes a comparison whose rows are there.
void add_means(RunComparison& comparison);

/// Is any row slower or lost?
bool has_regression(const RunComparison& comparison);

}  // namespace mssim
