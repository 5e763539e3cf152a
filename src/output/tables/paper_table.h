#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/machine/provenance.h"
#include "bench/results/result.h"
#include "output/tables/published.h"
#include "output/tables/result_table.h"

namespace mssim {

/// What the tables of backends and integrators say about the paper, in the order in which both are to be
/// shown.
struct PaperLegend {
  struct Backend {
    std::string name;
    std::string configuration;  ///< a name of paper_configurations
  };
  struct Integrator {
    std::string name;
    std::string paper_name;  ///< the published integrator that it stands for
    int force_evaluations = 0;
  };
  std::vector<Backend> backends;
  std::vector<Integrator> integrators;
};

/// A table of Hong et al. with our measurements in it, laid out as published: scenes are columns,
/// configurations are lines, one block an integrator. Shown is what was measured: scenes, integrators and
/// backends without a row are left out, and so are scenes that are not the table's; none where no row belongs
/// into the table. The data has, for every integrator and backend, the lines published_ms, measured_ms,
/// published_speedup, measured_speedup and status. Speed-ups are over one thread, published ones over CPU
/// only and measured ones over `serial`.
std::optional<ResultTable> paper_table(std::span<const ResultRow> rows, const PaperLegend& legend,
                                       const PublishedTable& published, const Provenance& provenance);

/// Makes the paper_table of every published table that any row belongs into.
TableMaker paper_tables(PaperLegend legend, std::vector<PublishedTable> published);

}  // namespace mssim
