#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "output/tables/results.h"

namespace mssim {

// Hong et al. (2016), as published. The numbers stand in files of the data folder only.

/// How they ran a step: the name in the published CSV files and the heading in their tables.
struct PaperConfiguration {
  std::string_view name;
  std::string_view caption;
};
inline constexpr auto paper_configurations = std::to_array<PaperConfiguration>({
    {"cpu-only", "CPU only"},
    {"multi-thread-cpu", "Multi-thread CPU"},
    {"gpu", "GPU"},
    {"gpu+multi-thread-cpu", "GPU + multi-thread CPU"},
});

/// A row of the TABLE of published tables of times.
struct PublishedTableInfo {
  TableName name;                    ///< of our table, and in that of the data file, hong2016_NAME.csv
  std::string_view title;            ///< what it measures, and its number in the paper
  std::string_view springs_counted;  ///< how often the published counts contain a unique spring
};
inline constexpr auto published_table_kinds = std::to_array<PublishedTableInfo>({
    {"table1", "Cloth: Table 1 of Hong et al. (2016)", "twice"},
    {"table3", "Bodies: Table 3 of Hong et al. (2016)", "three times"},
});

/// What they measured on.
inline constexpr std::string_view paper_device = "Nexus 7";

/// The configuration that speed-ups are over.
inline constexpr std::string_view one_thread_configuration = "cpu-only";

/// A scene of a published table that was measured.
struct PaperScene {
  std::string name;
  std::uint64_t nodes = 0, springs = 0;  ///< springs as the paper counts them
};

/// One published table of times.
class PublishedTable {
 public:
  /// Reads integrator, configuration, nodes, springs, ms_per_step from the data folder. Throws CsvError, and
  /// std::runtime_error when the folder is missing.
  explicit PublishedTable(const PublishedTableInfo& table_info);

  /// Takes the numbers from a table that was read. Throws CsvError.
  PublishedTable(const PublishedTableInfo& table_info, const CsvTable& table);

  const PublishedTableInfo& info() const { return info_; }

  /// Milliseconds per step, none where the table has none. A scene is told by its nodes and its springs as
  /// the paper counts them, so that another scene of as many nodes has no published time.
  std::optional<double> ms(std::string_view integrator, std::string_view configuration, std::uint64_t nodes,
                           std::optional<std::uint64_t> springs_published) const;
  /// How many times as fast as one thread a scene's is; none where either time is missing.
  std::optional<double> speedup(std::string_view integrator, std::string_view configuration,
                                const PaperScene& scene) const;
  /// Does the table have any time for this scene?
  bool has_scene(std::uint64_t nodes, std::optional<std::uint64_t> springs_published) const;
  /// Its scenes, without names, in its order.
  std::vector<PaperScene> scenes() const;
  /// The scenes of the rows that it has, each once, by size.
  std::vector<PaperScene> scenes_of(std::span<const ResultRow> rows) const;

 private:
  struct Time {
    std::string integrator, configuration;
    std::uint64_t nodes = 0, springs = 0;
    double ms = 0;
  };
  PublishedTableInfo info_;
  std::vector<Time> times_;
};

/// All of them, read. Throws like the constructor.
std::vector<PublishedTable> published_tables();

/// A body of Table 2, as published.
struct PublishedBody {
  std::string object;  ///< box, sphere or torus
  std::string size;    ///< small, medium or large
  std::uint64_t nodes = 0;
  std::uint64_t springs = 0;  ///< as the paper counts them: three times the edges, by inference

  /// The name of its scene.
  std::string scene() const { return object + "-" + size; }
};

/// The bodies in the published order, from the data folder. Throws CsvError, and std::runtime_error when the
/// folder is missing.
std::vector<PublishedBody> published_bodies();

/// Takes the bodies from a table that was read. Throws CsvError.
std::vector<PublishedBody> published_bodies(const CsvTable& table);

// The tables of suites.

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

/// Makes, of every published table that any row belongs into, the table with our measurements in it, laid out
/// as published: scenes are columns, configurations are lines, one block an integrator. Shown is what was
/// measured: scenes, integrators and backends without a row are left out, and so are scenes that are not the
/// table's. The data has, for every integrator and backend, the lines published_ms, measured_ms,
/// published_speedup, measured_speedup and status. Speed-ups are over one thread, published ones over CPU
/// only and measured ones over `serial`.
TableMaker paper_tables(PaperLegend legend, std::vector<PublishedTable> published);

/// What the mesh of a body is, a row of table2.csv.
struct StructureRow {
  std::string scene;
  std::uint64_t nodes = 0;
  std::uint64_t springs_unique = 0;     ///< edges of the tetrahedra
  std::uint64_t springs_published = 0;  ///< as Hong et al. count them
  std::uint64_t tetrahedra = 0;
  double smallest_dihedral_angle_deg = 0;  ///< between two faces of a tetrahedron
};

/// A row of these columns for each.
Table structure_rows(std::span<const StructureRow> rows);

/// Table 2 of Hong et al. with our meshes in it. The data has the columns of StructureRow, then paper_nodes,
/// paper_springs, same_as_paper. Rows of scenes that are not the paper's, which are named BODY-SIZE there,
/// stay out of the page. Throws CsvError when the published table cannot be read.
ResultTable structure_table(std::span<const StructureRow> rows, const Provenance& provenance);

/// What the table of methods says about one of them, for the columns that no clock can fill.
struct RaceLegend {
  std::string method;
  std::string description;
  std::string extra_memory;
  std::string springs_computed;
  std::string repeatable;
};

/// Makes the table `races`: for every scene and integrator a line a method, with its time, its ratio to
/// `serial` and what it costs beside time. Methods without a legend, and rows of other backends, stay out.
TableMaker race_tables(std::vector<RaceLegend> legend);

/// Makes the table `scaling`: nanoseconds a node and step of every backend and integrator, scene by scene,
/// and how many times as much as the same backend takes on the scene `base`. A line that grows above 1 grows
/// faster than the scene.
TableMaker scaling_tables(std::string base);

/// Makes the table `peers`: on every scene a line a backend, with its time over that of `openmp` on as many
/// processors, what it took of them, its error against the reference, and what it says of itself.
TableMaker peer_tables();

/// A row beside those of the same backend, scene and integrator on other numbers of threads.
struct ThreadRow {
  const ResultRow* row = nullptr;
  std::string_view backend;  ///< without the number of threads
  int threads = 0;           ///< that it was asked to use
  /// The row on the fewest threads, and how many those are.
  const ResultRow* fewest = nullptr;
  int fewest_threads = 0;

  /// How many times as fast as on the fewest threads it is.
  std::optional<RatioInterval> speedup() const { return times_as_fast(row, fewest); }
};

/// Those of the rows of which there are several, in their order.
std::vector<ThreadRow> thread_rows(RowPointers rows, const Provenance& provenance);

/// The maker, and behind its tables the table `threads` of thread_rows: times, speed-ups over the fewest
/// threads, and efficiencies, which are these over how many times as many threads there are.
TableMaker with_thread_table(TableMaker maker);

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

/// Stages of an integrator, by its name.
using StageCounts = std::map<std::string, int, std::less<>>;

/// Makes the table `cluster`: for every scene in 1, 2, 4, ... processes the time of a step, how it is shared
/// between computing, packing and waiting, what is sent, two efficiencies, and what a model of computing,
/// latency and volume says.
TableMaker cluster_tables(StageCounts stages);

}  // namespace mssim
