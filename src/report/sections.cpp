#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "bench/results/comparison.h"
#include "output/tables/results.h"
#include "report/report_internal.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Empty if `html` is.
std::string paragraph(const std::string& html, std::string_view attributes = "") {
  return html.empty() ? html : fmt::format("<p{}>{}</p>\n", attributes, html);
}

constexpr std::string_view of_problems = " class=\"problems\"";

/// Joins the results of `content`, which takes a folder and a prefix of ids, under the folder's name if there
/// are several; the paragraph `without` if all are empty.
template <class Content>
std::string of_each_folder(const ReportInput& input, Content content, const std::string& without = "") {
  std::string text;
  for (std::size_t i = 0; i < input.folders.size(); ++i) {
    const ReportFolder& folder = input.folders[i];
    const std::string part = content(folder, fmt::format("f{}", i + 1));
    if (part.empty()) continue;
    if (input.folders.size() > 1) text += "<h3>" + html_text(folder.name) + "</h3>\n";
    text += part;
  }
  return text.empty() ? paragraph(without) : text;
}

/// Level of headings in the content of a folder.
int level_in(const ReportInput& input) { return input.folders.size() < 2 ? 3 : 4; }

/// A warning above the times; empty if mssim found no noise.
std::string noise_note(const ReportFolder& folder) {
  return paragraph(html_text(noise_of(folder)), of_problems);
}

/// HTML that is shown on a click on the summary; empty if `html` is.
std::string folded(const std::string& summary, const std::string& html) {
  return html.empty()
             ? html
             : fmt::format("<details><summary>{}</summary>\n{}</details>\n", html_text(summary), html);
}

// Machine and provenance

std::string words_of(const Cache& cache) {
  return fmt::format("L{} {} {} × {} KiB", cache.level, cache.type, cache.count, grouped(cache.bytes / 1024));
}

/// The device's name without its platform; PoCL's include theirs.
std::string name_without_platform(const std::string& device) {
  const std::size_t name = device.find(": ");
  return device_name(name == std::string::npos ? device : device.substr(name + 2));
}

/// Missing or damaged parts; empty if there are none.
std::string problem_section(const ReportInput& input) {
  std::vector<std::string> problems = input.problems;
  for (const ReportFolder& folder : input.folders)
    problems.insert(problems.end(), folder.problems.begin(), folder.problems.end());
  // Problems name files, whose characters are not marks.
  std::string items;
  for (const std::string& problem : problems) items += "<li>" + html_text(problem) + ".</li>\n";
  return items.empty() ? items : "<ul class=\"problems\">\n" + items + "</ul>\n";
}

/// Machine and settings of each folder.
std::string machine_section(const ReportInput& input) {
  Table table;
  for (const ReportFolder& folder : input.folders) {
    if (!folder.provenance) continue;
    const Provenance& provenance = *folder.provenance;
    const Machine& machine = provenance.machine;
    table.add({{"folder", folder.name},
               {"processor", cpu_name(machine)},
               {"logical CPUs", machine.logical_cpus},
               {"threads", provenance.threads},
               {"memory", three_digits(static_cast<double>(machine.memory_bytes) / (1U << 30U)) + " GiB"},
               {"devices", join(mapped<std::string>(provenance.opencl_devices, name_without_platform), "; ")},
               {"system", machine.operating_system},
               {"compiler", provenance.build.compiler + ", " + provenance.build.build_type},
               {"mssim", made_by(provenance)},
               {"rounds", folder.rows.empty() ? Cell() : range_of(folder, &ResultRow::rounds)}});
  }
  for (Column& column : table.columns) column.align = Align::left;
  return table.rows.empty() ? paragraph("The machine of the folders is unknown.") : html_of(table);
}

