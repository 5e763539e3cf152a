#pragma once

#include <string>
#include <vector>

#include "charts/chart.h"
#include "report/guide_folder.h"

namespace mssim {

/// The charts of a scene of a guide: work and precision (Hairer, Norsett and Wanner, Solving Ordinary
/// Differential Equations I, section II.10), errors over steps and over force evaluations, and times by size.
/// A line is an integrator; each of its points is that of the cheapest backend with this step. Diverged
/// points stand as crosses at the edge, whatever their error. `id` begins the ids of the charts. A chart
/// without anything to show is none.
std::vector<Chart> guide_charts(const FoundGuide& guide, const std::string& scene, const std::string& id);

}  // namespace mssim
