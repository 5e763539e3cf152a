#include "output/tables/structure_table.h"

#include <algorithm>
#include <sstream>
#include <vector>

#include "output/tables/csv.h"
#include "output/tables/markdown.h"
#include "output/tables/published_bodies.h"

namespace mssim {
namespace {

constexpr std::string_view how_to_read =
    "Nodes and springs are what the mesh of the scene has, counted from its tetrahedra. The published counts "
    "of "
    "springs are three times the unique edges, by inference: all nine can be divided by three, a third of "
    "each fits a "
    "tetrahedral mesh of that many nodes, and the packed unit of the paper's Figure 6 holds three values for "
    "each "
    "spring. Inner points and surfaces were chosen so that TetGen meets both published numbers; the paper "
    "shows "
    "neither its surfaces nor its switches.\n\n";

struct Match {
  const StructureRow* row;
  const PublishedBody* body;  ///< null where the paper has no such body

  bool same() const { return row->nodes == body->nodes && row->springs_published == body->springs; }
};

std::vector<Match> paired(std::span<const StructureRow> rows, const std::vector<PublishedBody>& bodies) {
  std::vector<Match> matches;
  for (const StructureRow& row : rows) {
    const auto body = std::find_if(bodies.begin(), bodies.end(), [&](const PublishedBody& candidate) {
      return candidate.scene() == row.scene;
    });
    matches.push_back({&row, body == bodies.end() ? nullptr : &*body});
  }
  return matches;
}

std::string as_csv(const std::vector<Match>& matches) {
  std::string csv =
      csv_line({"scene", "nodes", "springs_unique", "springs_published", "tetrahedra",
                "smallest_dihedral_angle_deg", "paper_nodes", "paper_springs", "same_as_paper"});
  for (const Match& match : matches) {
    const StructureRow& row = *match.row;
    std::vector<std::string> fields{row.scene,
                                    std::to_string(row.nodes),
                                    std::to_string(row.springs_unique),
                                    std::to_string(row.springs_published),
                                    std::to_string(row.tetrahedra),
                                    csv_number(row.smallest_dihedral_angle_deg)};
    if (match.body)
      fields.insert(fields.end(), {std::to_string(match.body->nodes), std::to_string(match.body->springs),
                                   match.same() ? "true" : "false"});
    else
      fields.insert(fields.end(), 3, "");
    csv += csv_line(fields);
  }
  return csv;
}

std::string as_markdown(const std::vector<Match>& matches, const Provenance& provenance) {
  std::ostringstream text;
  text
      << "# Bodies: Table 2 of Hong et al. (2016), published and built\n\n"
      << "mssim " << provenance.build.version << ", commit " << provenance.build.commit.substr(0, 12)
      << (provenance.build.dirty ? " with uncommitted changes" : "") << "; " << provenance.started_utc
      << ".\n\n"
      << how_to_read
      << "| body | size | nodes, *published* | nodes | springs, *published* | springs x 3 | unique springs | "
         "tetrahedra | smallest dihedral angle | same |\n|---|---|---:|---:|---:|---:|---:|---:|---:|---|\n";
  for (const auto& [row, body] : matches) {
    if (!body) continue;
    text << "| " << body->object << " | " << body->size << " | " << grouped(body->nodes) << " | **"
         << grouped(row->nodes) << "** | " << grouped(body->springs) << " | **"
         << grouped(row->springs_published) << "** | " << grouped(row->springs_unique) << " | "
         << grouped(row->tetrahedra) << " | " << three_digits(row->smallest_dihedral_angle_deg) << "° | "
         << (Match{row, body}.same() ? "yes" : "**no**") << " |\n";
  }
  return text.str();
}

}  // namespace

StructureTable structure_table(std::span<const StructureRow> rows, const Provenance& provenance) {
  const std::vector<PublishedBody> bodies = published_bodies();
  const std::vector<Match> matches = paired(rows, bodies);
  return {as_csv(matches), as_markdown(matches, provenance)};
}

}  // namespace mssim
