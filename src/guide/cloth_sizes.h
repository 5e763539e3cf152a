#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "guide/limits.h"
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

}  // namespace mssim
