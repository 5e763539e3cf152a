#include <algorithm>
#include <cmath>
#include <map>

#include "bench/roofline/step_cost.h"
#include "integrators/all_integrators.h"
#include "report/report_charts.h"

namespace mssim {
namespace {

/// More points on a curve of energy would hide the reference.
constexpr std::size_t most_points = 40;

/// Where a row stands in a roofline: operations a byte, and 1e9 operations a second.
struct RoofDot {
  double intensity = 0, gigaflops = 0;
  std::optional<double> roof;  ///< at this intensity
};

std::optional<RoofDot> dot_of(const ResultRow& row) {
  const Integrator* integrator = find_integrator(row.integrator);
  if (!integrator || is_implicit(*integrator) || !counts(row) || !row.gigabytes_per_second ||
      !(*row.gigabytes_per_second > 0))
    return std::nullopt;
  // Operations do not depend on how springs lie in memory or how often a backend passes over the state.
  const double flops = step_cost(*integrator, {row.nodes, row.springs_unique, 0}).flops;
  RoofDot dot;
  dot.gigaflops = flops / *row.ms_per_step / 1e6;
  dot.intensity = dot.gigaflops / *row.gigabytes_per_second;
  if (row.roofline_fraction && *row.roofline_fraction > 0) dot.roof = dot.gigaflops / *row.roofline_fraction;
  return dot;
}

/// The roof that dots of as many threads lie under: bandwidth times intensity, up to a ceiling where any dot
/// shows that there is one. Such dots were held against the same peaks.
Series roof_line(const std::string& name, const std::vector<RoofDot>& dots, double from, double to) {
  double bandwidth = 0, ceiling = 0;
  for (const RoofDot& dot : dots) {
    bandwidth = std::max(bandwidth, *dot.roof / dot.intensity);
    ceiling = std::max(ceiling, *dot.roof);
  }
  const bool has_ceiling = std::ranges::any_of(
      dots, [&](const RoofDot& dot) { return *dot.roof < 0.999 * bandwidth * dot.intensity; });
  Series line{name, Origin::reference, "", {from}, {from * bandwidth}, {}, {}};
  if (const double ridge = ceiling / bandwidth; has_ceiling && ridge > from && ridge < to) {
    line.x.push_back(ridge);
    line.y.push_back(ceiling);
  }
  line.x.push_back(to);
  line.y.push_back(has_ceiling ? std::min(to * bandwidth, ceiling) : to * bandwidth);
  return line;
}

}  // namespace

std::optional<Chart> roofline_chart(std::span<const ResultRow> rows, const std::string& id) {
  const ResultRow* largest = nullptr;
  for (const ResultRow& row : rows)
    if (row.roofline_fraction && dot_of(row) && (!largest || row.nodes > largest->nodes)) largest = &row;
  if (!largest) return std::nullopt;
  Chart chart;
  chart.id = id + "-roofline";
  chart.title = "Roofline: " + largest->scene + ", " + largest->integrator;
  chart.form = ChartForm::points;
  chart.x = {"operations a byte", true};
  chart.y = {"operations a second (10⁹)", true};
  chart.families = backend_families;
  std::map<int, std::vector<RoofDot>> under_roof;  // by threads
  double least = INFINITY, most = 0;
  for (const ResultRow& row : rows) {
    if (row.scene != largest->scene || row.integrator != largest->integrator) continue;
    const auto dot = dot_of(row);
    if (!dot) continue;
    chart.series.push_back(
        {row.backend, Origin::measured, row.backend, {dot->intensity}, {dot->gigaflops}, {}, {}});
    if (dot->roof) under_roof[row.threads].push_back(*dot);
    least = std::min(least, dot->intensity);
    most = std::max(most, dot->intensity);
  }
  for (const auto& [threads, dots] : under_roof)
    chart.series.push_back(
        roof_line("roof of " + std::to_string(threads) + (threads == 1 ? " thread" : " threads"), dots,
                  least / 2, most * 2));
  return chart;
}

const FoundCurve* reference_of(const FoundCurve& curve, std::span<const FoundCurve> references) {
  const FoundCurve* best = nullptr;
  for (const FoundCurve& reference : references)
    if (curve.name.starts_with(reference.name) && (!best || reference.name.size() > best->name.size()))
      best = &reference;
  return best;
}

Chart energy_chart(const FoundCurve& curve, std::span<const FoundCurve> references, const std::string& id) {
  Chart chart;
  chart.id = id;
  chart.title = "Total energy: " + curve.name;
  chart.x = {"time (s)", false};
  chart.y = {"total energy (J)", false};
  Series points{curve.name, Origin::measured, "", {}, {}, {}, {}};
  const std::size_t count = curve.time_s.size(), apart = std::max<std::size_t>(1, count / most_points);
  for (std::size_t i = 0; i < count; i += apart) {
    points.x.push_back(curve.time_s[i]);
    points.y.push_back(curve.total_j[i]);
  }
  chart.series.push_back(std::move(points));
  if (const FoundCurve* reference = reference_of(curve, references))
    chart.series.push_back({"reference of " + reference->name,
                            Origin::reference,
                            "",
                            reference->time_s,
                            reference->total_j,
                            {},
                            {}});
  return chart;
}

}  // namespace mssim
