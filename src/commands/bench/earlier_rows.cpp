#include "commands/bench/earlier_rows.h"

#include <algorithm>
#include <filesystem>

#include "bench/results/comparison.h"
#include "commands/bench/measured_run.h"
#include "output/folders/provenance_file.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

std::string revision(const BuildInfo& build) {
  return std::string(build.commit) + (build.dirty ? ", changed" : "");
}

/// One table shall not mix what different programs or machines measured, nor hold rows of which the
/// provenance says nothing.
void require_same_origin(const Provenance& earlier, const Provenance& now, const std::string& folder) {
  std::vector<std::string> all = differences(earlier, now);
  if (revision(earlier.build) != revision(now.build))
    all.push_back("the program was built from commit " + revision(earlier.build) + " and is now from " +
                  revision(now.build));
  if (earlier.backend_programs != now.backend_programs)
    all.emplace_back("a program that is a backend is not the same");
  std::vector<std::string> left_out;
  for (const SceneHash& scene : earlier.scenes)
    if (std::ranges::find(now.scenes, scene.name, &SceneHash::name) == now.scenes.end())
      left_out.push_back(printable(scene.name));
  if (!left_out.empty())
    all.push_back("it has results of " + join(left_out, ", ") + ", which this command leaves out");
  require_resumable(all, folder);
}

}  // namespace

void require_resumable(const std::vector<std::string>& differences, const std::string& folder) {
  if (!differences.empty())
    throw UsageError("--resume cannot continue in " + folder + ": " + join(differences, "; ") +
                     "; choose another --out, or --overwrite to measure anew");
}

std::vector<ResultRow> earlier_rows(ResultFolder& folder, const BenchPlan& plan) {
  if (!folder.has_results()) return {};
  const BenchOutput& output = plan.output;
  if (output.resume) {
    const Provenance earlier = read_provenance(std::filesystem::path(output.folder) / "provenance.json");
    require_same_origin(earlier, plan.provenance, output.folder);
    folder.go_on_with(earlier);
    return folder.has_rows() ? read_run(output.folder).rows : std::vector<ResultRow>();
  }
  if (!output.overwrite)
    throw UsageError(output.folder +
                     " already holds results: give another --out, --resume to continue them, "
                     "or --overwrite to replace them");
  folder.replace_results();
  return {};
}

}  // namespace mssim
