#include <algorithm>
#include <array>
#include <iterator>

#include "bench/results/comparison.h"
#include "output/tables/comparison_table.h"
#include "report/html.h"
#include "report/sections.h"
#include "text/text.h"

namespace mssim {
namespace {

/// A sign and a class beside the words, so that outcomes differ without colour and at a glance.
struct OutcomeLook {
  std::string_view sign, style;
};
OutcomeLook look_of(Outcome outcome) {
  constexpr std::array<OutcomeLook, 6> looks{
      {{"✓", "yes"}, {"◐", "partly"}, {"✗", "no"}, {"?", "partly"}, {"•", "fact"}, {"!", "no"}}};
  return looks[static_cast<std::size_t>(outcome)];
}

std::string list_of(const std::vector<Finding>& findings) {
  std::string text = "<ul class=\"findings\">\n";
  for (const Finding& finding : findings) {
    const OutcomeLook look = look_of(finding.outcome);
    text.append("<li class=\"").append(look.style).append("\"><strong>").append(look.sign).append(" ");
    text.append(name_of(finding.outcome)).append("</strong> ") += html_prose(finding.sentence) + "</li>\n";
  }
  return text + "</ul>\n";
}

std::string count_of(const std::vector<Finding>& findings) {
  const auto number = [&](Outcome outcome) {
    return std::to_string(std::ranges::count(findings, outcome, &Finding::outcome));
  };
  const auto published = std::ranges::count_if(findings, [](const Finding& finding) {
    return finding.outcome != Outcome::fact && finding.outcome != Outcome::warning;
  });
  if (published == 0) return "<p>Nothing published stands beside these rows.</p>\n";
  return "<p>Of " + pluralize(static_cast<std::uint64_t>(published), "published statement") + ", " +
         number(Outcome::reproduced) + " are reproduced, " + number(Outcome::partly) + " partly, " +
         number(Outcome::not_reproduced) + " are not, and " + number(Outcome::undecided) +
         " are undecided.</p>\n";
}

void add_to(std::vector<Finding>& findings, std::vector<Finding> more) {
  std::ranges::move(more, std::back_inserter(findings));
}

/// The rows that can be compared: those that count have samples.
std::vector<ResultRow> with_samples(const ReportFolder& folder) {
  std::vector<ResultRow> rows;
  std::ranges::copy_if(folder.rows, std::back_inserter(rows),
                       [](const ResultRow& row) { return !counts(row) || !row.samples_ms.empty(); });
  return rows;
}

std::string names_of(const std::vector<std::string>& combinations) {
  return html_text(join(combinations, "; "));
}

}  // namespace

std::vector<Finding> findings_of(const ReportFolder& folder, const ReportInput& input) {
  std::vector<Finding> findings;
  for (const PublishedTable& published : input.published) {
    const PaperScenes scenes(folder.rows, input.legend, published);
    add_to(findings, order_findings(scenes));
    add_to(findings, trend_findings(scenes));
    add_to(findings, cost_findings(scenes));
  }
  add_to(findings, garment_findings(folder.rows));
  add_to(findings, row_findings(folder.rows, folder.provenance.value_or(Provenance())));
  return findings;
}

std::string verdict_section(const ReportInput& input) {
  std::string text =
      "<p>Each sentence says first what a paper published, then what was measured. A row that is not "
      "verified counts "
      "nowhere. Tables 1 and 3 are those of Hong et al. (2016).</p>\n";
  for (const ReportFolder& folder : input.folders) {
    const std::vector<Finding> findings = findings_of(folder, input);
    text += folder_heading(input, folder);
    text += findings.empty() ? "<p>There is no row to judge.</p>\n" : count_of(findings) + list_of(findings);
  }
  return text;
}

std::string changes_section(const ReportInput& input) {
  if (input.folders.size() != 2) return {};
  const ReportFolder &base = input.folders[0], &next = input.folders[1];
  std::string text = "<p>BASE is " + html_text(base.name) + ", NEW is " + html_text(next.name) + ".</p>\n";
  std::vector<std::string> unlike = differences(base.rows, next.rows);
  if (base.provenance && next.provenance) {
    const auto of_runs = differences(*base.provenance, *next.provenance);
    unlike.insert(unlike.begin(), of_runs.begin(), of_runs.end());
  } else {
    unlike.insert(unlike.begin(), "not both folders say where they come from");
  }
  if (!unlike.empty())
    return text + "<p>The two runs are not comparable: " + html_text(join(unlike, "; ")) +
           ".</p>\n<p><code>mssim compare --force</code> compares them anyway.</p>\n";
  const RunComparison comparison = compare(with_samples(base), with_samples(next), input.threshold);
  if (comparison.rows.empty()) return text + "<p>They have no measured combination in common.</p>\n";
  text += html_of(comparison_page(comparison), 3);
  if (!comparison.only_base.empty())
    text += "<p>Only BASE has: " + names_of(comparison.only_base) + ".</p>\n";
  if (!comparison.only_new.empty()) text += "<p>Only NEW has: " + names_of(comparison.only_new) + ".</p>\n";
  if (!comparison.untimed.empty())
    text += "<p>Without a verified time in BASE: " + names_of(comparison.untimed) + ".</p>\n";
  return text;
}

}  // namespace mssim
