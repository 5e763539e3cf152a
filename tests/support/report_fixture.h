#pragma once

#include "report/report.h"
#include "tests/support/result_fixture.h"
#include "tests/support/testing.h"

namespace mssim {

/// A row of six rounds on a published cloth.
inline ResultRow cloth_row(std::uint64_t nodes, std::uint64_t springs_published, const std::string& backend,
                           double ms, const std::string& integrator = "semi-euler") {
  ResultRow row = in_six_rounds(measured_row(backend, ms, std::nullopt));
  row.scene = "cloth" + std::to_string(nodes);
  row.nodes = nodes;
  row.springs_published = springs_published;
  row.springs_unique = springs_published / 2;
  row.integrator = integrator;
  return row;
}

/// Of a cloth, of three rounds.
inline std::vector<ResultRow> serial_and_openmp_rows() {
  return {measured_row("serial", 1, 1.0), measured_row("openmp", 0.5, 2.0)};
}

/// A folder of these rows, as a report finds it.
inline ReportFolder folder_of(std::vector<ResultRow> rows, std::optional<Provenance> provenance = {}) {
  ReportFolder folder;
  folder.rows = std::move(rows);
  folder.provenance = std::move(provenance);
  return folder;
}

/// What a report has of the papers but for their claims.
inline ReportInput of_papers() {
  ReportInput input;
  input.legend = legend;
  input.published = published_tables();
  return input;
}

}  // namespace mssim
