#include <algorithm>
#include <filesystem>
#include <iterator>
#include <sstream>

#include "bench/verification/verification.h"
#include "output/tables/results.h"
#include "platform/files.h"
#include "report/report_internal.h"
#include "statistics/statistics.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Any text as code. A Document's mark for code ends at a backtick, which the name of a file may have.
std::string code(std::string_view text) {
  std::string content;
  for (const char character : latex_text(text))
    content += character == '\'' ? std::string("\\textquotesingle{}") : std::string(1, character);
  return "\\texttt{" + content + "}";
}

/// Names in a sentence, each as code.
std::string names_in(const std::vector<std::string>& names, std::string_view last_word = "and") {
  return listed(mapped<std::string>(names, code), last_word);
}

/// All rows, a table for each scene.
Document times_page(const ReportFolder& folder) {
  const std::vector<const ResultRow*> rows = pointers_to(folder.rows);
  Document page{Heading{1, "Times per step"}, measured_on(rows, folder.where_from()),
                Paragraph{std::string(how_to_read_times)}};
  for (const std::string& scene : distinct<std::string>(rows, &ResultRow::scene)) {
    std::vector<const ResultRow*> its;
    std::ranges::copy_if(rows, std::back_inserter(its),
                         [&](const ResultRow* row) { return row->scene == scene; });
    page.emplace_back(Heading{2, fmt::format("{}: {} nodes, {} springs", scene, grouped(its.front()->nodes),
                                             grouped(its.front()->springs_unique))});
    page.emplace_back(times_of(its, folder));
  }
  add_sentence(page, legend_of_ratios(page));
  add_notes_of_programs(page, folder);
  add_rows_without_a_time(page, rows);
  return page;
}

/// "1 round", "7 to 15 rounds": a range_of() and its noun.
std::string counted(const std::string& range, std::string_view noun) {
  return fmt::format("{} {}{}", range, noun, range == "1" ? "" : "s");
}

/// Empty if no row has a sample.
std::string rounds_in(const ReportFolder& folder) {
  const std::string rounds = folder.rows.empty() ? "0" : range_of(folder, &ResultRow::rounds);
  return rounds == "0" ? "" : counted(rounds, "round") + ".";
}

std::vector<Chart> charts_of(const ReportFolder& folder, const ReportInput& input) {
  const std::string id = "chart";
  std::vector<Chart> charts = speedup_charts(folder, input, id);
  std::ranges::move(scaling_charts(folder, input, id), std::back_inserter(charts));
  if (auto chart = roofline_chart(folder, id)) charts.push_back(std::move(*chart));
  for (const FoundCurve& curve : folder.curves)
    charts.push_back(energy_chart(curve, input.references, fmt::format("{}-energy-{}", id, charts.size())));
  if (folder.guide)
    for (const std::string& scene : folder.guide->scenes())
      std::ranges::move(guide_charts(*folder.guide, input.legend, folder.where_from(), scene,
                                     fmt::format("{}-guide-{}", id, charts.size())),
                        std::back_inserter(charts));
  std::erase_if(charts, has_one_place);  // the tables show its values better
  return with_looks_of_backends(std::move(charts), input.legend);
}

/// Adds the charts and the file that includes them.
void add_figures(std::vector<FolderFile>& files, const std::string& prefix, const ReportFolder& folder,
                 const ReportInput& input) {
  FolderFile figures{prefix + "figures.tex", {}};
  for (const Chart& chart : charts_of(folder, input)) {
    const DrawnChart drawn = draw_svg(chart);
    if (drawn.svg.empty()) continue;
    const std::string name = prefix + chart.id;
    files.push_back({name + ".svg", drawn.svg + '\n'});
    std::vector<std::string> said{chart.title,
                                  measured_on(pointers_to(folder.rows), folder.where_from()).text};
    if (const std::string rounds = rounds_in(folder); !rounds.empty()) said.push_back(rounds);
    for (std::size_t i = 1; i < said.size(); ++i) said[i].pop_back();  // the full stop
    said.insert(said.end(), drawn.notes.begin(), drawn.notes.end());
    figures.text += fmt::format(
        "\\begin{{figure}}[!htbp]\n\\centering\n\\IfFileExists{{{0}.pdf}}"
        "{{\\includegraphics[width=0.7\\linewidth]{{{0}.pdf}}}}{{\\fbox{{{0}.svg is to be made a PDF}}}}\n"
        "\\caption{{{1}.}}\n\\label{{fig:{0}}}\n\\end{{figure}}\n\n",
        name, latex_text(join(said, ". ")));
  }
  if (!figures.text.empty()) files.push_back(std::move(figures));
}

