#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/machine/provenance.h"
#include "bench/results/result.h"
#include "statistics/statistics.h"

namespace mssim {

/// Why times of two runs may not be held against each other: a sentence for each thing that is not the same,
/// such as "the CPU was A with 2 logical CPUs and is B with 4 logical CPUs"; none when they may.

/// CPU, compiler (with its build type and flags), threads, and the text of scenes that both runs have.
std::vector<std::string> differences(const Provenance& before, const Provenance& now);

/// For the combinations that both runs have: the device, and how large the scene came out (another TetGen
/// makes another mesh of the same file). Rows that nothing was measured for don't count.
std::vector<std::string> differences(std::span<const ResultRow> before, std::span<const ResultRow> now);

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
  /// Milliseconds a step; in pairs where they were taken in pairs. Of a lost one there are none of NEW.
  std::vector<double> base_samples_ms, new_samples_ms;
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

/// Times of one combination by two programs, which took turns: a pair a round. Where the programs are alike,
/// either time of a pair is as likely to be the longer, whatever the machine did in that round: that is all
/// that the looks and their tests take for granted.
struct PairedTimes {
  std::string scene, backend, integrator;
  std::vector<double> base_ms, new_ms;  ///< [rounds]
  std::string lost;  ///< why NEW has no verified time though BASE has; then it is not measured any further
};

/// Whether more rounds are not worth their time: a look at the pairs is due (look_at) and finds the whole
/// interval of the ratio within the threshold, or beyond it and the change significant; or NEW is lost. Where
/// nothing has changed, at most one of a hundred comparisons ends so with a change, however many rounds there
/// may be, and where something has, at most one of twenty with an interval that misses it.
bool is_settled(const PairedTimes& times, double threshold);

/// The verdict on pairs: as on independent samples, by signed ranks; undecided below
/// first_look_pairs. The interval and p are those of the look at so many pairs, so that they hold although
/// the pairs were looked at before. To be asked for pairs that are settled, or when time is up. Throws
/// std::invalid_argument for a time that is not finite and positive, and for no rounds unless NEW is lost.
ComparedRow compare_pairs(const PairedTimes& times, double threshold);

}  // namespace mssim