std::string provenance_of(const ReportFolder& folder) {
  const Provenance& provenance = *folder.provenance;
  const Machine& machine = provenance.machine;
  std::vector<std::string> environment, scenes, load;
  for (const auto& [name, value] : provenance.thread_environment) environment.push_back(name + "=" + value);
  for (const SceneHash& scene : provenance.scenes)
    scenes.push_back(fmt::format("{} {}{}", scene.name, to_hex(scene.fnv1a_64),
                                 scene.files_fnv1a_64 ? " with files " + to_hex(*scene.files_fnv1a_64) : ""));
  for (const double average : machine.load_average) load.push_back(fmt::format("{:.2f}", average));
  const auto or_nothing = [](const std::string& text) { return text.empty() ? Cell() : Cell(text); };
  Table table{{{"what"}, {"value"}}, {}};
  const auto line = [&](const char* what, Cell value) { table.rows.push_back({what, std::move(value)}); };
  line("command", join(provenance.command_line, " "));
  line("started", provenance.started_utc);
  line("continues runs of", or_nothing(join(provenance.earlier_starts_utc, ", ")));
  line("commit", provenance.build.commit + (provenance.build.dirty ? ", with uncommitted changes" : ""));
  line("program", provenance.program_fnv1a_64 ? Cell(to_hex(*provenance.program_fnv1a_64)) : Cell());
  line("compiler flags", provenance.build.flags);
  line("caches", or_nothing(join(mapped<std::string>(machine.caches, words_of), ", ")));
  line("frequency", three_digits(machine.cpu_mhz / 1000) + " GHz");
  line("governor", machine.governor);
  line("turbo", machine.turbo);
  line("several logical CPUs per core (SMT)", machine.smt);
  line("NUMA nodes", machine.numa_nodes > 0 ? Cell(machine.numa_nodes) : Cell());
  line("kernel", machine.kernel);
  line("load average", or_nothing(join(load, ", ")));
  line("environment of threads", or_nothing(join(environment, ", ")));
  line("memory of devices", or_nothing(provenance.device_memory));
  line("TetGen", or_nothing(provenance.tetgen));
  line("hashes of scenes", or_nothing(join(scenes, ", ")));
  const std::string_view when = is_from_page(folder) ? "during the run" : "when it started";
  Document page{Paragraph{fmt::format("Sources of noise that mssim found {}:", when)},
                BulletList{provenance.noise}};
  if (provenance.noise.empty()) page = {Paragraph{fmt::format("mssim found no source of noise {}.", when)}};
  page.emplace_back(std::move(table));
  return html_of(page, 4);
}

/// The data needed to judge the numbers and to repeat the measurement.
std::string provenance_section(const ReportInput& input) {
  return of_each_folder(input, [](const ReportFolder& folder, const std::string&) {
    return folder.provenance ? provenance_of(folder)
                             : paragraph(
                                   "provenance.json is missing or damaged: the origin of these numbers is "
                                   "unknown.");
  });
}

// Verdict and changes

std::string list_of(const std::vector<Finding>& findings) {
  std::string text = "<ul class=\"findings\">\n";
  for (const Finding& finding : findings)
    text += fmt::format("<li class=\"{}\">{}{}</li>\n", finding.is_warning ? "no" : "fact",
                        finding.is_warning ? "<strong>! not verified</strong> " : "",
                        html_prose(finding.sentence));
  return text + "</ul>\n";
}

std::string table_of(const std::vector<JudgedClaim>& claims) {
  if (claims.empty()) return paragraph("No row has a scene of the papers.");
  const auto number = [&](ClaimOutcome outcome) {
    return std::ranges::count(claims, outcome, &JudgedClaim::outcome);
  };
  const std::string text = fmt::format(
      "{} of the papers: {} held, {} not held, {} undecided, {} not testable here.",
      pluralize(claims.size(), "claim"), number(ClaimOutcome::held), number(ClaimOutcome::not_held),
      number(ClaimOutcome::undecided), number(ClaimOutcome::not_testable));
  Table table{{{"what the paper says"}, {"where"}, {"published"}, {"measured"}, {"outcome"}}, {}};
  for (const JudgedClaim& judged : claims)
    table.rows.push_back({judged.claim->says, judged.claim->paper + ": " + judged.claim->place,
                          judged.published.empty() ? Cell() : Cell(judged.published), judged.measured,
                          name_of(judged.outcome)});
  return paragraph(text) + html_of(table);
}

