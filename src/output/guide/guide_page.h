#pragma once

#include <span>
#include <vector>

#include "guide/guide.h"
#include "output/tables/results.h"

namespace mssim {

/// The page of a guide, scene by scene: the recommendation, the methods, the trusted state, the front, the
/// largest stable steps with why they differ from theory, and the largest cloths. `tables`: guide_tables'.
Document guide_page(std::span<const SceneGuide> guides, const std::vector<ResultTable>& tables,
                    const Provenance& provenance);

/// What errors were measured against, in sentences with their full stops.
std::vector<std::string> about_trusted_state(const TrustedState& trusted);

}  // namespace mssim
