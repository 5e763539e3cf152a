#include <algorithm>
#include <cmath>

#include "report/report_internal.h"
#include "text/text.h"

namespace mssim {

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

namespace {

std::string row_name(const ResultRow& row) {
  return fmt::format("`{}` on `{}`, {}", row.backend, row.scene, row.integrator);
}

std::string subject(std::size_t number, const std::string& noun, const std::string& one,
                    const std::string& several) {
  return pluralize(number, noun) + (number == 1 ? one : several);
}

/// "`opencl` on DEVICE" for each backend that ran on an OpenCL device.
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
  std::string_view baseline = baseline_name;
  std::size_t all = 0;
  for (const ResultRow& row : rows) {
    const ResultRow* serial = baseline_of(pointers, row);
    const auto ratio = serial == &row ? std::nullopt : times_as_fast(&row, serial);
    if (!ratio) continue;
    ++all;
    baseline = serial->backend;
    if (ratio->side_of_one() == 0)
      near_one.push_back(
          fmt::format("{} ({} to {})", row_name(row), three_digits(ratio->low), three_digits(ratio->high)));
  }
  if (all == 0)
    return {false,
            fmt::format("There are no speed-ups: no row that counts has a row of `{}` to compare with.",
                        baseline)};
  return {false, pluralize(all, "speed-up") + fmt::format(" over `{}`: ", baseline) +
                     (near_one.empty()
                          ? "no interval includes 1."
                          : subject(near_one.size(), "interval", " includes 1", " include 1") +
                                ", so neither backend is certainly faster: " + join(near_one, "; ") + ".")};
}

}  // namespace

std::vector<Finding> row_findings(std::span<const ResultRow> rows, const Provenance& provenance) {
  std::vector<Finding> findings;
  if (rows.empty()) return findings;
  if (const std::string devices = devices_of(rows, provenance); !devices.empty())
    findings.push_back({false, fmt::format("The published GPU is that of a {}. Devices of these rows: {}.",
                                           paper_device, devices)});
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
    findings.push_back({false, subject(timed, "row", " has a time, and is", " have a time, and all are") +
                                   " verified against the double-precision reference."});
  else
    findings.push_back(
        {true, subject(not_verified.size(), "row", " is not verified and is", " are not verified and are") +
                   " excluded from all statistics: " + join(not_verified, "; ") + "."});
  if (without_time > 0)
    findings.push_back({false, subject(without_time, "row", " has", " have") +
                                   " no time; the list below the tables says why."});
  findings.push_back(about_speedups(rows));
  return findings;
}

}  // namespace mssim