// Methods

/// Differs wherever mssim_entry() does.
std::string mssim_key(const Provenance& provenance) {
  const BuildInfo& build = provenance.build;
  return fmt::format("mssim-{}{}", knows_commit(build) ? build.commit.substr(0, 12) : build.version,
                     build.dirty ? "-changed" : "");
}

std::string mssim_entry(const Provenance& provenance) {
  return fmt::format(
      "@misc{{{},\n  author = {{{{The mssim authors}}}},\n"
      "  title  = {{mssim, a benchmark harness for parallel mass-spring simulation}},\n"
      "  note   = {{Version {}, commit {}{}}}\n}}\n",
      mssim_key(provenance), provenance.build.version, provenance.build.commit,
      provenance.build.dirty ? ", with uncommitted changes" : "");
}

std::string paragraph(const std::string& title, const std::string& text) {
  return text.empty() ? "" : "\\paragraph{" + title + ".}\n" + text + "\n\n";
}

std::string machine_of(const ReportFolder& folder) {
  const Provenance& provenance = *folder.provenance;
  std::string text =
      fmt::format("{} The program is mssim~\\cite{{{}}}, compiled by {}. The system is {}.",
                  latex_text(measured_on(pointers_to(folder.rows), provenance).text), mssim_key(provenance),
                  latex_text(provenance.build.compiler), latex_text(provenance.machine.operating_system));
  for (const Finding& finding : row_findings(folder.rows, provenance))
    text += '\n' + latex_prose(finding.sentence);
  if (const std::string noise = noise_of(folder); !noise.empty()) text += '\n' + latex_text(noise);
  return text;
}

std::string scenes_of(const ReportFolder& folder, const ReportInput& input) {
  std::vector<std::string> published, garments, others;
  for (const PublishedTable& table : input.published)
    for (const PaperScene& scene : table.scenes_of(folder.rows)) add_once(published, scene.name);
  const auto is_in = [](const std::vector<std::string>& names, const ResultRow& row) {
    return std::ranges::find(names, row.scene) != names.end();
  };
  for (const ResultRow& row : folder.rows)
    if (row.dressing) add_once(garments, row.scene);
  for (const ResultRow& row : folder.rows)
    if (!is_in(garments, row) && !is_in(published, row)) add_once(others, row.scene);
  std::string text;
  if (!published.empty())
    text += names_in(published) + (published.size() == 1 ? " has" : " have") +
            " the nodes and springs that Hong et al.\\ published~\\cite{hong2016}.\n";
  if (!garments.empty())
    text += names_in(garments) + (garments.size() == 1 ? " is a garment" : " are garments") +
            ", dressed and draped after Vassilev~\\cite{vassilev}.\n";
  if (!others.empty()) text += "Neither paper has " + names_in(others, "or") + ".\n";
  return text;
}

/// Whether `bench --verified` took the row's verification from an earlier process, by its note (job.cpp).
/// Such a row has no warm-up before its samples, and no check of them.
bool relies_on_earlier_process(const ResultRow& row) {
  return row.note.find(verified_before) != std::string::npos;
}

/// Empty if no row has a sample. Files of older versions lack the trials and outliers.
std::string timing_of(const ReportFolder& folder) {
  const std::string rounds = range_of(folder, &ResultRow::rounds),
                    trials = range_of(folder, &ResultRow::warm_up_trials);
  if (rounds == "0") return {};
  std::vector<double> seconds;
  int outliers = 0;
  for (const ResultRow& row : folder.rows) {
    outliers += row.outliers;
    for (std::size_t i = 0; i < row.samples_ms.size(); ++i)
      seconds.push_back(row.samples_ms[i] * row.sample_steps[i] / 1000);
  }
  std::string text;
  if (!std::ranges::any_of(folder.rows, relies_on_earlier_process))
    text = fmt::format(
        "Before the first round each combination of scene, backend and integrator was run until neither of "
        "its last two trials was more than \\qty{{2}}{{\\percent}} faster than the fastest before{}.\n",
        trials == "0" ? "" : " (" + counted(trials, "trial") + ")");
  text += fmt::format("{} took one sample of every combination of a scene, in random order.\n",
                      rounds == "1" ? "One round" : "Each of " + counted(rounds, "round"));
  if (!seconds.empty())
    text += fmt::format(
        "A sample is a number of steps between two readings of the clock; the median length of the {} "
        "is \\qty{{{}}}{{\\second}}.\nAll samples count{}.\n",
        pluralize(seconds.size(), "sample"), three_digits(median(seconds)),
        outliers == 0 ? "" : fmt::format(", also the {} beyond Tukey's fences", outliers));
  return text + fmt::format(
                    "Times are medians of the samples. Their intervals contain the median of the "
                    "distribution with a probability of at least \\qty{{{}}}{{\\percent}}, whatever the "
                    "distribution; their ends are samples~\\cite{{davidnagaraja2003}}. Fewer than six rounds "
                    "have none.\nA speed-up is the median of the "
                    "ratios within each round, with an interval of the same kind.",
                    decimal(100 * interval_confidence));
}

