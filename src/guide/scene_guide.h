#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "guide/cloth_sizes.h"
#include "guide/guided_method.h"
#include "guide/recommendation.h"
#include "guide/trusted_state.h"
#include "guide/work_point.h"
#include "model/spectrum.h"

namespace mssim {

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
/// curves from coarse to fine by turns, and the sizes of cloths. What the time does not suffice for is left
/// out, and the method's status says so.
SceneGuide guide_scene(const GuideRequest& request, const GuideWatch& watch);

}  // namespace mssim