/// The outcomes of all folders: a line for each claim that any of them decides or leaves undecided, a column
/// for each folder.
std::string outcomes_of(const ReportInput& input) {
  Table table{{{"what the paper says"}, {"where"}}, {}};
  std::vector<std::vector<JudgedClaim>> by_folder;
  for (const ReportFolder& folder : input.folders) {
    table.columns.push_back({short_name(folder)});
    by_folder.push_back(judge(folder, input));
  }
  std::size_t untested = 0;
  for (const Claim& claim : input.claims) {
    std::vector<Cell> line{claim.says, claim.paper + ": " + claim.place};
    bool is_judged = false, is_tested = false;
    for (const std::vector<JudgedClaim>& all : by_folder) {
      Cell& cell = line.emplace_back();
      const JudgedClaim* judged = found_in(all, &claim, &JudgedClaim::claim);
      if (!judged) continue;
      is_judged = true;
      if (judged->outcome == ClaimOutcome::not_testable) continue;
      is_tested = true;
      cell = name_of(judged->outcome);
      cell.strong = judged->outcome != ClaimOutcome::undecided;
    }
    if (is_tested)
      table.rows.push_back(std::move(line));
    else if (is_judged)
      ++untested;
  }
  std::string text =
      table.rows.empty() ? "" : html_of(table) + paragraph("A dash means: not testable with that folder.");
  if (untested > 0)
    text += paragraph(pluralize(untested, table.rows.empty() ? "claim" : "further claim") +
                      " cannot be tested with any of the folders.");
  return text;
}

std::string verdict_section(const ReportInput& input) {
  const std::string ratios = of_each_folder(input, [&](const ReportFolder& folder, const std::string&) {
    if (folder.rows.empty()) return paragraph("There are no rows to judge.");
    return table_of(judge(folder, input)) + list_of(row_findings(folder.rows, folder.where_from()));
  });
  return fmt::format(
      "<p>Claims of the papers, and whether they held here. Hong et al. measured on a {}; their Figure 5 "
      "shows ten threads. A claim <strong>held</strong> if the whole interval of every ratio is above the "
      "ratio that the claim needs. It is <strong>not held</strong> if the whole interval of one is below. "
      "Rows that are not verified do not count. OpenCL on the CPU decides nothing about a GPU.</p>\n{}",
      paper_device,
      input.folders.size() < 2 ? ratios : outcomes_of(input) + folded("The ratios of each folder", ratios));
}

/// Whether the row counts but has no samples, so that it cannot be compared.
bool lacks_samples(const ResultRow& row) { return counts(row) && row.samples_ms.empty(); }

std::vector<ResultRow> with_samples(std::vector<ResultRow> rows) {
  std::erase_if(rows, lacks_samples);
  return rows;
}

std::vector<std::string> without_samples(std::span<const ResultRow> rows) {
  std::vector<std::string> names;
  for (const ResultRow& row : rows)
    if (lacks_samples(row)) names.push_back(combination_name(row));
  return names;
}

/// The changes from the first of two folders to the second, as in `mssim compare`, or why they cannot be
/// compared; empty unless there are two folders.
std::string changes_section(const ReportInput& input) {
  if (input.folders.size() != 2) return {};
  const ReportFolder &base = input.folders[0], &next = input.folders[1];
  std::string text = paragraph("BASE is " + html_text(base.name) + ", NEW is " + html_text(next.name) + ".");
  std::vector<std::string> unlike{"provenance.json of a folder is missing or damaged"};
  if (base.provenance && next.provenance) unlike = differences(*base.provenance, *next.provenance);
  std::ranges::move(differences(base.rows, next.rows), std::back_inserter(unlike));
  if (!unlike.empty())
    return text + paragraph("The two runs are not comparable: " + html_text(join(unlike, "; ")) + ".") +
           paragraph("<code>mssim compare --force</code> compares them anyway.");
  RunComparison comparison = compare(with_samples(base.rows), with_samples(next.rows), input.threshold);
  const std::vector<std::string> base_lacks = without_samples(base.rows),
                                 next_lacks = without_samples(next.rows);
  const auto is_in = [](const std::vector<std::string>& names) {
    return [&](const std::string& name) { return std::ranges::find(names, name) != names.end(); };
  };
  std::erase_if(comparison.only_base, is_in(next_lacks));
  std::erase_if(comparison.only_new, is_in(base_lacks));
  text += comparison.rows.empty() ? paragraph("They have no measured combination in common.")
                                  : html_of(comparison_page(comparison), 3);
  for (const auto& [what, combinations] :
       {std::pair("Only BASE has", &std::as_const(comparison.only_base)),
        std::pair("Only NEW has", &std::as_const(comparison.only_new)),
        std::pair("Without a verified time in BASE", &std::as_const(comparison.untimed)),
        std::pair("Without samples in BASE", &base_lacks), std::pair("Without samples in NEW", &next_lacks)})
    if (!combinations->empty())
      text += paragraph(fmt::format("{}: {}.", what, html_text(join(*combinations, "; "))));
  return text;
}

