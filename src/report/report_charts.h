#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/results/result.h"
#include "charts/chart.h"
#include "output/tables/table.h"
#include "report/paper_scenes.h"
#include "report/report_folder.h"

namespace mssim {

/// Backends have the same look in every chart.
inline const std::vector<std::string> backend_families{"serial", "threads-mutex", "openmp", "opencl",
                                                       "hybrid"};

/// What becomes charts. `id` begins the ids of the charts, so that those of several folders differ. A chart
/// without anything to show is none.

/// For each integrator of the paper: speed-ups over one thread against nodes, published and measured.
std::vector<Chart> speedup_charts(const PaperScenes& scenes, const std::string& id);

/// Figure 6 of Vassilev: milliseconds an iteration against vertices, of garments.
std::optional<Chart> figure6_chart(std::span<const ResultRow> rows, const std::string& id);

/// Cloths, bodies, garments, and others: scenes of a kind lie on one line of a chart.
enum class ContentKind : std::uint8_t { cloth, bodies, garment, other };
ContentKind kind_of(const ResultRow& row);
std::string_view name_of(ContentKind kind);

/// The time of a step of the first integrator against nodes, for each kind of scene with at least two sizes,
/// with the slope of every line.
std::vector<Chart> scaling_charts(std::span<const ResultRow> rows, const PaperLegend& legend,
                                  std::span<const PublishedTable> published, const std::string& id);

/// The slopes of all integrators: exponents p of time ~ nodes^p. Without rows where nothing has two sizes.
Table slope_table(std::span<const ResultRow> rows, const PaperLegend& legend,
                  std::span<const PublishedTable> published);

/// A dot a backend, on the largest scene that has a roofline, with the first integrator, below the roofs that
/// the timings tell of.
std::optional<Chart> roofline_chart(std::span<const ResultRow> rows, const std::string& id);

/// Total energy against time, with the reference curve of the scene that the curve's name begins with.
Chart energy_chart(const FoundCurve& curve, std::span<const FoundCurve> references, const std::string& id);

/// The reference curve for a curve's name; null where there is none.
const FoundCurve* reference_of(const FoundCurve& curve, std::span<const FoundCurve> references);

}  // namespace mssim
