#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

#include "report/report_internal.h"
#include "statistics/statistics.h"
#include "text/text.h"

namespace mssim {

std::optional<RatioInterval> times_as_fast(const ResultRow* row, const ResultRow* than) {
  if (!row || !than || !counts(*row) || !counts(*than)) return std::nullopt;
  if (!row->samples_ms.empty() && row->samples_ms.size() == than->samples_ms.size()) {
    const MedianInterval ratio = median_ratio(than->samples_ms, row->samples_ms);
    return RatioInterval{ratio.median, ratio.low, ratio.high};
  }
  if (!row->ms_per_step || !than->ms_per_step) return std::nullopt;
  const auto end = [](const ResultRow& of, std::optional<double> ResultRow::*value) {
    return (of.*value).value_or(*of.ms_per_step);
  };
  return RatioInterval{*than->ms_per_step / *row->ms_per_step,
                       end(*than, &ResultRow::ms_per_step_low) / end(*row, &ResultRow::ms_per_step_high),
                       end(*than, &ResultRow::ms_per_step_high) / end(*row, &ResultRow::ms_per_step_low)};
}

std::optional<double> exponent_of(std::span<const double> x, std::span<const double> y) {
  double mean_x = 0, mean_y = 0, across = 0, along = 0;
  const auto count = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += std::log(x[i]) / count;
    mean_y += std::log(y[i]) / count;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = std::log(x[i]) - mean_x;
    across += dx * (std::log(y[i]) - mean_y);
    along += dx * dx;
  }
  if (!(along > 0)) return std::nullopt;
  return across / along;
}

PaperScenes::PaperScenes(std::span<const ResultRow> rows, const PaperLegend& legend,
                         const PublishedTable& published)
    : rows_(rows), legend_(legend), published_(published), scenes_(published.scenes_of(rows)) {}

std::string PaperScenes::label() const {
  // The title says what is measured, the table, and whose it is: "Cloth: Table 1 of Hong et al. (2016)".
  const std::string_view title = published_.info().title;
  const std::size_t colon = title.find(": "), from = colon == std::string_view::npos ? 0 : colon + 2;
  return std::string(title.substr(from, title.find(" of ", from) - from));
}

std::optional<double> PaperScenes::published_ms(const PaperScene& scene, std::string_view integrator,
                                                std::string_view configuration) const {
  return published_.ms(integrator, configuration, scene.nodes, scene.springs);
}

std::optional<double> PaperScenes::published_speedup(const PaperScene& scene, std::string_view integrator,
                                                     std::string_view configuration) const {
  return published_.speedup(integrator, configuration, scene);
}

const ResultRow* PaperScenes::row(const PaperScene& scene, std::string_view backend,
                                  std::string_view integrator) const {
  const auto found = std::ranges::find_if(rows_, [&](const ResultRow& row) {
    return row.scene == scene.name && row.backend == backend && row.integrator == integrator;
  });
  return found == rows_.end() ? nullptr : &*found;
}

std::vector<std::string> PaperScenes::backends_of(std::string_view configuration) const {
  std::vector<std::string> names;
  for (const PaperLegend::Backend& backend : legend_.backends) {
    if (backend.configuration != configuration) continue;
    const bool has_time = std::ranges::any_of(legend_.integrators, [&](const auto& integrator) {
      return std::ranges::any_of(scenes_, [&](const PaperScene& scene) {
        const ResultRow* found = row(scene, backend.name, integrator.name);
        return found && counts(*found);
      });
    });
    if (has_time) names.push_back(backend.name);
  }
  return names;
}

std::string_view name_of(Outcome outcome) {
  constexpr std::array<std::string_view, 6> names{"reproduced", "partly reproduced", "not reproduced",
                                                  "undecided",  "measured",          "not verified"};
  return names[static_cast<std::size_t>(outcome)];
}