// Tables

/// The rows of the largest scene of each kind.
std::vector<const ResultRow*> headline_rows(RowPointers rows) {
  std::map<ContentKind, const ResultRow*> largest;
  for (const ResultRow* row : rows) {
    if (!counts(*row)) continue;
    const ResultRow*& known = largest[kind_of(*row)];
    if (!known || row->nodes > known->nodes) known = row;
  }
  std::set<std::string_view> scenes;
  for (const auto& [kind, row] : largest) scenes.insert(row->scene);
  std::vector<const ResultRow*> chosen;
  std::ranges::copy_if(rows, std::back_inserter(chosen),
                       [&](const ResultRow* row) { return scenes.contains(row->scene); });
  return chosen;
}

std::string headline_section(const ReportInput& input) {
  const auto times = [&](const ReportFolder& folder, const std::string&) {
    if (folder.rows.empty()) return paragraph("There are no rows.");
    const std::vector<const ResultRow*> rows = pointers_to(folder.rows);
    const Table all = times_of(rows, folder), headlines = times_of(headline_rows(rows), folder);
    Document below;
    add_sentence(below, legend_of_ratios({all}));
    add_notes_of_programs(below, folder);
    add_rows_without_a_time(below, rows);
    return noise_note(folder) +
           (headlines.rows.empty() ? paragraph("No row has a verified time.") : html_of(headlines)) +
           folded("All " + pluralize(rows.size(), "row"), html_of(all)) + html_of(below, level_in(input));
  };
  return paragraph("Rows of the largest scene of each kind. " + html_prose(how_to_read_times)) +
         of_each_folder(input, times);
}

/// The tables of the papers, published and measured.
std::string published_section(const ReportInput& input) {
  return of_each_folder(input, [&](const ReportFolder& folder, const std::string&) {
    std::string text;
    if (input.tables)
      for (const ResultTable& table : input.tables(folder.rows, folder.where_from()))
        text += html_of(table.page, 4);
    if (!folder.bodies.empty()) text += html_of(structure_table(folder.bodies, folder.where_from()).page, 4);
    return text.empty() ? paragraph("No row of this folder belongs in a published table.") : text;
  });
}

// Charts and pictures

std::string in_figures(const std::string& figures) {
  return figures.empty() ? figures : fmt::format("<div class=\"figures\">\n{}</div>\n", figures);
}

/// A chart with has_one_place() as a table, with its title, subtitle and notes.
std::string table_of(const Chart& chart, const std::string& notes) {
  return fmt::format("<h4>{}</h4>\n{}{}{}", html_text(chart.title), paragraph(html_text(chart.subtitle)),
                     html_of(values_of(chart)), paragraph(notes));
}

/// Charts with their notes, or why there is none; tables of charts with one place come first.
std::string figures_of(const std::vector<Chart>& charts) {
  std::string tables, text;
  for (const Chart& chart : charts) {
    const DrawnChart drawn = draw_svg(chart);
    const std::string said = drawn.notes.empty() ? "" : html_text(join(drawn.notes, ". ")) + ".";
    if (has_one_place(chart)) {
      tables += table_of(chart, said);
      continue;
    }
    // The chart contains its title.
    const std::string notes = said.empty() ? "" : "<figcaption>" + said + "</figcaption>";
    text += drawn.svg.empty() ? "<p class=\"problems\">" + html_text(chart.title) +
                                    ": no chart, because there is no value to draw.</p>\n"
                              : "<figure>" + drawn.svg + notes + "</figure>\n";
  }
  return tables + in_figures(text);
}

