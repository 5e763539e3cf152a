#include "commands/report/report_command.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <system_error>

#include "bench/machine/build_info.h"
#include "commands/bench/suites.h"
#include "commands/report/simulated_scenes.h"
#include "commands/shared/output_names.h"
#include "commands/shared/tell_first.h"
#include "platform/files.h"
#include "report/page.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  std::vector<std::string> folders;
  std::string out = "report.html";
  bool no_runs = false;
};

/// What to give in place of a folder without results: those in it that lead to some.
std::string below(const fs::path& folder) {
  std::string text;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_directory(error) && !result_folders(entry->path()).empty())
      text += (text.empty() ? "" : ", ") + printable(entry->path().string());
  return text.empty() ? "folders that mssim bench --out wrote" : "folders in it that have some: " + text;
}

/// The result folders that the given ones stand for. Throws UsageError for one that is none.
std::vector<fs::path> folders_of(const ReportOptions& options) {
  std::vector<fs::path> folders;
  for (const std::string& given : options.folders) {
    std::error_code error;
    if (!fs::is_directory(given, error))
      throw UsageError("there is no folder " + printable(given) +
                       ": give folders that mssim bench --out wrote");
    std::vector<fs::path> found = result_folders(given);
    if (found.empty()) throw UsageError(printable(given) + " has no results: give " + below(given));
    std::ranges::move(found, std::back_inserter(folders));
  }
  return folders;
}

std::vector<FoundCurve> reference_curves() {
  std::vector<FoundCurve> curves;
  std::error_code error;
  for (fs::directory_iterator entry(data_folder() / "reference", error), end; !error && entry != end;
       entry.increment(error))
    if (auto curve = energy_curve_in(entry->path().stem().string(), read_file(entry->path())))
      curves.push_back(std::move(*curve));
  return curves;
}

int report(const ReportOptions& options) {
  const std::vector<fs::path> folders = folders_of(options);
  const fs::path out = target_of(options.out);
  require_extension({"--out", out}, "HTML", {".html", ".htm"});
  AtomicFile(out).remove();  // finds what cannot be written before anything is read
  ReportInput input;
  input.made_by = "mssim " + build_info().version;
  input.legend = paper_legend();
  try {
    input.published = published_tables();
    input.tables = comparison_of_suite("tables").tables();
    input.references = reference_curves();
  } catch (const std::exception& error) {
    input.problems.push_back(std::string(error.what()) + "; nothing published is shown");
  }
  for (const fs::path& folder : folders) input.folders.push_back(read_report_folder(folder));
  if (!options.no_runs) {
    SimulatedScenes simulated = simulated_scenes(input.folders, input.references, input.problems);
    input.pictures = std::move(simulated.pictures);
    input.curves = std::move(simulated.curves);
  }
  write_file_atomically(out, report_page(input));
  for (const ReportFolder& folder : input.folders)
    input.problems.insert(input.problems.end(), folder.problems.begin(), folder.problems.end());
  tell_first(input.problems);
  std::cerr << "mssim: wrote " << printable(out.string()) << '\n';
  return exit_ok;
}

}  // namespace

std::function<int()> declare_report(Arguments& arguments) {
  const auto options = std::make_shared<ReportOptions>();
  arguments
      .add_list("DIR...", options->folders,
                "Folders that mssim bench --out wrote; a folder of such folders stands for all in it",
                [](std::string_view folder) { return std::vector{std::string(folder)}; })
      .required();
  arguments.add("--out", options->out, "File to write (default: report.html)").value_name("FILE");
  arguments.add_flag("--no-runs", options->no_runs,
                     "Simulate no scenes for pictures and energies, which takes seconds; what lies in the "
                     "folders is shown");
  return [options] { return report(*options); };
}

}  // namespace mssim
