#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <set>
#include <vector>

#include "application/bench/suites.h"
#include "application/console.h"
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
  std::string text;  // all of it or, if a folder has no provenance, nothing
  for (const ReportFolder& folder : input.folders)
    for (const TablePage& page : table_pages(folder, input))
      text += as_latex ? latex(page.page, page.name, page.remark) : markdown(page.page) + '\n';
  std::cout << text;
}

bool is_chart(const FolderFile& file) { return file.name.ends_with(".svg"); }

std::string pdf_of(const FolderFile& chart) {
  return fs::path(chart.name).replace_extension(".pdf").string();
}

/// Each chart as PDF: none, and says so, without the program for it.
std::vector<FolderFile> pdfs_of(std::span<const FolderFile> files) {
  constexpr unsigned most_seconds = 60;
  std::vector<FolderFile> pdfs;
  if (std::ranges::none_of(files, is_chart)) return pdfs;
  const auto program = find_program("rsvg-convert");
  if (!program) {
    tell(
        "the charts are only SVG, because rsvg-convert is not in PATH: install Debian's package librsvg2-bin "
        "and give --overwrite, too");
    return pdfs;
  }
  const fs::path& folder = temporary_folder_of_process();
  const fs::path from = folder / "chart.svg", to = folder / "chart.pdf";
  for (const FolderFile& chart : files) {
    if (!is_chart(chart)) continue;
    write_file_atomically(from, chart.text);
    fs::remove(to);  // of the chart before this one
    const ChildResult result = run({*program,
                                    {"--format=pdf", "--output=" + to.string(), from.string()},
                                    {},
                                    folder,
                                    most_seconds,
                                    most_seconds});
    if (const std::string failure = failed_end(result, "converting " + chart.name); !failure.empty())
      throw Error(exit_unavailable, "rsvg-convert " + failure);
    if (!fs::exists(to))
      throw Error(exit_unavailable,
                  fmt::format("{} has ended without an error, but has written no PDF of {}; install Debian's "
                              "package librsvg2-bin again",
                              printable(program->string()), chart.name));
    pdfs.push_back({pdf_of(chart), read_file(to)});
  }
  return pdfs;
}

int table(const TableOptions& options) {
  if (!options.out.empty() && !options.latex)
    throw UsageError("--out is for a paper in LaTeX: give --format latex, too");
  ReportInput input = report_input(options.folders);
  input.tables = tables_of_all_suites();
  tell_of_problems(input);
  for (const ReportFolder& folder : input.folders)
    if (folder.rows.empty() && folder.bodies.empty() && !folder.guide)
      throw UsageError("{} has no row that can be shown: give folders that mssim bench --out wrote",
                       printable(folder.name, 1000));
  if (options.out.empty()) {
    print(input, options.latex);
    return exit_ok;
  }
  std::vector<FolderFile> files = paper_files(input);
  const fs::path out = options.out;
  std::vector<fs::path> old_pdfs;  // they must not stand under the captions of new charts
  for (const FolderFile& file : files) {
    require_free(out / file.name, "--out", options.overwrite);
    if (!is_chart(file)) continue;
    require_free(out / pdf_of(file), "--out", options.overwrite);
    old_pdfs.push_back(out / pdf_of(file));
  }
  std::vector<FolderFile> pdfs = pdfs_of(files);
  if (!pdfs.empty()) old_pdfs.clear();
  std::ranges::move(pdfs, std::back_inserter(files));
  make_folder(out);
  write_files_atomically(out, files);
  for (const fs::path& old : old_pdfs) fs::remove(old);
  tell("wrote {} to {}", pluralize(files.size(), "file"), printable(out.string()));
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
