#include <algorithm>
#include <map>
#include <optional>

#include "report/finding.h"
#include "report/times_as_fast.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Seconds in which the jeans of Vassilev are put on, on a smart phone.
constexpr double published_dressing_s = 2;

/// The rows of garments by backend, those that count, by size.
using GarmentRows = std::map<std::string, std::vector<const ResultRow*>>;

GarmentRows garment_rows(std::span<const ResultRow> rows) {
  GarmentRows of_backend;
  for (const ResultRow& row : rows)
    if (row.dressing && counts(row)) of_backend[row.backend].push_back(&row);
  for (auto& [backend, list] : of_backend)
    std::ranges::stable_sort(list, {}, [](const ResultRow* row) { return row->nodes; });
  return of_backend;
}

/// None where no size was measured with both.
std::optional<Finding> parallel_finding(const std::string& backend, const std::vector<const ResultRow*>& list,
                                        const std::vector<const ResultRow*>& serial) {
  std::size_t all = 0, faster = 0, slower = 0;
  for (const ResultRow* row : list) {
    const auto same = std::ranges::find_if(serial, [&](const ResultRow* candidate) {
      return candidate->scene == row->scene && candidate->integrator == row->integrator;
    });
    const auto ratio = same == serial.end() ? std::nullopt : times_as_fast(*row, **same);
    if (!ratio) continue;
    ++all;
    faster += side_of_one(*ratio) == 1;
    slower += side_of_one(*ratio) == -1;
  }
  if (all == 0) return std::nullopt;
  return Finding{outcome_of(all, faster, slower),
                 "Figure 6 of Vassilev: an iteration takes less time with parallelisation than without. "
                 "Measured: `" +
                     backend + "` is faster than `serial` in " + std::to_string(faster) + " of " +
                     pluralize(all, "size") + ", slower in " + std::to_string(slower) + "."};
}

Finding dressing_finding(const std::string& backend, const ResultRow& row) {
  const double seconds = row.dressing->wall_s;
  return {Outcome::fact, "Vassilev: dressing a body in jeans takes " + three_digits(published_dressing_s) +
                             " s on a smart phone. Measured: `" + backend + "` dresses `" + row.scene +
                             "` (" + grouped(row.nodes) + " vertices) in " + three_digits(seconds) +
                             " s on this machine."};
}

}  // namespace

std::vector<Finding> garment_findings(std::span<const ResultRow> rows) {
  std::vector<Finding> findings;
  const GarmentRows of_backend = garment_rows(rows);
  const auto serial = of_backend.find("serial");
  for (const auto& [backend, list] : of_backend) {
    if (backend == "serial") continue;
    if (serial != of_backend.end())
      if (auto finding = parallel_finding(backend, list, serial->second))
        findings.push_back(std::move(*finding));
    findings.push_back(dressing_finding(backend, *list.back()));
  }
  return findings;
}

}  // namespace mssim