/// What was allowed beyond the tolerances, and of which rows the samples were compared. The page of mssim web
/// does neither.
std::string further_comparison_of(const ReportFolder& folder) {
  if (is_from_page(folder)) return {};
  std::size_t checked = 0, unchecked = 0;
  for (const ResultRow& row : folder.rows)
    if (counts(row) && !row.dressing)
      ++(has_unchecked_samples(row) || relies_on_earlier_process(row) ? unchecked : checked);
  std::string text = fmt::format(
      "A second reference is rounded to single precision after every step. If four times its deviation "
      "per rounding of a step is more, that much is allowed, up to \\num{{{}}} mean rest lengths and "
      "\\qty{{{}}}{{\\percent}} of that energy.\n",
      decimal(largest_tolerance), decimal(100 * largest_tolerance));
  if (checked > 0)
    text += fmt::format(
        "The states at the end of one round of samples were compared, too{}, without these upper limits. "
        "There the motion of four steps is added where nodes land on the floor.\n",
        unchecked > 0 ? " (except those of " + pluralize(unchecked, "row") + ")" : "");
  return text;
}

std::string verification_of(const ReportFolder& folder) {
  bool has_garments = false, has_others = false;
  double error = 0;
  for (const ResultRow& row : folder.rows) {
    if (!counts(row)) continue;
    (row.dressing ? has_garments : has_others) = true;
    error = std::max(error, row.position_error.value_or(0));
  }
  std::string text;
  if (has_others)
    text += fmt::format(
        "Every combination was compared with a double-precision reference of the same integrator after at "
        "most {} steps.\nNo node may be farther from it than $4\\sqrt{{n}}\\,2^{{-24}}\\,|x|$, where $n$ is "
        "the number of roundings of a position and $|x|$ the largest coordinate. The total energy may differ "
        "by at most \\qty{{{}}}{{\\percent}} of the kinetic and elastic energy.\n{}Explicit "
        "integrators in one process also stepped a small scene with the same laws and a floor.\n",
        verification_steps, decimal(100 * energy_tolerance), further_comparison_of(folder));
  if (has_garments)
    text +=
        "Garments were compared with a double-precision reference in stretches of five steps, while their "
        "seams close and when they hang draped. Each must also be dressed within bounds of its fit. An "
        "algorithm as published may exceed these; the table then says so.\n";
  if (!text.empty())
    text +=
        fmt::format("The largest distance of a node from its reference was \\num{{{}}} mean rest lengths.",
                    two_digits(error));
  return text;
}

FolderFile methods_of(const ReportFolder& folder, const ReportInput& input, const std::string& prefix) {
  std::string text = "% As " + input.made_by + " measures, filled from the folder's files.\n" +
                     paragraph("Machine", machine_of(folder)) + paragraph("Scenes", scenes_of(folder, input));
  if (!folder.rows.empty())
    text += paragraph("Timing", timing_of(folder)) + paragraph("Verification", verification_of(folder));
  return {prefix + "methods.tex", text};
}

// Artifact

Document environment_of(const ReportFolder& folder) {
  const Provenance& provenance = *folder.provenance;
  const Machine& machine = provenance.machine;
  Document page{Heading{1, "Environment of the artifact"}, measured_on(pointers_to(folder.rows), provenance)};
  Table table{{{"what"}, {"value", Align::left}}, {}};
  const auto line = [&](const char* what, const std::string& value) {
    if (!value.empty()) table.rows.push_back({what, value});
  };
  line("processor", cpu_name(machine));
  line("logical CPUs", std::to_string(machine.logical_cpus));
  line("memory", three_digits(static_cast<double>(machine.memory_bytes) / (1U << 30U)) + " GiB");
  line(is_from_page(folder) ? "WebGPU adapter" : "OpenCL devices", join(provenance.opencl_devices, "\n"));
  line("system", machine.operating_system);
  line("kernel", machine.kernel);
  line("compiler", provenance.build.compiler + ", " + provenance.build.build_type);
  line("TetGen", provenance.tetgen);
  line("commit", "`" + provenance.build.commit + "`");
  page.emplace_back(std::move(table));
  return page;
}