std::string pictures_of(const std::vector<FoundPicture>& pictures) {
  std::string text;
  for (const FoundPicture& picture : pictures)
    text += "<figure><img alt=\"" + html_text(picture.caption) + "\" src=\"data:image/png;base64," +
            base64(picture.png) + "\"><figcaption>" + html_text(picture.caption) + "</figcaption></figure>\n";
  return in_figures(text);
}

std::string speedup_section(const ReportInput& input) {
  const auto figures = [&](const ReportFolder& folder, const std::string& id) {
    return figures_of(with_looks_of_backends(speedup_charts(folder, input, id), input.legend));
  };
  return paragraph(
             "Published lines are dashed and have open points; measured ones have intervals. Charts of "
             "speed-ups have logarithmic axes, Figure 6 of Vassilev has linear ones. That paper shows its "
             "times "
             "as curves without numbers.") +
         of_each_folder(input, figures, "No folder has a scene of the papers with a speed-up.");
}

std::string scaling_section(const ReportInput& input) {
  const auto figures = [&](const ReportFolder& folder, const std::string& id) {
    const Table slopes = slope_table(folder, input);
    return figures_of(with_looks_of_backends(scaling_charts(folder, input, id), input.legend)) +
           (slopes.rows.empty() ? "" : html_of(slopes));
  };
  return paragraph(
             "A slope is the exponent p of time ~ nodes<sup>p</sup>, by least squares on logarithmic axes. "
             "It "
             "is 1 if a node costs the same at every size. Speed-ups over threads compare a backend with "
             "itself "
             "on the fewest threads.") +
         of_each_folder(input, figures,
                        "No folder has two sizes of a kind of scene, or two numbers of threads.");
}

std::string roofline_section(const ReportInput& input) {
  const auto figure = [&](const ReportFolder& folder, const std::string& id) {
    const auto chart = roofline_chart(folder, id);
    return chart ? figures_of(with_looks_of_backends({*chart}, input.legend)) : std::string();
  };
  return paragraph(
             "Operations and bytes are the least that a step needs. A roof is drawn at the dots of its "
             "number of threads: what the machine's peaks allow there, measured in the same process. Other "
             "programs that run at that time lower them.") +
         of_each_folder(input, figure, "No folder has rows with a roofline; garments have none.");
}

std::string energies_of(const std::vector<FoundCurve>& curves, const std::vector<FoundCurve>& references,
                        const std::string& id) {
  std::vector<Chart> charts;
  std::vector<std::string> without;
  for (const FoundCurve& curve : curves) {
    charts.push_back(energy_chart(curve, references, fmt::format("{}-energy-{}", id, charts.size())));
    if (charts.back().series.size() == 1) without.push_back(curve.name);
  }
  return figures_of(charts) +
         (without.empty() ? ""
                          : paragraph("Without a reference curve: " + html_text(join(without, ", ")) + "."));
}

std::string energy_section(const ReportInput& input) {
  const auto charts = [&](const ReportFolder& folder, const std::string& id) {
    return energies_of(folder.curves, input.references, id);
  };
  if (input.curves.empty())
    return of_each_folder(input, charts,
                          "No folder has an energy curve. <code>mssim run --scene cloth2500 "
                          "--energy-curve FOLDER/cloth2500.csv</code> writes one into a folder.");
  return paragraph("Simulated for this page, with a reference of rk4 in double precision.") +
         energies_of(input.curves, input.references, "simulated") + of_each_folder(input, charts);
}

std::string picture_section(const ReportInput& input) {
  const auto pictures = [](const ReportFolder& folder, const std::string&) {
    return pictures_of(folder.pictures);
  };
  if (input.pictures.empty())
    return of_each_folder(
        input, pictures,
        "No folder has a picture. <code>mssim render</code> draws one; put it into a folder as "
        "a PNG file.");
  return paragraph("A scene of each kind, simulated for this page by <code>openmp</code>.") +
         pictures_of(input.pictures) + of_each_folder(input, pictures);
}

// History

