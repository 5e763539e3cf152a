#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "integrators/all_integrators.h"
#include "report/report_internal.h"
#include "text/text.h"

namespace mssim {
namespace {

/// A line of a chart: for each step of an integrator, longest first, the point of one backend.
struct GuideLine {
  std::string integrator;
  std::map<double, const GuidePoint*, std::greater<>> points;  ///< by step
};

/// Less for a better point: one that did not diverge is better than one that did; otherwise the cheaper one
/// is.
std::pair<bool, double> badness_of(const GuidePoint& point) {
  return {point.diverged, point.wall_s_per_s.value_or(std::numeric_limits<double>::infinity())};
}

std::vector<GuideLine> lines_of(const FoundGuide& guide, const std::string& scene) {
  std::vector<GuideLine> lines;
  for (const GuidePoint& point : guide.points) {
    if (point.scene != scene) continue;
    auto line = std::ranges::find(lines, point.integrator, &GuideLine::integrator);
    if (line == lines.end()) line = lines.insert(line, {point.integrator, {}});
    if (!point.dt_s) continue;
    const GuidePoint*& known = line->points[*point.dt_s];
    if (known == nullptr || badness_of(point) < badness_of(*known)) known = &point;
  }
  return lines;
}

/// The member on the x axis of a chart of errors.
using Along = std::optional<double> GuidePoint::*;

/// A power of ten above all errors that are drawn.
double edge_of(const std::vector<GuideLine>& lines) {
  double largest = 0;
  for (const GuideLine& line : lines)
    for (const auto& [dt_s, point] : line.points)
      if (!point->diverged) largest = std::max(largest, point->position_error.value_or(0));
  return largest > 0 ? std::pow(10, std::floor(std::log10(largest)) + 1) : 1;
}

/// The lines over `along`, and their marks. Methods without values of `along` are left out.
Chart error_chart(const std::vector<GuideLine>& lines, Along along, const std::string& id,
                  const std::string& title, const std::string& x_label) {
  Chart chart;
  chart.id = id;
  chart.title = title;
  chart.x = {x_label, true};
  chart.y = {"position error (mean rest lengths)", true};
  // Integrators have the same look in every chart of errors.
  for (const Integrator* integrator : all_integrators) chart.families.emplace_back(integrator->name);
  const double edge = edge_of(lines);
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Series uncompared{.name = "not compared", .origin = Origin::reference, .mark = PointMark::square},
      diverged{.name = "diverged", .origin = Origin::reference, .mark = PointMark::cross};
  for (const GuideLine& line : lines) {
    Series series{.name = line.integrator, .family = line.integrator};
    for (const auto& [dt_s, point] : line.points) {
      const auto x = point->*along;
      if (!x) continue;
      const double error = point->position_error.value_or(none);
      (point->diverged ? diverged : series).add(*x, point->diverged ? edge : error);
      if (!point->diverged && point->status != "ok") uncompared.add(*x, error);
    }
    if (!series.x.empty()) chart.series.push_back(std::move(series));
  }
  if (!diverged.x.empty())
    chart.remarks.push_back("Crosses at an error of " + decimal(edge) +
                            " mark diverged runs, whatever their error");
  if (!uncompared.x.empty())
    chart.remarks.emplace_back(
        "Points in squares are not compared: the error is too close to that of the reference, or the step "
        "is longer than the largest stable one");
  for (Series* marks : {&uncompared, &diverged})
    if (!marks->x.empty()) chart.series.push_back(std::move(*marks));
  return chart;
}

/// Rings around the points of the front.
void add_front(Chart& work, const std::vector<GuideLine>& lines) {
  Series front{.name = "on the front", .origin = Origin::reference, .mark = PointMark::ring};
  for (const GuideLine& line : lines)
    for (const auto& [dt_s, point] : line.points)
      if (point->on_front && point->wall_s_per_s && point->position_error)
        front.add(*point->wall_s_per_s, *point->position_error);
  if (!front.x.empty()) work.series.push_back(std::move(front));
}

/// Reference lines error ~ step^p for the orders p of the chart's integrators. They start at one point low on
/// the right, where long steps seldom have small errors.
void add_orders(Chart& steps) {
  const auto range = range_of(steps);
  if (!range) return;
  const auto [x, y] = *range;
  const double decades_across = std::log10(x.high) - std::log10(x.low),
               decades_up = std::log10(y.high) - std::log10(y.low);
  if (!(decades_across > 0 && decades_up > 0)) return;
  const double from = std::log10(x.low) + 0.7 * decades_across;
  std::set<int> orders;
  for (const Series& series : steps.series)
    if (const Integrator* integrator = find_integrator(series.family)) orders.insert(integrator->order);
  for (const int order : orders) {
    const double across = std::min(0.3 * decades_across, 0.4 * decades_up / order);
    steps.series.push_back({.name = fmt::format("order {}", order),
                            .origin = Origin::reference,
                            .x = {std::pow(10, from), std::pow(10, from + across)},
                            .y = {y.low, y.low * std::pow(10, across * order)}});
  }
}

/// Integrators that have points but no number of force evaluations.
std::vector<std::string> without_evaluations(const std::vector<GuideLine>& lines) {
  std::vector<std::string> names;
  for (const GuideLine& line : lines)
    if (!line.points.empty() && std::ranges::none_of(line.points, [](const auto& step) {
          return step.second->force_evaluations_per_s.has_value();
        }))
      names.push_back(line.integrator);
  return names;
}

void add_names(Chart& chart, const std::string& before, const std::vector<std::string>& names) {
  if (!names.empty()) chart.remarks.push_back(before + join(names, ", "));
}

/// "openmp (midpoint, verlet)", "openmp and serial (rk4)": the backends of the points of the lines.
std::vector<std::string> by_backends(const std::vector<GuideLine>& lines) {
  std::map<std::string, std::vector<std::string>> integrators;
  for (const GuideLine& line : lines) {
    std::vector<std::string> backends;
    for (const auto& [dt_s, point] : line.points) add_once(backends, point->backend);
    std::ranges::sort(backends);
    if (!backends.empty()) integrators[join(backends, " and ")].push_back(line.integrator);
  }
  std::vector<std::string> groups;
  for (const auto& [backends, names] : integrators)
    groups.push_back(fmt::format("{} ({})", backends, join(names, ", ")));
  return groups;
}

/// Why an integrator has no points, from its first row.
std::string reason_of(const FoundGuide& guide, const std::string& scene, const std::string& integrator) {
  for (const GuidePoint& point : guide.points)
    if (point.scene == scene && point.integrator == integrator) return integrator + " (" + point.status + ")";
  return integrator;
}

/// Adds what the chart of work and precision does not draw: backends, steps of diverged points, and points
/// that are left out.
void add_remarks(Chart& chart, const FoundGuide& guide, const std::string& scene,
                 const std::vector<GuideLine>& lines) {
  std::vector<std::string> crosses, without;
  std::size_t on_front = 0, drawn_on_front = 0;
  for (const GuidePoint& point : guide.points)
    if (point.scene == scene && point.on_front) ++on_front;
  for (const GuideLine& line : lines) {
    if (line.points.empty()) without.push_back(reason_of(guide, scene, line.integrator));
    for (const auto& [dt_s, point] : line.points) {
      if (point->diverged)
        crosses.push_back(fmt::format("{} with {} ms", line.integrator, three_digits(dt_s * 1000)));
      if (point->on_front) ++drawn_on_front;
    }
  }
  add_names(chart, "Diverged: ", crosses);
  add_names(chart, "Each point is from the cheapest backend with that step: ", by_backends(lines));
  if (on_front > drawn_on_front)
    chart.remarks.push_back(
        fmt::format("{} of {} on the front not drawn, because their backends take longer for the same step",
                    on_front - drawn_on_front, pluralize(on_front, "point")));
  add_names(chart, "No points: ", without);
}

/// A guide's files do not name the device of a backend; it is only known if there is just one.
BackendLook look_in_guide(const std::string& backend, const PaperLegend& legend,
                          const Provenance& provenance) {
  const std::vector<std::string>& devices = provenance.opencl_devices;
  return look_on(is_for_gpus(backend, legend) && devices.size() == 1 ? devices.front() : "", backend,
                 provenance);
}

/// The chart of an integrator's backends that have two sizes; none without any.
std::optional<Chart> size_chart(const FoundGuide& guide, const PaperLegend& legend,
                                const Provenance& provenance, const std::string& scene,
                                const std::string& integrator) {
  Chart chart;
  chart.title = fmt::format("{} in other sizes, {}", scene, integrator);
  chart.x = {.label = "nodes", .logarithmic = true, .ticks_at_values = true};
  chart.y = {"time per step (ms)", true};
  for (const GuideTime& time : guide.times) {
    if (time.scene != scene || time.integrator != integrator) continue;
    const BackendLook look = look_in_guide(time.backend, legend, provenance);
    auto series = std::ranges::find(chart.series, look.name, &Series::name);
    if (series == chart.series.end())
      series = chart.series.insert(series, Series{.name = look.name, .family = look.family});
    series->add(time.nodes, time.ms_per_step);
  }
  std::erase_if(chart.series, [](const Series& series) { return series.x.size() < 2; });
  return chart.series.empty() ? std::nullopt : std::optional(std::move(chart));
}

/// The charts of sizes of the first explicit and the first implicit integrator that have one.
std::vector<Chart> size_charts(const FoundGuide& guide, const PaperLegend& legend,
                               const Provenance& provenance, const std::string& scene,
                               const std::string& id) {
  std::vector<Chart> charts;
  for (const bool implicit : {false, true})
    for (const Integrator* integrator : all_integrators) {
      if (is_implicit(*integrator) != implicit) continue;
      auto chart = size_chart(guide, legend, provenance, scene, std::string(integrator->name));
      if (!chart) continue;
      chart->id = id + "-sizes-" + (implicit ? "implicit" : "explicit");
      charts.push_back(std::move(*chart));
      break;
    }
  return charts;
}

}  // namespace

std::vector<Chart> guide_charts(const FoundGuide& guide, const PaperLegend& legend,
                                const Provenance& provenance, const std::string& scene,
                                const std::string& id) {
  const std::vector<GuideLine> lines = lines_of(guide, scene);
  Chart work = error_chart(lines, &GuidePoint::wall_s_per_s, id + "-work-precision",
                           scene + ": error over cost", "wall seconds per simulated second");
  add_front(work, lines);
  add_remarks(work, guide, scene, lines);
  Chart steps =
      error_chart(lines, &GuidePoint::dt_s, id + "-error-step", scene + ": error over the step", "step (s)");
  add_orders(steps);
  Chart evaluations =
      error_chart(lines, &GuidePoint::force_evaluations_per_s, id + "-error-evaluations",
                  scene + ": error over force evaluations", "force evaluations per simulated second");
  add_names(evaluations, "Without a fixed number of force evaluations: ", without_evaluations(lines));
  std::vector<Chart> charts;
  for (Chart* chart : {&work, &steps, &evaluations})
    if (!chart->series.empty()) charts.push_back(std::move(*chart));
  for (Chart& chart : size_charts(guide, legend, provenance, scene, id)) charts.push_back(std::move(chart));
  for (Chart& chart : charts) chart.subtitle = where_measured(provenance);
  return charts;
}

}  // namespace mssim