/// Claims that the rows decide, or leave undecided.
Document claims_of(const ReportFolder& folder, const ReportInput& input) {
  Table table{{{"what the paper says"}, {"where"}, {"published"}, {"to expect"}, {"outcome"}}, {}};
  for (const JudgedClaim& judged : judge(folder, input))
    if (judged.outcome != ClaimOutcome::not_testable)
      table.rows.push_back({judged.claim->says, judged.claim->paper + "\n" + judged.claim->place,
                            judged.published.empty() ? Cell() : Cell(judged.published), judged.measured,
                            name_of(judged.outcome)});
  if (table.rows.empty()) return {};
  return {Heading{1, "Claims of the papers, and the ratios to expect on this processor"},
          measured_on(pointers_to(folder.rows), folder.where_from()), std::move(table)};
}

/// A command or address, which may be broken after the commas of a list of names.
std::string breakable_code(const std::string& words) {
  std::string text;
  for (const char character : code(words))
    text += character == ',' ? std::string(",\\allowbreak{}") : std::string(1, character);
  return text;
}

/// What the commands need and mssim does not have, with the hashes of provenance.json: scenes and programs.
std::vector<std::string> own_files_of(const ReportFolder& folder) {
  std::vector<std::string> files;
  for (const SceneHash& scene : folder.provenance->scenes) {
    const auto names_its_file = [&](const std::string& word) {
      std::istringstream parts(word);
      for (std::string part; std::getline(parts, part, ',');)
        if (std::filesystem::path(part).filename() == scene.name + ".json") return true;
      return false;
    };
    if (std::ranges::any_of(folder.provenance->command_line, names_its_file))
      files.push_back(fmt::format("the scene {} ({})", code(scene.name), code(to_hex(scene.fnv1a_64))));
  }
  for (const BackendProgramRecord& program : folder.provenance->backend_programs)
    for (const FileHash& file : program.files)
      if (file.name.find('/') != std::string::npos && !file.name.ends_with("mssim-mpi"))  // no interpreter
        files.push_back(fmt::format("{} of the backend {} ({})", code(file.name), code(program.name),
                                    code(to_hex(file.fnv1a_64))));
  return files;
}

/// How to measure again.
std::string commands_of(const ReportFolder& folder) {
  const BuildInfo& build = folder.provenance->build;
  const bool has_commit = knows_commit(build), from_page = is_from_page(folder);
  std::vector<std::string> words = folder.provenance->command_line;
  std::string command = "scripts", settings;
  if (from_page) {  // behind "mssim web" are the settings in the page's address
    if (words.size() > 2) settings = words[2];
    words = {"mssim", "web", "--out", "web.html"};
  }
  for (const std::string& word : words) command += (&word == &words.front() ? "/" : " ") + shell_word(word);
  double minutes = 0;
  for (const ResultRow& row : folder.rows)
    for (std::size_t i = 0; i < row.samples_ms.size(); ++i)
      minutes += row.samples_ms[i] * row.sample_steps[i] / 60000;
  std::string text = fmt::format(
      "In a clone of mssim on Debian 12 or 13, {} installs what is missing, builds mssim and {}{}{}:\n"
      "\\begin{{quote}}\\raggedright\n{}{}\n\\end{{quote}}\n",
      has_commit ? "the first command selects the commit, and the second" : "this command",
      from_page ? "writes the page that measured" : "measures",
      has_commit ? "" : "; the results do not name the commit",
      build.dirty ? "; the program that was measured had uncommitted changes" : "",
      has_commit ? code("git checkout " + build.commit) + "\\\\\n" : "", breakable_code(command));
  if (!settings.empty())
    text += "The page measures at once if its address ends in " + breakable_code(settings) + ".\n";
  if (const std::vector<std::string> own = own_files_of(folder); !own.empty())
    text += fmt::format("First copy there what is not part of mssim, here with FNV-1a hashes: {}.\n",
                        listed(own));
  if (minutes > 0)
    text += fmt::format(
        "The timed samples alone took \\qty{{{}}}{{\\minute}}; warm-up and verification come on top.",
        three_digits(minutes));
  return text;
}