namespace {

/// How many of so many comparisons are as published, and how many contradict it.
Outcome outcome_of(std::uint64_t all, std::uint64_t as_published, std::uint64_t contrary) {
  if (contrary > 0) return Outcome::not_reproduced;
  if (as_published == all) return Outcome::reproduced;
  return as_published == 0 ? Outcome::undecided : Outcome::partly;
}

std::string row_name(const ResultRow& row) {
  return fmt::format("`{}` on `{}`, {}", row.backend, row.scene, row.integrator);
}

// Orders

/// The size from which on a backend is faster, where it is not so at smaller ones; nothing where that changes
/// never or more than once. `sides`: 1 where it is faster, from size to size.
std::string crossover(const std::vector<int>& sides, const std::vector<std::uint64_t>& nodes,
                      const std::string& integrator) {
  const auto first = std::ranges::find(sides, 1);
  if (first == sides.begin() || first == sides.end() ||
      !std::all_of(first, sides.end(), [](int side) { return side == 1; }))
    return {};
  return grouped(nodes[static_cast<std::size_t>(first - sides.begin())]) + " nodes (" + integrator + ")";
}

std::string crossovers(const std::vector<std::string>& list) {
  return list.empty() ? "" : fmt::format(" It becomes faster from {} on.", join(list, ", "));
}

/// Over sizes and integrators; none where nothing can be compared.
std::optional<Finding> order_finding(const PaperScenes& scenes, const PaperConfiguration& first,
                                     const PaperConfiguration& second, const std::string& first_backend,
                                     const std::string& second_backend) {
  std::uint64_t all = 0, published_faster = 0, as_published = 0, contrary = 0, faster = 0, slower = 0;
  std::vector<std::string> published_crossovers, measured_crossovers;
  for (const PaperLegend::Integrator& integrator : scenes.legend().integrators) {
    if (integrator.name != integrator.paper_name) continue;
    std::vector<int> published, measured;
    std::vector<std::uint64_t> nodes;
    for (const PaperScene& scene : scenes.scenes()) {
      const auto a = scenes.published_ms(scene, integrator.paper_name, first.name);
      const auto b = scenes.published_ms(scene, integrator.paper_name, second.name);
      const auto ratio = times_as_fast(scenes.row(scene, second_backend, integrator.name),
                                       scenes.row(scene, first_backend, integrator.name));
      if (!a || !b || !ratio) continue;
      const int side = ratio->side_of_one(), wanted = *b < *a ? 1 : -1;
      all += 1;
      published_faster += wanted == 1;
      as_published += side == wanted;
      contrary += side == -wanted;
      faster += side == 1;
      slower += side == -1;
      published.push_back(wanted);
      measured.push_back(side);
      nodes.push_back(scene.nodes);
    }
    if (auto text = crossover(published, nodes, integrator.name); !text.empty())
      published_crossovers.push_back(std::move(text));
    if (auto text = crossover(measured, nodes, integrator.name); !text.empty())
      measured_crossovers.push_back(std::move(text));
  }
  if (all == 0) return std::nullopt;
  return Finding{
      outcome_of(all, as_published, contrary),
      fmt::format("{}: {} is faster than {} in {} of {} of size and integrator.{} Measured: `{}` is "
                  "faster than `{}` in {}, slower in {}, and cannot be told apart in {}.{}",
                  scenes.label(), second.caption, first.caption, published_faster,
                  pluralize(all, "combination"), crossovers(published_crossovers), second_backend,
                  first_backend, faster, slower, all - faster - slower, crossovers(measured_crossovers))};
}

// Falls of speed-ups

/// A speed-up at two neighbouring sizes.
struct SizeStep {
  const PaperScene& from;
  const PaperScene& to;
  std::string integrator;
  double published_from, published_to;
  RatioInterval measured_from, measured_to;

