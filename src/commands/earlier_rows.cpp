#include "commands/earlier_rows.h"

#include <string>

#include "bench/comparability.h"
#include "commands/exit_code.h"
#include "commands/measured_run.h"
#include "model/joined.h"

namespace mssim {
namespace {

std::string revision(const BuildInfo& build) {
  return std::string(build.commit) + (build.dirty ? ", changed" : "");
}

/// One table shall not mix what different programs or machines measured.
void require_same_origin(const Provenance& earlier, const Provenance& now, const std::string& folder) {
  std::vector<std::string> all = differences(earlier, now);
  if (revision(earlier.build) != revision(now.build))
    all.push_back("the program was of commit " + revision(earlier.build) + " and is of " +
                  revision(now.build));
  if (all.empty()) return;
  throw UsageError("--resume cannot go on in " + folder + ": " + joined(all, "; ") +
                   "; choose another --out, or --overwrite to measure anew");
}

}  // namespace

std::vector<ResultRow> earlier_rows(ResultFolder& folder, const Provenance& now,
                                    const BenchOptions& options) {
  if (!folder.has_rows()) return {};
  if (options.resume) {
    MeasuredRun earlier = read_run(options.out);
    require_same_origin(earlier.provenance, now, options.out);
    folder.go_on_with(earlier.provenance);
    return std::move(earlier.rows);
  }
  if (!options.overwrite)
    throw UsageError(options.out +
                     " holds results already: give another --out, --resume to go on with them, "
                     "or --overwrite to replace them");
  folder.clear();
  return {};
}

}  // namespace mssim