/// The levels of every series, and charts. Empty without a history.
std::string history_section(const ReportInput& input) {
  std::string text;
  int number = 0;
  for (const MachineHistory& machine : machines_of(input.history))
    text += fmt::format("<h3>{}</h3>\n{}{}", html_text(machine.name),
                        html_of(history_table(machine, input.threshold)),
                        figures_of(with_looks_of_backends(
                            history_charts(machine, fmt::format("history-{}", ++number)), input.legend)));
  if (text.empty()) return text;
  return paragraph(
             fmt::format("A level ends where the times change. A series without a change has a false one "
                         "with a probability of at most {} %.",
                         decimal(100 * change_error))) +
         text;
}

// Guides

/// Splits the page of a guide before each heading of this level; the first part is what comes before, without
/// a heading.
std::vector<Document> parts_of(const Document& page, int level) {
  std::vector<Document> parts(1);
  for (const auto& block : page) {
    const auto* heading = std::get_if<Heading>(&block);
    if (heading && heading->level == level) parts.emplace_back();
    parts.back().push_back(block);
  }
  return parts;
}

const std::string& heading_of(const Document& part) { return std::get<Heading>(part.front()).text; }

/// Whether the part is about the scene; headings end with its size.
bool is_about(const Document& part, const std::string& scene) {
  return heading_of(part) == scene || heading_of(part).starts_with(scene + ":");
}

/// The sentences of the page about a scene, the charts, and the page's tables, folded.
std::string guide_of_scene(const Document& scene, const std::vector<Chart>& charts, int level) {
  const std::vector<Document> parts = parts_of(scene, 3);
  Document words, methods;
  for (const auto& block : parts.front())
    (std::holds_alternative<Table>(block) ? methods : words).push_back(block);
  std::string text =
      html_of(words, level) + figures_of(charts) + folded("Methods", html_of(methods, level + 1));
  for (std::size_t i = 1; i < parts.size(); ++i)
    text += folded(heading_of(parts[i]), html_of(Document(parts[i].begin() + 1, parts[i].end()), level + 1));
  return text;
}

/// The guide of a folder, scene by scene.
std::string guide_of(const ReportFolder& folder, const ReportInput& input, const std::string& id) {
  const FoundGuide& guide = *folder.guide;
  const int level = level_in(input);
  std::vector<Document> parts = parts_of(guide.page, 2);
  // The section has its own title.
  std::erase_if(parts.front(), [](const auto& block) { return std::holds_alternative<Heading>(block); });
  std::string text = html_of(parts.front(), level);
  const std::vector<std::string> scenes = guide.scenes();
  for (const std::string& scene : scenes)
    if (std::none_of(parts.begin() + 1, parts.end(),
                     [&](const Document& part) { return is_about(part, scene); }))
      parts.push_back({Heading{2, scene}});
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const auto scene =
        std::ranges::find_if(scenes, [&](const std::string& name) { return is_about(parts[i], name); });
    std::vector<Chart> charts;
    if (scene != scenes.end())
      charts =
          with_looks_of_backends(guide_charts(guide, input.legend, folder.where_from(), *scene,
                                              fmt::format("{}-guide-{}", id, scene - scenes.begin() + 1)),
                                 input.legend);
    text += guide_of_scene(parts[i], charts, level);
  }
  return text;
}

/// The folders of guides. Empty if there are none.
std::string guide_section(const ReportInput& input) {
  return of_each_folder(input, [&](const ReportFolder& folder, const std::string& id) {
    if (!folder.guide) return std::string();
    return (folder.rows.empty() ? noise_note(folder) : "") + guide_of(folder, input, id);
  });
}

constexpr auto sections = std::to_array<PageSection>({
    {"problems", "What is missing or damaged", problem_section, false},
    {"verdict", "Verdict", verdict_section},
    {"headline", "Times", headline_section},
    {"changes", "What changed", changes_section},
    {"history", "History", history_section, false},
    {"guide", "Guide", guide_section, false},
    {"machine", "Machine and settings", machine_section, false},
    {"speed-up", "Speed-up", speedup_section},
    {"published", "Published and measured", published_section},
    {"scaling", "Scaling", scaling_section},
    {"roofline", "Roofline", roofline_section},
    {"energy", "Energy", energy_section},
    {"pictures", "Pictures", picture_section},
    {"provenance", "Provenance", provenance_section, false},
});

}  // namespace

std::span<const PageSection> report_sections() { return sections; }

}  // namespace mssim
