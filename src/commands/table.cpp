#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <set>
#include <vector>

#include "application/bench/suites.h"
#include "commands/command.h"
#include "commands/options.h"
#include "commands/result_folders.h"
#include "platform/files.h"
#include "platform/process.h"
#include "report/report.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

struct TableOptions {
  std::vector<std::string> folders;
  bool latex = false;
  std::string out;
  bool overwrite = false;
};

/// The tables of all suites; a folder has those of its own.
TableMaker tables_of_all_suites() {
  std::set<TableMaker (*)()> taken;
  std::vector<TableMaker> makers;
  for (const Suite& suite : suites())
    if (taken.insert(suite.comparison.tables).second) makers.push_back(suite.comparison.tables());
  return with_thread_table([makers](std::span<const ResultRow> rows, const Provenance& provenance) {
    std::vector<ResultTable> tables;
    for (const TableMaker& maker : makers)
      for (ResultTable& table : maker(rows, provenance))
        if (const std::string_view name = table.name;
            std::ranges::none_of(tables, [&](const ResultTable& known) { return known.name == name; }))
          tables.push_back(std::move(table));
    return tables;
  });
}

void print(const ReportInput& input, bool as_latex) {
  for (const ReportFolder& folder : input.folders)
    for (const TablePage& page : table_pages(folder, input))
      std::cout << (as_latex ? latex(page.page, page.name, page.remark) : markdown(page.page) + '\n');
}

/// Makes a PDF of each chart beside it. Returns how many: none, and says so, without the program for it.
std::size_t convert(const std::vector<fs::path>& charts) {
  constexpr unsigned most_seconds = 60;
  if (charts.empty()) return 0;
  const auto program = find_program("rsvg-convert");
  if (!program) {
    std::cerr << "mssim: the charts are only SVG, because rsvg-convert is not in PATH: install Debian's "
                 "package librsvg2-bin and give --overwrite, too\n";
    return 0;
  }
  const fs::path made = temporary_folder_of_process() / "chart.pdf";
  for (const fs::path& chart : charts) {
    const ChildResult result =
        run({*program,
             {"--format=pdf", "--output=" + made.string(), fs::absolute(chart).string()},
             {},
             made.parent_path(),
             most_seconds,
             most_seconds});
    if (const std::string failure = failed_end(result, "converting " + chart.string()); !failure.empty())
      throw Error(exit_unavailable, "rsvg-convert " + failure);
    write_file_atomically(fs::path(chart).replace_extension(".pdf"), read_file(made));
  }
  return charts.size();
}

int table(const TableOptions& options) {
  if (!options.out.empty() && !options.latex)
    throw UsageError("--out is for a paper in LaTeX: give --format latex, too");
  ReportInput input = report_input(options.folders);
  input.tables = tables_of_all_suites();
  tell_of_problems(input);
  for (const ReportFolder& folder : input.folders)
    if (folder.rows.empty() && !folder.guide)
      throw UsageError("{} has no row that can be shown: give folders that mssim bench --out wrote",
                       printable(folder.name, 1000));
  if (options.out.empty()) {
    print(input, options.latex);
    return exit_ok;
  }
  const std::vector<PaperFile> files = paper_files(input);
  const fs::path out = options.out;
  for (const PaperFile& file : files) require_free(out / file.name, "--out", options.overwrite);
  make_folder(out);
  std::vector<fs::path> charts;
  for (const PaperFile& file : files) {
    write_file_atomically(out / file.name, file.text);
    if (fs::path(file.name).extension() == ".svg") charts.push_back(out / file.name);
  }
  const std::size_t count = files.size() + convert(charts);
  std::cerr << "mssim: wrote " << pluralize(count, "file") << " to " << printable(out.string()) << '\n';
  return exit_ok;
}

}  // namespace

std::function<int()> declare_table(Arguments& arguments) {
  const auto options = std::make_shared<TableOptions>();
  add_result_folders(arguments, options->folders);
  arguments.add_choice("--format", options->latex, {{"latex", true}, {"markdown", false}},
                       "Format: latex (booktabs and siunitx) or markdown (default)");
  const Argument out =
      arguments.add("--out DIR", options->out,
                    "Folder for a paper: tables, charts as SVG and PDF, methods, artifact appendix, "
                    "sources.bib, and mssim.tex, a document of all (default: print only the tables)");
  arguments.add_flag("--overwrite", options->overwrite, "Replace files that the folder has").needs(out);
  return [options] { return table(*options); };
}

}  // namespace mssim