FolderFile artifact_of(const ReportFolder& folder, const ReportInput& input, const std::string& prefix) {
  std::string text = latex(environment_of(folder), prefix + "artifact", "");
  text += paragraph("Commands", commands_of(folder));
  const Document claims = claims_of(folder, input);
  text += claims.empty() ? paragraph("Claims", "These rows decide no claim of the two papers.")
                         : latex(claims, prefix + "claims", rounds_in(folder));
  if (!folder.rows.empty())
    text +=
        paragraph("Times to expect",
                  "Table~\\ref{tab:" + prefix +
                      "times-1} and those after it have the time of each row with its interval. On another "
                      "processor compare ratios, not milliseconds.");
  return {prefix + "artifact.tex", text};
}

// The document

constexpr std::string_view preamble =
    R"(% A document of all that mssim table has written. Your own needs these packages.
\documentclass{article}
\usepackage[T1]{fontenc}
\usepackage{lmodern}
\usepackage[a4paper,margin=20mm]{geometry}
\usepackage{booktabs}
\usepackage{graphicx}
\usepackage{siunitx}
\sisetup{mode=match, reset-text-family=false, reset-text-series=false}
\setlength{\emergencystretch}{3em} % names of backends and scenes are not hyphenated
\begin{document}
)";

/// Letters, digits and hyphens, which LaTeX takes in any name.
std::string plain_name(const std::string& name) {
  std::string plain;
  for (const char c : name) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    plain += is_plain ? c : '-';
  }
  return plain;
}

}  // namespace

std::vector<TablePage> table_pages(const ReportFolder& folder, const ReportInput& input) {
  if (!folder.provenance)
    throw InputError("{} has no provenance.json that can be read: a table needs to say where it was measured",
                     printable(folder.name));
  std::vector<TablePage> pages;
  if (input.tables)
    for (ResultTable& table : input.tables(folder.rows, *folder.provenance))
      if (const std::string name(std::string_view(table.name));
          std::ranges::find(folder.tables, name) != folder.tables.end())
        pages.push_back({name, std::move(table.page), rounds_in(folder)});
  if (!folder.bodies.empty())
    pages.push_back({"table2", structure_table(folder.bodies, *folder.provenance).page, {}});
  if (folder.guide) pages.push_back({"guide", folder.guide->page, {}});
  if (!folder.rows.empty()) pages.push_back({"times", times_page(folder), rounds_in(folder)});
  return pages;
}

std::vector<FolderFile> paper_files(const ReportInput& input) {
  std::vector<FolderFile> files;
  std::string sources = read_file(data_folder() / "published/sources.bib"), body, appendix;
  for (const ReportFolder& folder : input.folders) {
    const std::vector<TablePage> pages = table_pages(folder, input);
    std::string prefix;
    if (input.folders.size() > 1)
      prefix = fmt::format("{}-{}-", &folder - input.folders.data() + 1, plain_name(short_name(folder)));
    const auto add = [&](FolderFile file, std::string& part) {
      part += "\\input{" + file.name.substr(0, file.name.rfind('.')) + "}\n";
      files.push_back(std::move(file));
    };
    const std::string name = code(short_name(folder));
    body += "\\section{Methods: " + name + "}\n";
    add(methods_of(folder, input, prefix), body);
    body += "\\section{Results: " + name + "}\n";
    for (const TablePage& page : pages)
      add({prefix + page.name + ".tex", latex(page.page, prefix + page.name, page.remark)}, body);
    const std::size_t before = files.size();
    add_figures(files, prefix, folder, input);
    if (files.size() > before) body += "\\input{" + prefix + "figures}\n";
    body += "\\clearpage\n";
    appendix += "\\section{Artifact: " + name + "}\n";
    add(artifact_of(folder, input, prefix), appendix);
    // With its entry's brace and comma: one key may begin another.
    if (sources.find('{' + mssim_key(*folder.provenance) + ',') == std::string::npos)
      sources += mssim_entry(*folder.provenance);
  }
  files.push_back({"sources.bib", std::move(sources)});
  files.push_back({"mssim.tex", std::string(preamble) + body +
                                    "\\bibliographystyle{plain}\n\\bibliography{sources}\n\\clearpage\n"
                                    "\\appendix\n" +
                                    appendix + "\\end{document}\n"});
  return files;
}

}  // namespace mssim
