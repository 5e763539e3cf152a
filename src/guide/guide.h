#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "backends/interface/backend.h"
#include "guide/limits.h"
#include "guide/work_precision.h"
#include "model/system.h"

namespace mssim {

/// Smallest number of equal steps per frame that are no longer than dt_s.
int steps_a_frame(double dt_s, double frames_per_second);

/// Frame rates for which the largest cloths are determined, 1/s.
inline constexpr std::array<double, 3> frame_rates{30, 60, 120};

/// Cost per step of a method on cloths of one family.
struct SizeCurve {
  const Integrator* integrator = nullptr;
  const BackendInfo* backend = nullptr;
  double dt_s = 0;          ///< a step that is stable and, if possible, keeps the error; 0: none
  bool keeps_error = true;  ///< else no measured step is accurate enough, and this one is only stable
  struct Sample {
    std::uint64_t nodes = 0;
    double seconds_a_step = 0;
  };
  std::vector<Sample> samples = {};  ///< by nodes
  std::string status = {};           ///< why there are no samples, or no larger ones; or empty

  /// The largest cloth for a frame rate.
  struct Largest {
    double nodes = 0;       ///< interpolated on logarithmic axes; 0: the smallest sample is too slow
    bool at_least = false;  ///< the largest sample still keeps the frame rate
  };
  /// None without samples.
  std::optional<Largest> largest(double frames_per_second) const;
};

/// The number of nodes from which, at all larger sizes that both backends have, the one that is slower at the
/// smallest size takes less time per step with the same integrator. Interpolated on logarithmic axes between
/// samples; none if the same one is faster at the smallest and the largest size: another program may have
/// slowed a sample between them.
std::optional<double> crossover(const SizeCurve& a, const SizeCurve& b);

/// The number of nodes along a side of the measured cloths: each but the last has four times the nodes of the
/// one before.
inline constexpr std::array<std::uint32_t, 7> cloth_sides{16, 32, 64, 128, 256, 512, 724};

/// A cloth of a family, and the file of its scene, from which other processes build it.
struct FamilyCloth {
  System system;
  std::filesystem::path file = {};
};

/// Makes a square cloth of the family with `side` nodes along a side. The file exists as long as the maker.
using ClothMaker = std::function<FamilyCloth(std::uint32_t side)>;

/// Times every curve's method on cloths of increasing size, until two consecutive ones do not keep the lowest
/// frame rate. `go_on` is called before every sample; if it returns false, the curve ends and its status
/// gives the reason.
void measure_sizes(std::span<SizeCurve> curves, const ClothMaker& make, const ExecutionOptions& execution,
                   const std::function<bool(const std::string& activity)>& go_on);

/// The user's requirements.
struct Wish {
  double frames_per_second = 60;
  double error = 1e-3;  ///< of positions at the horizon, in mean rest lengths
};

/// The recommended method, as indices into the methods.
struct Recommendation {
  /// The cheapest method at the requested error. The recommended step is that of its point_at_error.
  std::optional<std::size_t> best;
  /// The cheapest method with another integrator, else on another backend.
  std::optional<std::size_t> runner_up;
  /// The method of the most accurate point, if none is accurate enough, nor too accurate to be told apart
  /// from the reference.
  std::optional<std::size_t> nearest;
  /// Wall time, s, with which the guide would have recommended a method; none: the time sufficed, or the
  /// guide was stopped. If set, none of the above is.
  std::optional<double> needed_s;
  std::vector<std::string> sentences;  ///< up to three, with full stops; one if nothing is recommended
};

/// A request for the guide of a scene. All that it points to must outlive the guide.
struct GuideRequest {
  const System* system = nullptr;
  std::vector<const BackendInfo*> backends;
  std::vector<const Integrator*> integrators;
  ExecutionOptions execution;  ///< with the scene's name and file
  Wish wish;
  double seconds = 120;            ///< approximate wall time
  double longest_horizon_s = 0.1;  ///< longest simulated time after which errors are measured
  ClothMaker make_cloth;           ///< of the scene's family; none: no sizes are measured
};

/// Callbacks of a guide.
struct GuideWatch {
  std::function<void(const std::string& activity, double done)> progress = [](const std::string&, double) {};
  std::function<bool()> stop = [] { return false; };  ///< ends the guide with its results so far
};

/// All measurements of a scene, and the recommendation.
struct SceneGuide {
  std::string scene;
  double seconds = 0;            ///< wall time of the request
  double seconds_on_points = 0;  ///< wall time of its points
  bool stopped = false;          ///< ended by GuideWatch::stop
  std::uint64_t nodes = 0, springs = 0;
  Wish wish;
  Spectrum at_start, on_the_way;
  TrustedState trusted;  ///< if it failed, there are no points
  std::vector<StepLimit> limits;
  std::vector<GuidedMethod> methods;  ///< with the front marked
  std::vector<SizeCurve> sizes;
  Recommendation recommendation;

  bool has_points() const;
};

/// Measures a scene other than a garment: the trusted state, the largest stable steps, the work-precision
/// curves from coarse to fine, interleaved, the longest steps of the two cheapest methods that keep the
/// error, and the sizes of cloths. Omits measurements for which the time does not suffice; the method's
/// status gives that reason.
SceneGuide guide_scene(const GuideRequest& request, const GuideWatch& watch);

/// Cost of a method at a given error.
struct CostAtError {
  double seconds_a_second = 0;  ///< wall time of a simulated second
  double dt_s = 0;              ///< the longest step
  /// Both are of the coarsest point that counts, which is more accurate than requested: a longer step was
  /// unstable, or not tried.
  bool at_longest_step = false;
};

/// The cost at which the method's curve, from long to short steps, first reaches the error. Cost and step are
/// interpolated between two points on logarithmic axes. None if no point is accurate enough. Ignores points
/// that do not count.
std::optional<CostAtError> cost_at_error(const GuidedMethod& method, double error);

/// The method's measured point with the longest step that counts and keeps the error; null if there is none.
const WorkPoint* point_at_error(const GuidedMethod& method, double error);

/// The method's most accurate point that counts; null if none does.
const WorkPoint* most_accurate(const GuidedMethod& method);

/// Recommends the cheapest method at the requested error, with the longest measured step that keeps it, its
/// speed relative to real time, and the errors at which the runner-up is cheaper. Recommends nothing if there
/// are methods that could be the cheapest, but were not measured for lack of time (missed_methods).
Recommendation recommend(const SceneGuide& guide);

/// Sentences with full stops: the number of measured methods, those not measured or not down to the requested
/// error, and the reasons.
std::vector<std::string> what_was_measured(const SceneGuide& guide);

/// Errors at which costs are shown, from large to small: the requested one and three around it.
std::array<double, 4> errors_around(const Wish& wish);

/// Compares Hong et al.'s ranking of integrators by milliseconds per step with the costs at the requested
/// error: sentences with full stops. For each backend, these rank semi-euler, midpoint and rk4; the last is
/// about explicit Euler, which they omit because it "can be readily blow-up". Empty if none of it was
/// measured.
std::vector<std::string> beside_the_paper(const SceneGuide& guide);

}  // namespace mssim
