#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cluster/step_model.h"
#include "output/tables/result_table.h"

namespace mssim {

/// A program in ranks, and the same ranks where each steps the whole scene for itself.
inline constexpr std::string_view ranks_backend = "mpi", copies_backend = "mpi-copies";

/// "mpi:4"
std::string name_in_ranks(std::string_view backend, int ranks);

/// What a scene is called that is so many times as wide as another: cloth10k-x4.
struct WideScene {
  std::string_view base;
  int times = 1;
};
WideScene wide_scene(std::string_view scene);

/// A measured row of one scene in several processes.
struct ClusterRow {
  const ResultRow* row = nullptr;
  WideScene scene;
  std::string_view program;  ///< the backend without its number of ranks
  int ranks = 0;             ///< 0: one process that knows of no others
};

/// Stages of an integrator, by its name.
using StageCounts = std::map<std::string, int, std::less<>>;

/// The rows of a run, and what follows from several of them.
class ClusterRows {
 public:
  /// `rows` and `provenance` must outlive this.
  ClusterRows(RowPointers rows, const Provenance& provenance, StageCounts stages);

  const std::vector<ClusterRow>& all() const { return rows_; }

  /// Nodes a second over `ranks` times those of one rank of the same program on the same scene, or on the one
  /// that it is a multiple of. None where either does not count.
  std::optional<double> efficiency(const ClusterRow& row) const;
  /// Nodes a second over those of as many copies that send nothing.
  std::optional<double> efficiency_of_copies(const ClusterRow& row) const;
  /// Milliseconds of a step by the model of cluster/step_model.h, of a cloth in several ranks: from the time
  /// of copies, and from the speed of messages, their bytes and their number as the row has them.
  std::optional<double> modelled_ms(const ClusterRow& row) const;
  /// What all processes of a machine together take for a stage of a node.
  struct MachineRate {
    const ResultRow* row = nullptr;  ///< that says so
    double node_stage_s = 0;
  };
  /// That of the row with most copies of the largest cloth of which there is a model; none where there is
  /// no such row.
  std::optional<MachineRate> machine_rate() const;
  int stages_of(const ResultRow& row) const { return stages_.at(row.integrator); }

 private:
  const ResultRow* pluralize(const ClusterRow& like, std::string_view program, int ranks) const;

  std::vector<ClusterRow> rows_;
  StageCounts stages_;
};

}  // namespace mssim
