#include "output/guide/guide_tables.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>

#include "text/text.h"

namespace mssim {
namespace {

/// Shows small numbers with two significant digits, because three decimals would be 0.
void show_small_numbers(Table& table) {
  for (std::vector<Cell>& row : table.rows)
    for (Cell& cell : row)
      if (const double* number = std::get_if<double>(&cell.value); number && std::abs(*number) < 0.1)
        cell = Cell(two_digits(*number));
  for (Column& column : table.columns)
    if (column.name.ends_with("_s") || column.name.ends_with("_error")) column.align = Align::right;
}

Table front_table(const SceneGuide& guide) {
  std::vector<std::pair<const GuidedMethod*, const WorkPoint*>> front;
  for (const GuidedMethod& method : guide.methods)
    for (const WorkPoint& point : method.points)
      if (point.on_front) front.emplace_back(&method, &point);
  std::ranges::sort(front, {}, [](const auto& one) { return one.second->seconds_a_second(); });
  Table table;
  for (const auto& [method, point] : front)
    table.add({{"integrator", method->integrator->name},
               {"backend", method->backend->name},
               {"dt_s", point->dt_s},
               {"wall_s_per_s", point->seconds_a_second()},
               {"position_error", point->position_error}});
  show_small_numbers(table);
  return table;
}

void add_table(Document& page, const std::string& heading, const std::string& text, Table table) {
  if (table.rows.empty()) return;
  page.insert(page.end(), {Heading{3, heading}, Paragraph{text}, std::move(table)});
}

Cell worded(const std::string& text) { return text.empty() ? Cell() : Cell(text); }

/// A row per method, a column per frame rate.
Table cloths_at_rates(const SceneGuide& guide) {
  Table table;
  table.columns = {{"integrator"}, {"backend"}, {"dt_s", Align::right}, {"keeps_error"}};
  for (const double rate : frame_rates)
    table.columns.push_back({decimal(rate) + " per second", Align::right});
  table.columns.push_back({"remark"});
  for (const SizeCurve& curve : guide.sizes) {
    if (curve.samples.empty()) continue;  // the summary says why
    std::vector<Cell> row{curve.integrator->name, curve.backend->name, two_digits(curve.dt_s),
                          curve.keeps_error};
    for (const double rate : frame_rates) {
      const SizeCurve::Largest largest = *curve.largest(rate);
      const auto nodes = static_cast<std::uint64_t>(std::llround(largest.nodes));
      row.emplace_back((largest.at_least ? "≥ "
                        : nodes == 0     ? "< "
                                         : "") +
                       grouped(nodes == 0 ? curve.samples.front().nodes : nodes));
    }
    row.push_back(worded(curve.status));
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// The sizes at which two backends take the same time.
Table crossovers_table(const SceneGuide& guide) {
  Table table;
  for (std::size_t i = 0; i < guide.sizes.size(); ++i)
    for (std::size_t j = i + 1; j < guide.sizes.size(); ++j) {
      const SizeCurve &a = guide.sizes[i], &b = guide.sizes[j];
      if (a.integrator != b.integrator || a.samples.empty() || b.samples.empty()) continue;
      const auto nodes = crossover(a, b);
      const bool first_faster = a.samples.front().seconds_a_step <= b.samples.front().seconds_a_step;
      table.add({{"integrator", a.integrator->name},
                 {"faster_when_small", (first_faster ? a : b).backend->name},
                 {"other", (first_faster ? b : a).backend->name},
                 {"crossover_nodes", nodes ? Cell(std::llround(*nodes)) : Cell()}});
    }
  return table;
}

void add_cloths(Document& page, const SceneGuide& guide) {
  add_table(
      page, "Largest cloths of the family",
      "Numbers of nodes of square cloths with the springs, masses and spacing of this scene, by frames per "
      "second. The step is interpolated at the requested error or, if no point keeps it, is that of the "
      "cheapest stable point. Times between two measured sizes are interpolated on logarithmic axes.",
      cloths_at_rates(guide));
  Table crossovers = crossovers_table(guide);
  std::erase_if(crossovers.rows, [](const std::vector<Cell>& row) {
    return std::holds_alternative<std::monostate>(row.back().value);
  });
  add_table(
      page, "Crossovers of backends",
      "Number of nodes from which `other` is the faster one, up to the largest size that both have. In pairs "
      "that are not listed, the same backend is faster at the smallest and the largest of these sizes.",
      std::move(crossovers));
}

/// The limits, without columns that are only for programs.
Table limits_table(const SceneGuide& guide) {
  Table table;
  const auto step = [](double seconds) {
    return seconds > 0 && std::isfinite(seconds) ? Cell(two_digits(seconds)) : Cell();
  };
  for (const StepLimit& limit : guide.limits) {
    std::string remark = limit.ending.lack == Lack::nothing ? limit.why : limit.ending.status();
    if (!limit.measured.finished && limit.measured.stable_s > 0)
      remark = "the limit is between these two; time ran out" + (remark.empty() ? "" : "; " + remark);
    table.add({{"integrator", limit.integrator->name},
               {"stable_dt_s", step(limit.measured.stable_s)},
               {"unstable_dt_s", step(limit.measured.unstable_s)},
               {"theory_dt_s", step(limit.theory.shortest_s())},
               {"gershgorin_dt_s", step(limit.theory.bound_s)},
               {"remark", worded(remark)}});
  }
  for (Column& column : table.columns)
    if (column.name.ends_with("_s")) column.align = Align::right;
  return table;
}

/// A row per method, a column per error; sorted by the cost at the requested error.
Table costs_at_errors(const SceneGuide& guide) {
  const auto errors = errors_around(guide.wish);
  Table table;
  table.columns = {{"integrator"}, {"backend"}};
  for (const double error : errors) table.columns.push_back({two_digits(error), Align::right});
  const auto order = ordered_places(guide.methods, [&](const GuidedMethod& method) {
    const auto cost = cost_at_error(method, guide.wish.error);
    return cost ? cost->seconds_a_second : std::numeric_limits<double>::infinity();
  });
  for (const std::size_t place : order) {
    const GuidedMethod& method = guide.methods[place];
    std::vector<Cell> row{method.integrator->name, method.backend->name};
    bool any = false;
    for (const double error : errors) {
      const auto cost = cost_at_error(method, error);
      row.push_back(cost ? Cell(three_digits(cost->seconds_a_second) + (cost->at_longest_step ? " ‡" : ""))
                         : Cell());
      any = any || cost;
    }
    if (any) table.rows.push_back(std::move(row));
  }
  return table;
}

void add_costs(Document& page, const SceneGuide& guide) {
  add_table(
      page, "At equal error",
      "Wall seconds per simulated second at the error of the column, interpolated between two points on "
      "logarithmic axes. ‡: the longest step that was compared is more accurate than that; times are not "
      "extrapolated.",
      costs_at_errors(guide));
  const std::vector<std::string> sentences = beside_the_paper(guide);
  if (sentences.empty()) return;
  page.emplace_back(Paragraph{"Compared with milliseconds per step, the measure of Hong et al.:"});
  for (const std::string& sentence : sentences) page.emplace_back(Paragraph{sentence});
}

/// The recommendation, or why there is none.
void add_advice(Document& page, const SceneGuide& guide) {
  if (!guide.trusted.failure.empty()) add_sentence(page, "No errors were measured: " + guide.trusted.failure);
  if (const auto& sentences = guide.recommendation.sentences; !sentences.empty())
    page.emplace_back(Paragraph{join(sentences, " ")});
}

void add_scene(Document& page, const SceneGuide& guide) {
  page.emplace_back(Heading{
      2, guide.scene + ": " + pluralize(guide.nodes, "node") + ", " + pluralize(guide.springs, "spring")});
  add_advice(page, guide);
  if (guide.trusted.failure.empty()) {
    page.emplace_back(Paragraph{join(what_was_measured(guide), " ")});
    Table summary = guide_summary(guide);
    show_small_numbers(summary);
    page.emplace_back(std::move(summary));
    page.emplace_back(Paragraph{join(about_trusted_state(guide.trusted), " ")});
    add_table(page, "The front", "No other measured point is both as fast and as accurate as one of these.",
              front_table(guide));
    add_costs(page, guide);
  }
  add_table(
      page, "Largest stable steps",
      "Measured in runs, in which the energy must not grow. *theory_dt_s* is from linear theory with the "
      "spectrum of the scene at its start and during the run. *gershgorin_dt_s*, which `mssim check` shows, "
      "is a safe bound: it assumes that all springs of a node are parallel and all its neighbours move "
      "against it.",
      limits_table(guide));
  add_cloths(page, guide);
}

Cell finite(double value) { return std::isfinite(value) ? Cell(value) : Cell(); }

/// Empty if a search found no value.
Cell found(double value) { return value > 0 ? Cell(value) : Cell(); }

std::string_view state_of(const WorkPoint& point) {
  if (point.diverged) return "diverged";
  if (!point.within_limit) return "longer than the largest stable step";
  return point.beyond_trust ? "within the reference's error" : "ok";
}

bool is_recommended(const SceneGuide& guide, const WorkPoint& point) {
  const auto& best = guide.recommendation.best;
  return best && &point == point_at_error(guide.methods[*best], guide.wish.error);
}

/// Adds a point of the method or, if it is null, why the method has none.
void add_point(Table& table, const SceneGuide& guide, const GuidedMethod& method, const WorkPoint* point) {
  const auto of_point = [&](const auto& value) { return point ? Cell(std::invoke(value, *point)) : Cell(); };
  table.add({{"nodes", guide.nodes},
             {"springs_unique", guide.springs},
             {"integrator", method.integrator->name},
             {"backend", method.backend->name},
             {"dt_s", of_point(&WorkPoint::dt_s)},
             {"steps", of_point(&WorkPoint::steps)},
             {"horizon_s", guide.trusted.horizon_s},
             {"position_error", of_point(&WorkPoint::position_error)},
             {"energy_error", of_point(&WorkPoint::energy_error)},
             {"solver_error", of_point(&WorkPoint::solver_error)},
             {"step_error", of_point(&WorkPoint::step_error)},
             {"reference_error", point ? Cell(guide.trusted.error()) : Cell()},
             {"ms_per_step", point ? Cell(1000 * point->seconds_a_step) : Cell()},
             {"wall_s_per_s", of_point(&WorkPoint::seconds_a_second)},
             {"force_evaluations_per_s",
              point && point->evaluations ? Cell(*point->evaluations / point->dt_s) : Cell()},
             {"samples", of_point(&WorkPoint::samples)},
             {"diverged", of_point(&WorkPoint::diverged)},
             {"on_front", of_point(&WorkPoint::on_front)},
             {"status", point ? Cell(state_of(*point)) : Cell(method.ending.status())},
             {"note", of_point(&WorkPoint::note)},
             {"recommended", point ? Cell(is_recommended(guide, *point)) : Cell()}});
}

Table points_table(const SceneGuide& guide) {
  Table table;
  for (const GuidedMethod& method : guide.methods) {
    for (const WorkPoint& point : method.points) add_point(table, guide, method, &point);
    if (method.points.empty()) add_point(table, guide, method, nullptr);
  }
  return table;
}

Table steps_table(const SceneGuide& guide) {
  Table table;
  for (const StepLimit& limit : guide.limits)
    table.add({{"integrator", limit.integrator->name},
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
               {"status", limit.ending.status()}});
  return table;
}

Table errors_table(const SceneGuide& guide) {
  Table table;
  for (const GuidedMethod& method : guide.methods)
    for (const double error : errors_around(guide.wish))
      if (const auto cost = cost_at_error(method, error))
        table.add({{"integrator", method.integrator->name},
                   {"backend", method.backend->name},
                   {"position_error", error},
                   {"wall_s_per_s", cost->seconds_a_second},
                   {"at_longest_step", cost->at_longest_step},
                   {"dt_s", cost->dt_s}});
  return table;
}

Table sizes_table(const SceneGuide& guide) {
  Table table;
  for (const SizeCurve& curve : guide.sizes)
    for (const SizeCurve::Sample& sample : curve.samples)
      table.add({{"integrator", curve.integrator->name},
                 {"backend", curve.backend->name},
                 {"dt_s", curve.dt_s},
                 {"nodes", sample.nodes},
                 {"ms_per_step", 1000 * sample.seconds_a_step}});
  return table;
}

Table frames_table(const SceneGuide& guide) {
  Table table;
  for (const SizeCurve& curve : guide.sizes)
    for (const double rate : frame_rates) {
      const auto largest = curve.largest(rate);
      table.add({{"integrator", curve.integrator->name},
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

/// The longest step that keeps the error, else the most accurate point; null if no point counts.
const WorkPoint* point_to_show(const SceneGuide& guide, const GuidedMethod& method) {
  const WorkPoint* point = point_at_error(method, guide.wish.error);
  return point != nullptr ? point : most_accurate(method);
}

/// The rows of every guide, with its scene in the first column.
Table of_all(std::span<const SceneGuide> guides, Table (*table_of)(const SceneGuide& guide)) {
  Table all;
  for (const SceneGuide& guide : guides) {
    Table table = table_of(guide);
    if (all.rows.empty() && !table.rows.empty()) {
      all.columns = std::move(table.columns);
      all.columns.insert(all.columns.begin(), {"scene"});
    }
    for (std::vector<Cell>& row : table.rows) {
      row.insert(row.begin(), Cell(guide.scene));
      all.rows.push_back(std::move(row));
    }
  }
  return all;
}

/// For each scene: the recommendation, the methods, the reference, the front, the largest stable steps with
/// the reasons for differences from theory, and the largest cloths.
Document guide_page(std::span<const SceneGuide> guides, const Provenance& provenance) {
  Document page{
      Heading{1, "Which integrator, which backend, which step"}, measured_on({}, provenance),
      Paragraph{
          "*wall_s_per_s*: wall seconds per simulated second at the measured step; *at_error_s_per_s*: at "
          "the requested error. *position_error*: largest distance of a node from its reference position, in "
          "mean rest lengths. *energy_error*: error of the total energy, relative to kinetic plus elastic "
          "energy. docs/guide.md describes how each number is found."}};
  for (const SceneGuide& guide : guides) add_scene(page, guide);
  return page;
}

}  // namespace

std::vector<std::string> about_trusted_state(const TrustedState& trusted) {
  std::vector<std::string> sentences;
  sentences.push_back("Errors are measured " + two_digits(trusted.horizon_s) + " s after the start (" +
                      trusted.why_there + "). At this time, a neighbouring trajectory is " +
                      two_digits(trusted.parting) + " times as far away as at the start.");
  std::string reference = "The reference is rk4 in double precision with a step of " +
                          two_digits(trusted.dt_s) + " s, whose own error is " +
                          two_digits(trusted.own_error) + " mean rest lengths";
  if (trusted.confirmed)
    reference += "; another solver (Bulirsch-Stoer) ends " + two_digits(*trusted.confirmed) + " from it";
  else
    reference += "; there was no time to confirm it with another solver";
  sentences.push_back(reference + ".");
  sentences.push_back("Points whose error is below " + two_digits(trusted.least_error()) + " (" +
                      two_digits(trusted_margin) +
                      " times that of the reference) are marked and not compared.");
  return sentences;
}

Table guide_summary(const SceneGuide& guide) {
  // First the methods that keep the error, by their cost; then the others, by their error.
  const auto order = ordered_places(guide.methods, [&](const GuidedMethod& method) {
    if (const auto cost = cost_at_error(method, guide.wish.error))
      return std::pair(0, cost->seconds_a_second);
    const WorkPoint* point = most_accurate(method);
    return point != nullptr ? std::pair(1, *point->position_error) : std::pair(2, 0.0);
  });
  Table table;
  for (const std::size_t place : order) {
    const GuidedMethod& method = guide.methods[place];
    const StepLimit* limit = found_in(guide.limits, method.integrator, &StepLimit::integrator);
    const WorkPoint* point = point_to_show(guide, method);
    const double rate = guide.wish.frames_per_second;
    const auto cost = cost_at_error(method, guide.wish.error);
    const std::string_view accurate = cost ? "yes" : "no";
    table.add({{"integrator", method.integrator->name},
               {"backend", method.backend->name},
               {"stable_dt_s", found(limit->measured.stable_s)},
               {"dt_s", point ? Cell(point->dt_s) : Cell()},
               {"steps_per_frame", point ? Cell(steps_a_frame(point->dt_s, rate)) : Cell()},
               {"wall_s_per_s", point ? Cell(point->seconds_a_second()) : Cell()},
               {"at_error_s_per_s", cost ? Cell(cost->seconds_a_second) : Cell()},
               {"position_error", point ? Cell(point->position_error) : Cell()},
               {"energy_error", point ? Cell(point->energy_error) : Cell()},
               {"accurate", point ? Cell(accurate) : Cell()},
               {"on_front", point ? Cell(point->on_front) : Cell()},
               {"remark", worded(method.ending.status())}});
  }
  return table;
}

std::vector<ResultTable> guide_tables(std::span<const SceneGuide> guides, const Provenance& provenance) {
  std::vector<ResultTable> tables{{"guide", of_all(guides, points_table), guide_page(guides, provenance)},
                                  {"guide-steps", of_all(guides, steps_table), {}},
                                  {"guide-errors", of_all(guides, errors_table), {}},
                                  {"guide-sizes", of_all(guides, sizes_table), {}},
                                  {"guide-frames", of_all(guides, frames_table), {}},
                                  {"guide-crossovers", of_all(guides, crossovers_table), {}}};
  std::erase_if(tables, [](const ResultTable& table) { return table.data.rows.empty(); });
  return tables;
}

}  // namespace mssim
