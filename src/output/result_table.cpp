#include "output/result_table.h"

#include <set>
#include <sstream>

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

std::string remark_on(const ResultRow& row) {
  return "- `" + row.scene + "`, `" + row.backend + "`, `" + row.integrator +
         "`: " + one_cell(status_of(row)) + "\n";
}

}  // namespace mssim
