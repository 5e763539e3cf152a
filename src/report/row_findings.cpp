#include <algorithm>
#include <array>

#include "output/tables/result_table.h"
#include "report/finding.h"
#include "report/times_as_fast.h"
#include "text/text.h"

namespace mssim {
namespace {

std::string row_name(const ResultRow& row) {
  return "`" + row.backend + "` on `" + row.scene + "`, " + row.integrator;
}

const ResultRow* serial_row(std::span<const ResultRow> rows, const ResultRow& row) {
  const auto found = std::ranges::find_if(rows, [&](const ResultRow& candidate) {
    return candidate.scene == row.scene && candidate.backend == "serial" &&
           candidate.integrator == row.integrator;
  });
  return found == rows.end() ? nullptr : &*found;
}

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

Finding about_one(std::span<const ResultRow> rows) {
  std::vector<std::string> near_one;
  std::size_t all = 0;
  for (const ResultRow& row : rows) {
    const ResultRow* serial = serial_row(rows, row);
    if (!serial || serial == &row) continue;
    const auto ratio = times_as_fast(row, *serial);
    if (!ratio) continue;
    ++all;
    if (side_of_one(*ratio) == 0)
      near_one.push_back(row_name(row) + " (" + three_digits(ratio->low) + " to " +
                         three_digits(ratio->high) + ")");
  }
  if (all == 0)
    return {Outcome::fact, "There are no speed-ups: no row that counts stands beside one of `serial`."};
  std::string sentence = "Of " + pluralize(all, "speed-up") + " over `serial`, ";
  if (near_one.empty()) return {Outcome::fact, sentence + "all have an interval that does not hold 1."};
  return {Outcome::fact, sentence + subject(near_one.size(), "interval", " holds 1", " hold 1") +
                             ", so that neither is certainly the faster: " + join(near_one, "; ") + "."};
}

}  // namespace

std::string_view name_of(Outcome outcome) {
  constexpr std::array<std::string_view, 6> names{"reproduced", "partly reproduced", "not reproduced",
                                                  "undecided",  "measured",          "not verified"};
  return names[static_cast<std::size_t>(outcome)];
}

Outcome outcome_of(std::uint64_t all, std::uint64_t as_published, std::uint64_t contrary) {
  if (contrary > 0) return Outcome::not_reproduced;
  if (as_published == all) return Outcome::reproduced;
  return as_published == 0 ? Outcome::undecided : Outcome::partly;
}

std::vector<Finding> row_findings(std::span<const ResultRow> rows, const Provenance& provenance) {
  std::vector<Finding> findings;
  if (rows.empty()) return findings;
  if (const std::string devices = devices_of(rows, provenance); !devices.empty())
    findings.push_back(
        {Outcome::fact, "Published GPUs are those of mobile devices. Measured here: " + devices + "."});
  std::vector<std::string> not_verified, without_time;
  for (const ResultRow& row : rows) {
    if (counts(row)) continue;
    if (row.status == "ok")
      not_verified.push_back(row_name(row));
    else
      without_time.push_back(row_name(row));
  }
  if (not_verified.empty()) {
    const auto timed = static_cast<std::size_t>(std::ranges::count_if(rows, counts));
    findings.push_back(
        {Outcome::fact, subject(timed, "row", " has a time, and is", " have a time, and all are") +
                            " verified against the double-precision reference."});
  } else {
    findings.push_back(
        {Outcome::warning, subject(not_verified.size(), "row", " is", " are") +
                               " not verified, and count nowhere: " + join(not_verified, "; ") + "."});
  }
  if (!without_time.empty())
    findings.push_back({Outcome::fact, subject(without_time.size(), "row", " has", " have") +
                                           " no time; the list below the tables says why."});
  findings.push_back(about_one(rows));
  return findings;
}

}  // namespace mssim
