#include "output/tables/result_table.h"

#include <algorithm>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "output/tables/markdown.h"
#include "text/counted.h"

namespace mssim {

std::string measured_on(std::span<const ResultRow* const> rows, const Provenance& provenance) {
  std::set<std::string> devices;
  for (const ResultRow* row : rows)
    if (!row->device.empty() && row->device != "cpu") devices.insert(row->device);
  std::ostringstream text;
  text << "Measured on " << provenance.machine.cpu_model << " ("
       << counted(static_cast<std::uint64_t>(provenance.machine.logical_cpus), "logical CPU") << ") with "
       << counted(static_cast<std::uint64_t>(provenance.threads), "thread");
  for (const std::string& device : devices) text << "; device " << device;
  text << "; mssim " << provenance.build.version << ", commit " << provenance.build.commit.substr(0, 12)
       << (provenance.build.dirty ? " with uncommitted changes" : "") << "; " << provenance.started_utc
       << ".\n\n";
  return text.str();
}

std::string_view mark_of_excess(const ResultRow& row, int threads) {
  return exceeds(row, threads) ? " (!)" : "";
}

std::string legend_of_excess(std::span<const ResultRow* const> rows, int threads) {
  std::set<std::string> backends;
  for (const ResultRow* row : rows)
    if (exceeds(*row, threads)) backends.insert(row->backend + " (" + std::to_string(row->threads) + ")");
  if (backends.empty()) return {};
  std::string text = "(!) on more processors than the " + std::to_string(threads) +
                     " asked for, since its device cannot be divided: ";
  for (const std::string& backend : backends) text += (backend == *backends.begin() ? "" : ", ") + backend;
  return text;
}

std::string reason_without_speedups(std::span<const std::string_view> backends) {
  if (backends.empty() || std::ranges::find(backends, "serial") != backends.end()) return {};
  std::string all = "serial";
  for (const std::string_view backend : backends) all.append(",").append(backend);
  return "speed-ups are missing, since serial is not among the backends; add it: --backend " + all;
}

std::string reason_without_speedups(std::span<const ResultRow* const> rows) {
  std::vector<std::string_view> backends;
  for (const ResultRow* row : rows)
    if (std::ranges::find(backends, row->backend) == backends.end()) backends.emplace_back(row->backend);
  return reason_without_speedups(backends);
}

std::string paragraph(const std::string& sentence) { return sentence.empty() ? "" : "\n" + sentence + ".\n"; }

std::string rows_without_a_time(std::span<const ResultRow* const> rows) {
  std::vector<std::pair<std::string, std::string>> remarks;  // reason, scenes
  for (const ResultRow* row : rows) {
    if (counts(*row)) continue;
    const std::string reason =
        "`" + row->backend + "`, `" + row->integrator + "`: " + one_cell(status_of(*row));
    auto known = std::ranges::find(remarks, reason, &std::pair<std::string, std::string>::first);
    if (known == remarks.end()) known = remarks.insert(remarks.end(), {reason, ""});
    known->second += (known->second.empty() ? "`" : ", `") + row->scene + "`";
  }
  if (remarks.empty()) return {};
  std::string text = "\n## Rows without a time\n\n";
  for (const auto& [reason, scenes] : remarks) text += "- " + reason + " (" + scenes + ")\n";
  return text;
}

}  // namespace mssim
