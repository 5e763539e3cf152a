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

/// Reasons why times of two runs must not be compared: a sentence for each difference, such as "the CPU was A
/// with 2 logical CPUs and is B with 4 logical CPUs"; none if they may be compared.

/// Compares CPU, compiler (with build type and flags), threads, and the text of scenes that both runs have.
std::vector<std::string> differences(const Provenance& before, const Provenance& now);

/// Compares device, threads and scene size of the combinations that both runs have (another TetGen makes
/// another mesh of the same file). Rows without a measurement are ignored.
std::vector<std::string> differences(std::span<const ResultRow> before, std::span<const ResultRow> now);

/// Verdict on a combination that was measured twice.
enum class Verdict { same, faster, slower, undecided, lost };

/// The verdict's name in tables.
std::string_view name_of(Verdict verdict);

/// Largest p of a rank test that counts as a significant difference.
inline constexpr double significance = 0.01;

/// Two measurements of one combination of scene, backend and integrator.
struct ComparedRow : CombinationNames {
  std::optional<double> base_ms;       ///< median; none if the row was lost before the first round
  std::optional<double> new_ms;        ///< median; none if the row is lost
  std::optional<RatioEstimate> ratio;  ///< NEW / BASE; none if the row is lost
  Verdict verdict = Verdict::undecided;
  /// Samples per side that would probably decide an undecided row; none above `most_samples_asked`.
  std::optional<std::size_t> samples_needed;
  std::string reason;  ///< why the row is lost
  /// Milliseconds per step; pairs if they were measured as pairs. A lost row has none of NEW.
  std::vector<double> base_samples_ms, new_samples_ms;
};

/// Numbers of samples above this are not proposed: no practical run takes them.
inline constexpr std::size_t most_samples_asked = 1000;

/// Geometric mean of the ratios of a backend, or of all (an empty name).
struct MeanRatio {
  std::string backend;
  std::size_t rows = 0;
  double ratio = 1;
};

/// A comparison of two runs, BASE and NEW.
struct RunComparison {
  double threshold = 0.05;  ///< smallest change that matters, as a fraction
  std::vector<ComparedRow> rows;
  std::vector<MeanRatio> means;  ///< all first, then each backend; none without ratios
  /// Combinations that cannot be compared, as "scene, backend, integrator".
  std::vector<std::string> only_base, only_new;
  std::vector<std::string> untimed;  ///< those that were not timed or not verified in BASE
};

/// Judges a ratio: `slower` and `faster` are significant and beyond the threshold; `same` has its whole
/// interval within the threshold, up or down by the same factor.
Verdict verdict_of(const RatioEstimate& ratio, double threshold);

/// Whether the verdict is certain: the whole interval lies within the threshold, up or down by the same
/// factor; or it lies beyond the threshold, and the change is significant.
bool is_certain(const RatioEstimate& ratio, double threshold);

/// Samples per side that would probably give a verdict, if intervals shrink with the square root of the
/// number. `samples`: the number that was taken. None above most_samples_asked.
std::optional<std::size_t> samples_needed(const RatioEstimate& ratio, std::size_t samples, double threshold);

/// Compares every combination of `next` that was timed in `base`, in the order of `base`. A combination
/// without a time or a verification in `next` is lost. Throws std::invalid_argument for a time that is not
/// finite and positive.
RunComparison compare(std::span<const ResultRow> base, std::span<const ResultRow> next, double threshold);

/// Computes the means of a comparison from its rows.
void add_means(RunComparison& comparison);

/// Whether any row is slower or lost.
bool has_regression(const RunComparison& comparison);

/// Times of one combination by two programs that took turns, one pair per round. If the programs are alike,
/// either time of a pair is equally likely to be the longer, whatever the machine did in that round. The
/// looks and their tests assume nothing else.
struct PairedTimes : CombinationNames {
  std::vector<double> base_ms, new_ms;  ///< [rounds]
  std::string lost;  ///< why NEW has no verified time although BASE has; it is then not measured further
};

/// Whether more rounds are not worth their time: NEW is lost, or a look at the pairs is due (look_at) and its
/// verdict is certain (is_certain). If nothing has changed, at most 1 % of comparisons end with a change,
/// however many rounds there may be. If something has changed, at most 5 % end with an interval that misses
/// it.
bool is_settled(const PairedTimes& times, double threshold);

/// The verdict on pairs, as on independent samples, by signed ranks; undecided below first_look_pairs.
/// Interval and p are those of the look at this number of pairs, so they hold although the pairs were
/// examined before. Call it when the pairs are settled or time is up. Throws std::invalid_argument for a time
/// that is not finite and positive, and for no rounds unless NEW is lost.
ComparedRow compare_pairs(const PairedTimes& times, double threshold);

}  // namespace mssim
