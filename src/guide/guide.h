#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "backends/interface/backend.h"
#include "guide/limits.h"
#include "guide/work_precision.h"
#include "model/system.h"

namespace mssim {

/// Whole steps a frame that are no longer than dt_s.
int steps_a_frame(double dt_s, double frames_per_second);

/// Frame rates that cloths are asked for, a second.
inline constexpr std::array<double, 3> frame_rates{30, 60, 120};

/// What a method's step costs on cloths of one family, and the largest that it holds a frame rate with.
struct SizeCurve {
  const Integrator* integrator = nullptr;
  const BackendInfo* backend = nullptr;
  double dt_s = 0;  ///< the step that stability and, where one keeps it, the error ask for
  bool keeps_error =
      true;  ///< else no step that was measured is accurate enough, and this one is only stable
  struct Sample {
    std::uint64_t nodes = 0;
    double seconds_a_step = 0;
  };
  std::vector<Sample> samples;  ///< by nodes
  std::string status;           ///< why there is none, or no larger one; or empty

  /// The largest cloth for a frame rate.
  struct Largest {
    double nodes = 0;       ///< between two samples by a line through their logarithms; 0: the smallest fails
    bool at_least = false;  ///< the largest sample still holds it
  };
  /// None without samples.
  std::optional<Largest> largest(double frames_per_second) const;
};

/// At how many nodes two backends with the same integrator take the same time a step, by lines through the
/// logarithms of the samples that both have; none where one is faster at all of these.
std::optional<double> crossover(const SizeCurve& a, const SizeCurve& b);

/// The number of nodes along a side of the cloths that are measured: each but the last has
/// four times the nodes of the one before.
inline constexpr std::array<std::uint32_t, 7> cloth_sides{16, 32, 64, 128, 256, 512, 724};

/// A cloth of a family, and the file of its scene, from which processes build it for themselves.
struct FamilyCloth {
  System system;
  std::filesystem::path file = {};
};

/// Makes a square cloth of the family, with so many nodes along a side. The file stays while the maker does.
using ClothMaker = std::function<FamilyCloth(std::uint32_t side)>;

/// Times every curve's method on ever larger cloths, each until two in a row do not hold the slowest frame
/// rate.
/// `go_on` is asked before every sample, with the share that is done; curves that it ends say so.
void measure_sizes(std::span<SizeCurve> curves, const ClothMaker& make, const ExecutionOptions& execution,
                   const std::function<bool(const std::string& activity, double done)>& go_on);

/// What a user can bear.
struct Wish {
  double frames_per_second = 60;
  double error = 1e-3;  ///< of positions at the horizon, in mean rest lengths
};

/// What to take, as places in the points that it was chosen from.
struct Recommendation {
  std::optional<std::size_t> best;  ///< of the cheapest method at the wished error: its point_at_error
  /// That of the cheapest method with another integrator, else on another backend.
  std::optional<std::size_t> runner_up;
  std::optional<std::size_t> nearest;  ///< the most accurate, where none is accurate enough
  /// Wall time, s, with which the guide of the scene would have recommended something; none: it has the time
  /// that it needs, or was stopped. With it, none of the above is set.
  std::optional<double> needed_s;
  std::vector<std::string> sentences;  ///< three, or one where nothing is recommended, with full stops
};

/// What a scene's guide is asked for. All that it points to must outlive the guide.
struct GuideRequest {
  std::string scene;
  const System* system = nullptr;
  std::vector<const BackendInfo*> backends;
  std::vector<const Integrator*> integrators;
  ExecutionOptions execution;
  Wish wish;
  double seconds = 120;            ///< wall time that it may take, about
  double longest_horizon_s = 0.1;  ///< simulated time after which errors are measured, at most
  ClothMaker make_cloth;           ///< of the scene's family; none: no sizes are measured
};

/// What it tells and asks on the way.
struct GuideWatch {
  std::function<void(const std::string& activity, double done)> progress = [](const std::string&, double) {};
  std::function<bool()> stop = [] { return false; };  ///< ends the guide with what it has
};

/// Everything that was measured of a scene, and what follows.
struct SceneGuide {
  std::string scene;
  double seconds = 0;            ///< wall time that it was given
  double seconds_on_points = 0;  ///< wall time that its points took
  bool stopped = false;          ///< before it had all that it had time for
  std::uint64_t nodes = 0, springs = 0;
  Wish wish;
  Spectrum at_start, on_the_way;
  TrustedState trusted;  ///< where it has a failure, there are no points
  std::vector<StepLimit> limits;
  std::vector<GuidedMethod> methods;
  std::vector<WorkPoint> points;  ///< by method, from coarse to fine, the front marked
  std::vector<SizeCurve> sizes;
  Recommendation recommendation;
};

/// Measures a scene, which is no garment: the trusted state, the largest stable steps, the work-precision
/// curves from coarse to fine by turns, the longest steps of the two cheapest methods that keep the error,
/// and the sizes of cloths. What the time does not suffice for is left out, and the method's status says so.
SceneGuide guide_scene(const GuideRequest& request, const GuideWatch& watch);

/// What a method takes where its error may be this large.
struct CostAtError {
  double seconds_a_second = 0;  ///< wall time of a simulated second
  double dt_s = 0;              ///< the longest step
  /// They are those of the coarsest point that counts, which is more accurate than asked: a longer step was
  /// not stable, or not tried.
  bool at_longest_step = false;
};

/// Where the method's curve, from long steps to short ones, first comes to the error. Between two points the
/// logarithms of the cost and of the step are taken as linear in that of the error; none where no point is
/// accurate enough. Points that do not count are left out.
std::optional<CostAtError> cost_at_error(std::span<const WorkPoint> points, const GuidedMethod& method,
                                         double error);

/// The place of the method's longest step that was measured, counts and keeps the error.
std::optional<std::size_t> point_at_error(std::span<const WorkPoint> points, const GuidedMethod& method,
                                          double error);

/// In how many steps over the horizon the method should keep the wished error, where that is with a step
/// that is longer than its point_at_error by more than step_resolution: as its curve says, or where that is
/// accurate enough with the longest step, as long a step as is stable. None where no point keeps the error.
std::optional<int> steps_to_try(const SceneGuide& guide, const GuidedMethod& method);

/// Explicit methods that could be the cheapest at the wished error, if there had been time for their curves
/// to reach it. The step that such a method needs is taken from its integrator's finest point that counts, on
/// any backend, and its order; it is no longer than the longest usable one. With it and the measured time per
/// step the method is cheaper than all that were measured. Where no step or no time is known, it could be;
/// where its integrator came to the end of a curve short of the error, on another backend, it could not.
/// Implicit methods, whose steps have no cost that is known before, are missed where there are no such
/// explicit ones and no point counts.
std::vector<const GuidedMethod*> missed_methods(const SceneGuide& guide);

/// Wall time, s, with which the curves of these methods would have reached the wished error, and those of the
/// others with points that take no longer: rounded up to two digits, twice what there was at least.
double needed_seconds(const SceneGuide& guide, std::span<const GuidedMethod* const> missed);

/// The cheapest method at the wished error, with the longest step that was measured and keeps it; how it
/// stands to real time; and when the runner-up would be cheaper. Nothing where missed_methods() says so.
Recommendation recommend(const SceneGuide& guide);

/// How many methods were measured, and which were not, or not to the wished error, and why: sentences with
/// their full stops.
std::vector<std::string> what_was_measured(const SceneGuide& guide);

/// Errors at which costs are shown, from large to small: the wished one and three around it.
std::array<double, 4> errors_around(const Wish& wish);

/// What Hong et al. say of integrators by milliseconds a step, beside what was measured at the wished error:
/// sentences with their full stops. For each backend the order of semi-euler, midpoint and rk4; and what
/// becomes of explicit Euler, which they leave out because it "can be readily blow-up". Empty where none of
/// it was measured.
std::vector<std::string> beside_the_paper(const SceneGuide& guide);

}  // namespace mssim
