#include "commands/result_folders.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <system_error>
#include <utility>

#include "application/bench/suites.h"
#include "application/console.h"
#include "application/prepared_scene.h"
#include "bench/machine/provenance.h"
#include "platform/files.h"
#include "text/error.h"
#include "text/text.h"
#include "web/web.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// What to give in place of a folder without results: those in it that lead to some.
std::string below(const fs::path& folder) {
  std::string text;
  std::error_code error;
  for (const fs::path& entry : entries_of(folder))
    if (fs::is_directory(entry, error) && !result_folders(entry).empty())
      text += (text.empty() ? "" : ", ") + printable(entry.string());
  return text.empty() ? "folders that mssim bench --out wrote" : "folders in it that have some: " + text;
}

/// The result folders that the given ones stand for, each once. Throws UsageError for one that is none.
std::vector<fs::path> folders_of(const std::vector<std::string>& all_given) {
  std::vector<fs::path> folders;
  const auto add = [&](const fs::path& folder) {
    std::error_code error;
    if (std::ranges::none_of(folders,
                             [&](const fs::path& other) { return equivalent(other, folder, error); }))
      folders.push_back(folder);
  };
  for (const std::string& given : all_given) {
    std::error_code error;
    if (is_web_results(given)) {
      add(given);
      continue;
    }
    if (!fs::is_directory(given, error))
      throw UsageError("there is no folder {}: give folders that mssim bench --out wrote", printable(given));
    const std::vector<fs::path> found = result_folders(given);
    if (found.empty()) throw UsageError("{} has no results: give {}", printable(given), below(given));
    std::ranges::for_each(found, add);
  }
  return folders;
}

/// The results that a page has saved in one file (docs/web.md).
ReportFolder page_folder(const fs::path& file) {
  MeasuredRun run = read_web_results(file);
  ReportFolder folder;
  folder.name = file.string();
  folder.rows = std::move(run.rows);
  folder.provenance = std::move(run.provenance);
  return folder;
}

std::vector<FoundCurve> reference_curves() {
  std::vector<FoundCurve> curves;
  for (const fs::path& file : entries_of(data_folder() / "reference")) {
    try {
      if (auto curve = energy_curve_in(file.stem().string(), read_file(file)))
        curves.push_back(std::move(*curve));
    } catch (const CsvError& problem) {
      throw CsvError(fmt::format("{}: {}; install mssim again", file.string(), problem.what()));
    }
  }
  return curves;
}

}  // namespace

void add_result_folders(Arguments& arguments, std::vector<std::string>& target) {
  arguments
      .add_list("DIR DIR|FILE", target,
                "Folders that mssim bench --out wrote, a folder of such folders, or files that the page of "
                "mssim web saved",
                [](std::string_view folder) { return std::vector{std::string(folder)}; })
      .required();
}

ReportInput report_input(const std::vector<std::string>& given) {
  const std::vector<fs::path> folders = folders_of(given);
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
  try {
    input.claims = published_claims();
  } catch (const std::exception& error) {
    input.problems.push_back(std::string(error.what()) + "; no claim of the papers is judged");
  }
  for (const fs::path& folder : folders) {
    ReportFolder& read =
        input.folders.emplace_back(is_web_results(folder) ? page_folder(folder) : read_report_folder(folder));
    mark_own_scenes(read.rows, read.provenance.value_or(Provenance()));
  }
  return input;
}

void tell_of_problems(const ReportInput& input) {
  std::vector<std::string> problems = input.problems;
  for (const ReportFolder& folder : input.folders)
    problems.insert(problems.end(), folder.problems.begin(), folder.problems.end());
  tell_first(problems);
}

}  // namespace mssim
