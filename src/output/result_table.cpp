#include "output/result_table.h"

#include <algorithm>
#include <set>
#include <sstream>
#include <utility>

#include "output/markdown.h"

namespace mssim {

std::string measured_on(std::span<const ResultRow* const> rows, const Provenance& provenance) {
  std::set<std::string> devices;
  for (const ResultRow* row : rows)
    if (!row->device.empty() && row->device != "cpu") devices.insert(row->device);
  std::ostringstream text;
  text << "Measured on " << provenance.machine.cpu_model << " (" << provenance.machine.logical_cpus
       << " logical CPUs) with " << provenance.threads << (provenance.threads == 1 ? " thread" : " threads");
  for (const std::string& device : devices) text << "; device " << device;
  text << "; mssim " << provenance.build.version << ", commit " << provenance.build.commit.substr(0, 12)
       << (provenance.build.dirty ? " with uncommitted changes" : "") << "; " << provenance.started_utc
       << ".\n\n";
  return text.str();
}

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
