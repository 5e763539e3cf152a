#pragma once

#include <span>
#include <vector>

#include "guide/guide.h"
#include "output/tables/results.h"

namespace mssim {

/// For the terminal: of every method the longest step that keeps the wished error, or else the most accurate
/// one, and its cost at that error; the cheapest methods first. A method without points has its reason.
Table guide_summary(const SceneGuide& guide);

/// The tables of a guide's folder. "guide" has all points and the page; these have no page of their own:
/// "guide-steps" the largest stable steps beside theory, "guide-errors" the costs at equal error,
/// "guide-sizes" the times of cloths by their nodes, "guide-frames" the largest cloths that hold a frame
/// rate, and "guide-crossovers" the sizes at which two backends take the same time.
std::vector<ResultTable> guide_tables(std::span<const SceneGuide> guides, const Provenance& provenance);

/// What errors were measured against, in sentences with their full stops.
std::vector<std::string> about_trusted_state(const TrustedState& trusted);

}  // namespace mssim
