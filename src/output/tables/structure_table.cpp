#include "output/tables/structure_table.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "output/tables/published_bodies.h"

namespace mssim {
namespace {

constexpr std::string_view how_to_read_structure =
    "Nodes and springs are what the mesh of the scene has, counted from its tetrahedra. The published counts "
    "of springs are three times the unique edges, by inference: all nine can be divided by three, a third of "
    "each fits a tetrahedral mesh of that many nodes, and the packed unit of the paper's Figure 6 holds "
    "three values for each spring. Inner points and surfaces were chosen so that TetGen meets both published "
    "numbers; the paper shows neither its surfaces nor its switches.";

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

Table data_of(const std::vector<Match>& matches) {
  Table table;
  for (const Match& match : matches) {
    const auto& [row, body] = match;
    table.add({{"scene", row->scene},
               {"nodes", row->nodes},
               {"springs_unique", row->springs_unique},
               {"springs_published", row->springs_published},
               {"tetrahedra", row->tetrahedra},
               {"smallest_dihedral_angle_deg", row->smallest_dihedral_angle_deg},
               {"paper_nodes", body ? Cell(body->nodes) : Cell()},
               {"paper_springs", body ? Cell(body->springs) : Cell()},
               {"same_as_paper", body ? Cell(match.same()) : Cell()}});
  }
  return table;
}

Cell strong(Cell cell) {
  cell.strong = true;
  return cell;
}

Document page_of(const std::vector<Match>& matches, const Provenance& provenance) {
  Table table{{{"body", Align::left},
               {"size", Align::left},
               {"nodes, *published*", Align::right},
               {"nodes", Align::right},
               {"springs, *published*", Align::right},
               {"springs x 3", Align::right},
               {"unique springs", Align::right},
               {"tetrahedra", Align::right},
               {"smallest dihedral angle", Align::right, "°"},
               {"same", Align::left}},
              {}};
  for (const Match& match : matches) {
    const auto& [row, body] = match;
    if (!body) continue;
    table.rows.push_back({body->object, body->size, body->nodes, strong(row->nodes), body->springs,
                          strong(row->springs_published), row->springs_unique, row->tetrahedra,
                          row->smallest_dihedral_angle_deg, match.same() ? Cell(true) : strong(false)});
  }
  return {Heading{1, "Bodies: Table 2 of Hong et al. (2016), published and built"},
          Paragraph{made_by(provenance) + "."}, Paragraph{std::string(how_to_read_structure)},
          std::move(table)};
}

}  // namespace

ResultTable structure_table(std::span<const StructureRow> rows, const Provenance& provenance) {
  const std::vector<PublishedBody> bodies = published_bodies();
  const std::vector<Match> matches = paired(rows, bodies);
  return {"table2", data_of(matches), page_of(matches, provenance)};
}

}  // namespace mssim