  bool published_falls() const { return published_to < published_from * (1 - published_fall); }
  bool measured_falls() const { return measured_to.high < measured_from.low; }
  bool measured_rises() const { return measured_to.low > measured_from.high; }
};

std::vector<SizeStep> steps_of(const PaperScenes& scenes, std::string_view configuration,
                               const std::string& backend, const std::string& one_thread) {
  std::vector<SizeStep> steps;
  for (const PaperLegend::Integrator& integrator : scenes.legend().integrators) {
    if (integrator.name != integrator.paper_name) continue;
    const auto published = [&](const PaperScene& scene) {
      return scenes.published_speedup(scene, integrator.name, configuration);
    };
    const auto measured = [&](const PaperScene& scene) {
      return times_as_fast(scenes.row(scene, backend, integrator.name),
                           scenes.row(scene, one_thread, integrator.name));
    };
    for (std::size_t i = 1; i < scenes.scenes().size(); ++i) {
      const PaperScene &from = scenes.scenes()[i - 1], &to = scenes.scenes()[i];
      const auto published_from = published(from), published_to = published(to);
      const auto measured_from = measured(from), measured_to = measured(to);
      if (published_from && published_to && measured_from && measured_to)
        steps.push_back(
            {from, to, integrator.name, *published_from, *published_to, *measured_from, *measured_to});
    }
  }
  return steps;
}

std::string from_to(double from, double to) { return three_digits(from) + "× to " + three_digits(to) + "×"; }

Finding trend_finding(const PaperScenes& scenes, const std::vector<SizeStep>& steps, std::string_view caption,
                      const std::string& backend) {
  std::uint64_t falls = 0, also_falls = 0, rises = 0, any_falls = 0;
  const SizeStep* deepest = nullptr;
  for (const SizeStep& step : steps) {
    any_falls += step.measured_falls();
    if (!step.published_falls()) continue;
    falls += 1;
    also_falls += step.measured_falls();
    rises += step.measured_rises();
    if (!deepest || step.published_to / step.published_from < deepest->published_to / deepest->published_from)
      deepest = &step;
  }
  const std::string about = fmt::format("{}: the speed-up of {}", scenes.label(), caption);
  const std::string of_steps = " of " + pluralize(steps.size(), "step");
  if (!deepest)
    return {any_falls == 0 ? Outcome::reproduced : Outcome::not_reproduced,
            fmt::format("{} never falls from one size to the next. Measured: that of `{}` falls in {}{}.",
                        about, backend, any_falls, of_steps)};
  const std::string what = deepest->measured_falls()   ? "falls, too"
                           : deepest->measured_rises() ? "rises"
                                                       : "does not certainly change";
  return {
      outcome_of(falls, also_falls, rises),
      fmt::format("{} falls in {}{} from one size to the next, most from {} to {} nodes with {} ({}). There "
                  "the measured one of `{}` {} ({}). Of all the published falls it follows {}, rises in {}, "
                  "and is undecided in {}.",
                  about, falls, of_steps, grouped(deepest->from.nodes), grouped(deepest->to.nodes),
                  deepest->integrator, from_to(deepest->published_from, deepest->published_to), backend, what,
                  from_to(deepest->measured_from.ratio, deepest->measured_to.ratio), also_falls, rises,
                  falls - also_falls - rises)};
}

// Costs of integrators: ratios over the sizes of a table

std::vector<double> published_costs(const PaperScenes& scenes, const std::string& integrator,
                                    const std::string& cheapest, std::string_view configuration) {
  std::vector<double> ratios;
  for (const PaperScene& scene : scenes.scenes()) {
    const auto ms = scenes.published_ms(scene, integrator, configuration);
    const auto base = scenes.published_ms(scene, cheapest, configuration);
    if (ms && base) ratios.push_back(*ms / *base);
  }
  return ratios;
}

std::vector<double> measured_costs(const PaperScenes& scenes, const std::string& integrator,
                                   const std::string& cheapest, const std::string& backend) {
  std::vector<double> ratios;
  for (const PaperScene& scene : scenes.scenes())
    if (const auto ratio =
            times_as_fast(scenes.row(scene, backend, cheapest), scenes.row(scene, backend, integrator)))
      ratios.push_back(ratio->ratio);
  return ratios;
}

/// "1.23 (0.98 to 1.5, below 1 at 1 of 6 sizes)": the geometric mean and the range.
std::string mean_and_range(const std::vector<double>& ratios) {
  const auto below = std::ranges::count_if(ratios, [](double ratio) { return ratio < 1; });
  return fmt::format(
      "{} ({} to {}{})", three_digits(geometric_mean(ratios)), three_digits(std::ranges::min(ratios)),
      three_digits(std::ranges::max(ratios)),
      below == 0 ? "" : fmt::format(", below 1 at {} of {}", below, pluralize(ratios.size(), "size")));
}

std::string evaluations(int number) { return pluralize(number, "force evaluation"); }

/// What a published cost suggests of a method that evaluates the forces so many times.
std::string suggestion(double published_mean, int number) {
  const double log_cost = std::log(published_mean), log_all = std::log(static_cast<double>(number));
  return std::abs(log_cost) < std::abs(log_cost - log_all)
             ? "about what one force evaluation costs, though the method has " + evaluations(number)
             : fmt::format("about what its {} cost", evaluations(number));
}

// Rows

std::string subject(std::size_t number, const std::string& noun, const std::string& one,
                    const std::string& several) {
  return pluralize(number, noun) + (number == 1 ? one : several);
}

/// "`opencl` on DEVICE", of every backend that ran on one.
std::string devices_of(std::span<const ResultRow> rows, const Provenance& provenance) {
  const std::vector<const ResultRow*> pointers = pointers_to(rows);
  std::vector<std::string> labels;
  for (const ResultRow& row : rows) {
    if (opencl_device(row).empty()) continue;
    const std::string label = backend_label(pointers, row.backend, provenance);
    if (std::ranges::find(labels, label) == labels.end()) labels.push_back(label);
  }
  return join(labels, "; ");
}

Finding about_speedups(std::span<const ResultRow> rows) {
  const std::vector<const ResultRow*> pointers = pointers_to(rows);
  std::vector<std::string> near_one;
  std::size_t all = 0;
  for (const ResultRow& row : rows) {
    const ResultRow* serial = find_row(pointers, row.scene, baseline_name, row.integrator);
    const auto ratio = serial == &row ? std::nullopt : times_as_fast(&row, serial);
    if (!ratio) continue;
    ++all;
    if (ratio->side_of_one() == 0)
      near_one.push_back(
          fmt::format("{} ({} to {})", row_name(row), three_digits(ratio->low), three_digits(ratio->high)));
  }
  if (all == 0)
    return {Outcome::fact, "There are no speed-ups: no row that counts stands beside one of `serial`."};
  return {Outcome::fact, "Of " + pluralize(all, "speed-up") + " over `serial`, " +
                             (near_one.empty() ? "all have an interval that does not hold 1."
                                               : subject(near_one.size(), "interval", " holds 1", " hold 1") +
                                                     ", so that neither is certainly the faster: " +
                                                     join(near_one, "; ") + ".")};
}

}  // namespace

