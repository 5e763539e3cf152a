#pragma once

#include <span>
#include <vector>

#include "guide/guide.h"
#include "output/tables/results.h"

namespace mssim {

/// For the terminal: for each method, the longest step that keeps the requested error, or else the most
/// accurate one, and its cost at that error; the cheapest methods first. A method without points has its
/// reason.
Table guide_summary(const SceneGuide& guide);

/// The tables of a guide's folder. "guide" has all points and the page; these have no page: "guide-steps" the
/// largest stable steps and theory, "guide-errors" the costs at equal error, "guide-sizes" the times of
/// cloths by their nodes, "guide-frames" the largest cloths that reach a frame rate, and "guide-crossovers"
/// the sizes at which two backends take the same time.
std::vector<ResultTable> guide_tables(std::span<const SceneGuide> guides, const Provenance& provenance);

/// Sentences about the reference for errors, with their full stops.
std::vector<std::string> about_trusted_state(const TrustedState& trusted);

}  // namespace mssim
