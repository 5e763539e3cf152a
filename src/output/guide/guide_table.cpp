#include "output/guide/guide_table.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "guide/guide.h"
#include "output/guide/guide_page.h"
#include "text/text.h"

namespace mssim {
namespace {

Cell finite(double value) { return std::isfinite(value) ? Cell(value) : Cell(); }

/// Nothing where a search found none.
Cell found(double value) { return value > 0 ? Cell(value) : Cell(); }

std::string_view state_of(const WorkPoint& point) {
  if (point.diverged) return "diverged";
  if (!point.within_limit) return "longer than the largest stable step";
  return point.beyond_trust ? "within the reference's error" : "ok";
}

void add_point(Table& table, const SceneGuide& guide, const WorkPoint& point) {
  const std::optional<double> evaluations =
      point.evaluations ? std::optional(*point.evaluations / point.dt_s) : std::nullopt;
  table.add({{"scene", guide.scene},
             {"nodes", guide.nodes},
             {"springs_unique", guide.springs},
             {"integrator", point.integrator->name},
             {"backend", point.backend},
             {"dt_s", point.dt_s},
             {"steps", point.steps},
             {"horizon_s", guide.trusted.horizon_s},
             {"position_error", point.position_error},
             {"energy_error", point.energy_error},
             {"solver_error", point.solver_error},
             {"step_error", point.step_error},
             {"reference_error", guide.trusted.error()},
             {"ms_per_step", 1000 * point.seconds_a_step},
             {"wall_s_per_s", point.seconds_a_second()},
             {"force_evaluations_per_s", evaluations},
             {"samples", point.samples},
             {"diverged", point.diverged},
             {"on_front", point.on_front},
             {"status", state_of(point)},
             {"note", point.note}});
}

/// A method without points says why in a row of its own.
void add_reason(Table& table, const SceneGuide& guide, const GuidedMethod& method) {
  table.add({{"scene", guide.scene},
             {"nodes", guide.nodes},
             {"springs_unique", guide.springs},
             {"integrator", method.integrator->name},
             {"backend", method.backend->name},
             {"dt_s", {}},
             {"steps", {}},
             {"horizon_s", guide.trusted.horizon_s},
             {"position_error", {}},
             {"energy_error", {}},
             {"solver_error", {}},
             {"step_error", {}},
             {"reference_error", {}},
             {"ms_per_step", {}},
             {"wall_s_per_s", {}},
             {"force_evaluations_per_s", {}},
             {"samples", {}},
             {"diverged", {}},
             {"on_front", {}},
             {"status", method.status},
             {"note", {}}});
}

Table points_table(std::span<const SceneGuide> guides) {
  Table table;
  for (const SceneGuide& guide : guides)
    for (const GuidedMethod& method : guide.methods) {
      bool any = false;
      for (const WorkPoint& point : guide.points)
        if (is_of(point, method)) {
          add_point(table, guide, point);
          any = true;
        }
      if (!any) add_reason(table, guide, method);
    }
  return table;
}

Table steps_table(std::span<const SceneGuide> guides) {
  Table table;
  for (const SceneGuide& guide : guides)
    for (const StepLimit& limit : guide.limits)
      table.add({{"scene", guide.scene},
                 {"integrator", limit.integrator->name},
                 {"backend", limit.backend},
                 {"stable_dt_s", found(limit.measured.stable_s)},
                 {"unstable_dt_s", found(limit.measured.unstable_s)},
                 {"theory_dt_s", finite(limit.theory.shortest_s())},
                 {"theory_at_start_dt_s", finite(limit.theory.at_start_s)},
                 {"theory_on_the_way_dt_s", finite(limit.theory.on_the_way_s)},
                 {"gershgorin_dt_s", finite(limit.theory.bound_s)},
                 {"runs", limit.measured.runs},
                 {"span_s", limit.measured.span_s},
                 {"finished", limit.measured.finished},
                 {"why", limit.why},
                 {"status", limit.status}});
  return table;
}

Table errors_table(std::span<const SceneGuide> guides) {
  Table table;
  for (const SceneGuide& guide : guides)
    for (const GuidedMethod& method : guide.methods)
      for (const double error : errors_around(guide.wish))
        if (const auto cost = cost_at_error(guide.points, method, error))
          table.add({{"scene", guide.scene},
                     {"integrator", method.integrator->name},
                     {"backend", method.backend->name},
                     {"position_error", error},
                     {"wall_s_per_s", cost->seconds_a_second},
                     {"at_longest_step", cost->at_longest_step}});
  return table;
}

Table sizes_table(std::span<const SceneGuide> guides) {
  Table table;
  for (const SceneGuide& guide : guides)
    for (const SizeCurve& curve : guide.sizes)
      for (const SizeCurve::Sample& sample : curve.samples)
        table.add({{"scene", guide.scene},
                   {"integrator", curve.integrator->name},
                   {"backend", curve.backend->name},
                   {"dt_s", curve.dt_s},
                   {"nodes", sample.nodes},
                   {"ms_per_step", 1000 * sample.seconds_a_step}});
  return table;
}

Table frames_table(std::span<const SceneGuide> guides) {
  Table table;
  for (const SceneGuide& guide : guides)
    for (const SizeCurve& curve : guide.sizes)
      for (const double rate : frame_rates) {
        const auto largest = curve.largest(rate);
        table.add({{"scene", guide.scene},
                   {"integrator", curve.integrator->name},
                   {"backend", curve.backend->name},
                   {"dt_s", found(curve.dt_s)},
                   {"frames_per_second", rate},
                   {"steps_per_frame", curve.dt_s > 0 ? Cell(steps_a_frame(curve.dt_s, rate)) : Cell()},
                   {"keeps_error", curve.dt_s > 0 ? Cell(curve.keeps_error) : Cell()},
                   {"largest_nodes", largest ? Cell(std::llround(largest->nodes)) : Cell()},
                   {"or_more", largest ? Cell(largest->at_least) : Cell()},
                   {"status", curve.status}});
      }
  return table;
}

Table crossovers_table(std::span<const SceneGuide> guides) {
  Table table;
  for (const SceneGuide& guide : guides)
    for (std::size_t i = 0; i < guide.sizes.size(); ++i)
      for (std::size_t j = i + 1; j < guide.sizes.size(); ++j) {
        const SizeCurve &a = guide.sizes[i], &b = guide.sizes[j];
        if (a.integrator != b.integrator || a.samples.empty() || b.samples.empty()) continue;
        const auto nodes = crossover(a, b);
        const bool first_faster = a.samples.front().seconds_a_step <= b.samples.front().seconds_a_step;
        table.add({{"scene", guide.scene},
                   {"integrator", a.integrator->name},
                   {"faster_when_small", (first_faster ? a : b).backend->name},
                   {"other", (first_faster ? b : a).backend->name},
                   {"crossover_nodes", nodes ? Cell(std::llround(*nodes)) : Cell()}});
      }
  return table;
}

/// The cheapest point that keeps the error, else the most accurate one; null where none counts.
const WorkPoint* point_to_show(const SceneGuide& guide, const GuidedMethod& method) {
  const WorkPoint *cheapest = nullptr, *nearest = nullptr;
  for (const WorkPoint& point : guide.points) {
    if (!is_of(point, method) || !point.counts()) continue;
    if (*point.position_error <= guide.wish.error &&
        (cheapest == nullptr || point.seconds_a_second() < cheapest->seconds_a_second()))
      cheapest = &point;
    if (nearest == nullptr || *point.position_error < *nearest->position_error) nearest = &point;
  }
  return cheapest ? cheapest : nearest;
}

}  // namespace

Table guide_summary(const SceneGuide& guide) {
  struct Line {
    const GuidedMethod* method;
    const WorkPoint* point;
  };
  std::vector<Line> lines;
  for (const GuidedMethod& method : guide.methods) lines.push_back({&method, point_to_show(guide, method)});
  // Those that keep the error by their cost, then the others by their error.
  std::ranges::stable_sort(lines, {}, [&](const Line& line) {
    if (line.point == nullptr) return std::pair(2, 0.0);
    return *line.point->position_error <= guide.wish.error ? std::pair(0, line.point->seconds_a_second())
                                                           : std::pair(1, *line.point->position_error);
  });
  Table table;
  for (const Line& line : lines) {
    const auto limit = std::ranges::find(guide.limits, line.method->integrator, &StepLimit::integrator);
    const WorkPoint* point = line.point;
    const double rate = guide.wish.frames_per_second;
    std::string_view accurate;
    if (point != nullptr) accurate = *point->position_error <= guide.wish.error ? "yes" : "no";
    table.add({{"integrator", line.method->integrator->name},
               {"backend", line.method->backend->name},
               {"stable_dt_s", found(limit->measured.stable_s)},
               {"dt_s", point ? Cell(point->dt_s) : Cell()},
               {"steps_per_frame", point ? Cell(steps_a_frame(point->dt_s, rate)) : Cell()},
               {"wall_s_per_s", point ? Cell(point->seconds_a_second()) : Cell()},
               {"position_error", point ? Cell(point->position_error) : Cell()},
               {"energy_error", point ? Cell(point->energy_error) : Cell()},
               {"accurate", point ? Cell(accurate) : Cell()},
               {"on_front", point ? Cell(point->on_front) : Cell()},
               {"remark", line.method->status.empty() ? Cell() : Cell(line.method->status)}});
  }
  return table;
}

std::vector<ResultTable> guide_tables(std::span<const SceneGuide> guides, const Provenance& provenance) {
  std::vector<ResultTable> tables{
      {"guide", points_table(guides), {}},        {"guide-steps", steps_table(guides), {}},
      {"guide-errors", errors_table(guides), {}}, {"guide-sizes", sizes_table(guides), {}},
      {"guide-frames", frames_table(guides), {}}, {"guide-crossovers", crossovers_table(guides), {}}};
  tables.front().page = guide_page(guides, tables, provenance);
  std::erase_if(tables, [](const ResultTable& table) { return table.data.rows.empty(); });
  return tables;
}

}  // namespace mssim