std::vector<Finding> order_findings(const PaperScenes& scenes) {
  std::vector<Finding> findings;
  for (auto first = paper_configurations.begin(); first != paper_configurations.end(); ++first)
    for (auto second = first + 1; second != paper_configurations.end(); ++second)
      for (const std::string& first_backend : scenes.backends_of(first->name))
        for (const std::string& second_backend : scenes.backends_of(second->name))
          if (auto finding = order_finding(scenes, *first, *second, first_backend, second_backend))
            findings.push_back(std::move(*finding));
  return findings;
}

std::vector<Finding> trend_findings(const PaperScenes& scenes) {
  std::vector<Finding> findings;
  const std::vector<std::string> one_thread = scenes.backends_of(one_thread_configuration);
  if (one_thread.empty()) return findings;
  for (const PaperConfiguration& configuration : paper_configurations) {
    if (configuration.name == one_thread_configuration) continue;
    for (const std::string& backend : scenes.backends_of(configuration.name)) {
      const auto steps = steps_of(scenes, configuration.name, backend, one_thread.front());
      if (!steps.empty()) findings.push_back(trend_finding(scenes, steps, configuration.caption, backend));
    }
  }
  return findings;
}

std::vector<Finding> cost_findings(const PaperScenes& scenes) {
  std::vector<Finding> findings;
  const auto& integrators = scenes.legend().integrators;
  if (integrators.empty()) return findings;
  const std::string cheapest = integrators.front().name;
  for (const PaperLegend::Integrator& integrator : integrators) {
    if (integrator.paper_name == cheapest) continue;
    // The published method; one that holds forces stands for the same.
    const auto method = std::ranges::find(integrators, integrator.paper_name, &PaperLegend::Integrator::name);
    const int in_method = (method == integrators.end() ? integrator : *method).force_evaluations;
    for (const PaperConfiguration& configuration : paper_configurations) {
      const auto published = published_costs(scenes, integrator.paper_name, cheapest, configuration.name);
      if (published.empty()) continue;
      const double mean = geometric_mean(published);
      std::vector<std::string> costs;
      std::size_t alike = 0;
      for (const std::string& backend : scenes.backends_of(configuration.name)) {
        const auto measured = measured_costs(scenes, integrator.name, cheapest, backend);
        if (measured.empty()) continue;
        costs.push_back(fmt::format("`{}` {}", backend, mean_and_range(measured)));
        alike += std::abs(std::log(geometric_mean(measured) / mean)) <= std::log(cost_tolerance);
      }
      if (costs.empty()) continue;
      findings.push_back(
          {alike == costs.size() ? Outcome::reproduced
           : alike == 0          ? Outcome::not_reproduced
                                 : Outcome::partly,
           fmt::format("{}: with {} a step of {} costs {} steps of {}, {}. Measured, `{}` with {}: {}.",
                       scenes.label(), configuration.caption, integrator.paper_name,
                       mean_and_range(published), cheapest, suggestion(mean, in_method), integrator.name,
                       evaluations(integrator.force_evaluations), join(costs, ", "))});
    }
  }
  return findings;
}

