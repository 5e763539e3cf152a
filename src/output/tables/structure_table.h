#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "output/tables/result_table.h"

namespace mssim {

/// What the mesh of a body is, a row of table2.csv.
struct StructureRow {
  std::string scene;
  std::uint64_t nodes = 0;
  std::uint64_t springs_unique = 0;     ///< edges of the tetrahedra
  std::uint64_t springs_published = 0;  ///< as Hong et al. count them
  std::uint64_t tetrahedra = 0;
  double smallest_dihedral_angle_deg = 0;  ///< between two faces of a tetrahedron
};

/// Table 2 of Hong et al. with our meshes in it. The data has the columns of StructureRow, then paper_nodes,
/// paper_springs, same_as_paper. Rows of scenes that are not the paper's, which are named BODY-SIZE there,
/// stay out of the page. Throws CsvError when the published table cannot be read.
ResultTable structure_table(std::span<const StructureRow> rows, const Provenance& provenance);

}  // namespace mssim
