#include "output/guide/guide_page.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <map>

#include "output/guide/guide_table.h"
#include "text/counted.h"

namespace mssim {
namespace {

/// "2.1e-07": errors and steps differ by orders of magnitude.
std::string in_two_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

/// Small numbers as text with two digits, which three decimals would show as 0.
void show_small_numbers(Table& table) {
  for (std::vector<Cell>& row : table.rows)
    for (Cell& cell : row)
      if (const double* number = std::get_if<double>(&cell.value); number && std::abs(*number) < 0.1)
        cell = Cell(in_two_digits(*number));
  for (Column& column : table.columns)
    if (column.name.ends_with("_s") || column.name.ends_with("_error")) column.align = Align::right;
}

/// The rows of a scene, without the first column, which names it.
Table of_scene(const Table& all, const std::string& scene) {
  Table table;
  if (all.columns.empty()) return table;
  table.columns.assign(all.columns.begin() + 1, all.columns.end());
  for (const std::vector<Cell>& row : all.rows)
    if (std::get<std::string>(row.front().value) == scene)
      table.rows.emplace_back(row.begin() + 1, row.end());
  show_small_numbers(table);
  return table;
}

const Table& table_named(const std::vector<ResultTable>& tables, std::string_view name) {
  return std::ranges::find(tables, name, &ResultTable::name)->data;
}

Table front_table(const SceneGuide& guide) {
  std::vector<const WorkPoint*> front;
  for (const WorkPoint& point : guide.points)
    if (point.on_front) front.push_back(&point);
  std::ranges::sort(front, {}, [](const WorkPoint* point) { return point->seconds_a_second(); });
  Table table;
  for (const WorkPoint* point : front)
    table.add({{"integrator", point->integrator->name},
               {"backend", point->backend},
               {"dt_s", point->dt_s},
               {"wall_s_per_s", point->seconds_a_second()},
               {"position_error", point->position_error}});
  show_small_numbers(table);
  return table;
}

void add_table(Document& page, const std::string& heading, const std::string& text, Table table) {
  if (table.rows.empty()) return;
  page.insert(page.end(), {Heading{3, heading}, Paragraph{text}, std::move(table)});
}

void add_frames(Document& page, const SceneGuide& guide, const std::vector<ResultTable>& tables) {
  Table frames = of_scene(table_named(tables, "guide-frames"), guide.scene);
  // Methods that have none say why in the summary.
  std::erase_if(frames.rows, [](const std::vector<Cell>& row) {
    return std::holds_alternative<std::monostate>(row[6].value);
  });
  add_table(page, "Largest cloths of the family",
            "With springs, masses and spacing of this scene, as squares; the step is that of the cheapest "
            "point above that keeps the error, or where none does of the cheapest stable one. Between two "
            "sizes that were measured the logarithm of the time "
            "is taken as linear in that of the nodes.",
            std::move(frames));
  add_table(
      page, "Where backends change places",
      "Nodes from which `other` is the faster one; nothing where one is faster at all sizes that both have.",
      of_scene(table_named(tables, "guide-crossovers"), guide.scene));
}

void add_scene(Document& page, const SceneGuide& guide, const std::vector<ResultTable>& tables) {
  page.emplace_back(Heading{
      2, guide.scene + ": " + counted(guide.nodes, "node") + ", " + counted(guide.springs, "spring")});
  if (!guide.trusted.failure.empty()) {
    add_sentence(page, "No errors were measured: " + guide.trusted.failure);
  } else {
    std::string recommendation;
    for (const std::string& sentence : guide.recommendation.sentences)
      recommendation += (recommendation.empty() ? "" : " ") + sentence;
    page.emplace_back(Paragraph{recommendation});
    Table summary = guide_summary(guide);
    show_small_numbers(summary);
    page.emplace_back(std::move(summary));
    std::string trusted;
    for (const std::string& sentence : about_trusted_state(guide.trusted))
      trusted += (trusted.empty() ? "" : " ") + sentence;
    page.emplace_back(Paragraph{trusted});
    add_table(page, "The front",
              "No other point that was measured is both as fast and as accurate as one of these.",
              front_table(guide));
  }
  add_table(
      page, "Largest stable steps",
      "Measured by real runs whose energy may not grow, beside linear theory with the spectrum of the "
      "scene at its start and on the way. Gershgorin's bound, which `mssim check` shows, takes all springs "
      "of a node for parallel and all its neighbours for moving against it, and is on the safe side.",
      of_scene(table_named(tables, "guide-steps"), guide.scene));
  add_frames(page, guide, tables);
}

}  // namespace

std::vector<std::string> about_trusted_state(const TrustedState& trusted) {
  std::vector<std::string> sentences;
  sentences.push_back("Errors are those " + in_two_digits(trusted.horizon_s) + " s after the start (" +
                      trusted.why_there + "; a neighbouring trajectory is then " +
                      in_two_digits(trusted.parting) + " times as far away as at the start).");
  std::string reference = "The reference is rk4 in double precision with a step of " +
                          in_two_digits(trusted.dt_s) + " s, whose own error is " +
                          in_two_digits(trusted.own_error) + " of a mean rest length";
  if (trusted.confirmed)
    reference += "; another solver (Bulirsch-Stoer) ends " + in_two_digits(*trusted.confirmed) + " from it";
  else
    reference += "; there was no time to confirm it by another solver";
  sentences.push_back(reference + ".");
  sentences.push_back("Points whose error is below " + in_two_digits(trusted_margin * trusted.error()) +
                      ", " + in_two_digits(trusted_margin) + " times that, are marked and not compared.");
  return sentences;
}

Document guide_page(std::span<const SceneGuide> guides, const std::vector<ResultTable>& tables,
                    const Provenance& provenance) {
  Document page{
      Heading{1, "Which integrator, which backend, which step"}, measured_on({}, provenance),
      Paragraph{"*wall_s_per_s* is what a simulated second takes. *position_error* is the largest distance "
                "of a node from where it should be, in mean rest lengths, and *energy_error* that of the "
                "total energy over what is kinetic and elastic. How each number is found: docs/guide.md."}};
  for (const SceneGuide& guide : guides) add_scene(page, guide, tables);
  return page;
}

}  // namespace mssim