std::vector<Finding> garment_findings(std::span<const ResultRow> rows) {
  /// Seconds in which the jeans of Vassilev are put on, on a smart phone.
  constexpr double published_dressing_s = 2;
  std::vector<Finding> findings;
  const std::vector<const ResultRow*> pointers = pointers_to(rows);
  std::map<std::string, std::vector<const ResultRow*>> by_backend;
  for (const ResultRow& row : rows)
    if (row.dressing && counts(row)) by_backend[row.backend].push_back(&row);
  for (const auto& [backend, list] : by_backend) {
    if (backend == baseline_name) continue;
    std::size_t all = 0, faster = 0, slower = 0;
    const ResultRow* largest = list.front();
    for (const ResultRow* row : list) {
      if (row->nodes >= largest->nodes) largest = row;
      const auto ratio = times_as_fast(row, find_row(pointers, row->scene, baseline_name, row->integrator));
      if (!ratio) continue;
      ++all;
      faster += ratio->side_of_one() == 1;
      slower += ratio->side_of_one() == -1;
    }
    if (all > 0)
      findings.push_back(
          {outcome_of(all, faster, slower),
           fmt::format("Figure 6 of Vassilev: an iteration takes less time with parallelisation "
                       "than without. Measured: `{}` is faster than `serial` in {} of {}, slower in {}.",
                       backend, faster, pluralize(all, "size"), slower)});
    findings.push_back(
        {Outcome::fact, fmt::format("Vassilev: dressing a body in jeans takes {} s on a smart phone. "
                                    "Measured: `{}` dresses `{}` ({} vertices) in {} s on this machine.",
                                    three_digits(published_dressing_s), backend, largest->scene,
                                    grouped(largest->nodes), three_digits(largest->dressing->wall_s))});
  }
  return findings;
}

std::vector<Finding> row_findings(std::span<const ResultRow> rows, const Provenance& provenance) {
  std::vector<Finding> findings;
  if (rows.empty()) return findings;
  if (const std::string devices = devices_of(rows, provenance); !devices.empty())
    findings.push_back(
        {Outcome::fact, "Published GPUs are those of mobile devices. Measured here: " + devices + "."});
  std::vector<std::string> not_verified;
  std::size_t timed = 0, without_time = 0;
  for (const ResultRow& row : rows)
    if (counts(row))
      ++timed;
    else if (row.status == "ok")
      not_verified.push_back(row_name(row));
    else
      ++without_time;
  if (not_verified.empty())
    findings.push_back(
        {Outcome::fact, subject(timed, "row", " has a time, and is", " have a time, and all are") +
                            " verified against the double-precision reference."});
  else
    findings.push_back({Outcome::warning, subject(not_verified.size(), "row", " is not verified, and counts",
                                                  " are not verified, and count") +
                                              " nowhere: " + join(not_verified, "; ") + "."});
  if (without_time > 0)
    findings.push_back({Outcome::fact, subject(without_time, "row", " has", " have") +
                                           " no time; the list below the tables says why."});
  findings.push_back(about_speedups(rows));
  return findings;
}

std::vector<Finding> findings_of(const ReportFolder& folder, const ReportInput& input) {
  std::vector<Finding> findings;
  const auto add = [&](std::vector<Finding> more) { std::ranges::move(more, std::back_inserter(findings)); };
  for (const PublishedTable& published : input.published) {
    const PaperScenes scenes(folder.rows, input.legend, published);
    add(order_findings(scenes));
    add(trend_findings(scenes));
    add(cost_findings(scenes));
  }
  add(garment_findings(folder.rows));
  add(row_findings(folder.rows, folder.provenance.value_or(Provenance())));
  return findings;
}

}  // namespace mssim
