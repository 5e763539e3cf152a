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
#include "text/text.h"

namespace mssim {

// Hong et al. (2016), as published. The numbers are only in files of the data folder.

/// How the paper ran a step: the name in the published CSV files and the heading in its tables.
struct PaperConfiguration {
  std::string_view name;
  std::string_view caption;
};
/// The configurations of the paper.
inline constexpr auto paper_configurations = std::to_array<PaperConfiguration>({
    {"cpu-only", "CPU only"},
    {"multi-thread-cpu", "Multi-thread CPU"},
    {"gpu", "GPU"},
    {"gpu+multi-thread-cpu", "GPU + multi-thread CPU"},
});

/// A row of the TABLE of published tables of times.
struct PublishedTableInfo {
  TableName name;                    ///< of our table; hong2016_NAME.csv is the data file
  std::string_view title;            ///< its subject, and its number in the paper
  std::string_view springs_counted;  ///< how often the published counts include each spring
};
/// The TABLE of published tables of times.
inline constexpr auto published_table_kinds = std::to_array<PublishedTableInfo>({
    {"table1", "Cloth: Table 1 of Hong et al. (2016)", "twice"},
    {"table3", "Bodies: Table 3 of Hong et al. (2016)", "three times"},
});

/// The device that Hong et al. measured.
inline constexpr std::string_view paper_device = "Nexus 7";

/// The configuration that published speed-ups are relative to.
inline constexpr std::string_view one_thread_configuration = "cpu-only";

/// A measured scene of a published table.
struct PaperScene {
  std::string name;
  std::uint64_t nodes = 0, springs = 0;  ///< springs as the paper counts them
};

/// One published table of times.
class PublishedTable {
 public:
  /// Reads integrator, configuration, nodes, springs, ms_per_step from the data folder. Throws CsvError, and
  /// std::runtime_error if the folder is missing.
  explicit PublishedTable(const PublishedTableInfo& table_info);

  /// Takes the numbers from a table. Throws CsvError.
  PublishedTable(const PublishedTableInfo& table_info, const CsvTable& table);

  const PublishedTableInfo& info() const { return info_; }

  /// Published ms per step; none if the table has no such time. A scene is identified by its nodes and its
  /// springs as the paper counts them, so another scene with as many nodes has no published time.
  std::optional<double> ms(std::string_view integrator, std::string_view configuration, std::uint64_t nodes,
                           std::optional<std::uint64_t> springs_published) const;
  /// Published speed-up over one thread; none if either time is missing.
  std::optional<double> speedup(std::string_view integrator, std::string_view configuration,
                                const PaperScene& scene) const;
  /// Whether the table has any time for this scene.
  bool has_scene(std::uint64_t nodes, std::optional<std::uint64_t> springs_published) const;
  /// The table's scenes, in its order, without names.
  std::vector<PaperScene> scenes() const;
  /// The scenes of the rows that are in the table, each once, by size.
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

/// Reads all published tables. Throws like the constructor.
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

/// The bodies in the published order, from the data folder. Throws CsvError, and std::runtime_error if the
/// folder is missing.
std::vector<PublishedBody> published_bodies();

/// The bodies in a table. Throws CsvError.
std::vector<PublishedBody> published_bodies(const CsvTable& table);

// Tables of suites.

/// How backends and integrators correspond to the paper, in the order of display.
struct PaperLegend {
  struct Backend {
    std::string name;
    std::string configuration;  ///< a name of paper_configurations; empty if there is none
    bool has_threads = false;   ///< whether the configuration has several threads
  };
  struct Integrator {
    std::string name;
    std::string paper_name;  ///< the corresponding published integrator
    int force_evaluations = 0;
  };
  std::vector<Backend> backends;
  std::vector<Integrator> integrators;

  /// The configuration of the backend; empty if there is none.
  std::string configuration_of(std::string_view backend) const {
    const Backend* found = found_in(backends, backend, &Backend::name);
    return found ? found->configuration : "";
  }
};

/// For every published table with any of the rows, makes the table with our measurements, laid out as
/// published: scenes are columns, configurations are lines, one block per integrator. Scenes, integrators and
/// backends without a row are left out, and so are scenes that are not in the published table. The data has,
/// for every integrator and backend, the lines published_ms, measured_ms, published_speedup, measured_speedup
/// and status. Speed-ups are over one thread: published ones over CPU only, measured ones over `serial`.
TableMaker paper_tables(PaperLegend legend, std::vector<PublishedTable> published);

/// The mesh of a body, a row of table2.csv.
struct StructureRow {
  std::string scene;
  std::uint64_t nodes = 0;
  std::uint64_t springs_unique = 0;     ///< edges of the tetrahedra
  std::uint64_t springs_published = 0;  ///< as Hong et al. count them
  std::uint64_t tetrahedra = 0;
  double smallest_dihedral_angle_deg = 0;  ///< between two faces of a tetrahedron
};

/// A line for each row, with its members as columns.
Table structure_rows(std::span<const StructureRow> rows);
/// The rows of a table2.csv. Throws CsvError.
std::vector<StructureRow> read_structure(const CsvTable& table);

/// Table 2 of Hong et al. with our meshes. The data has the columns of StructureRow, then paper_nodes,
/// paper_springs, same_as_paper. The page leaves out scenes that are not the paper's, which are named
/// BODY-SIZE there. Throws CsvError if the published table cannot be read.
ResultTable structure_table(std::span<const StructureRow> rows, const Provenance& provenance);

/// Properties of a method against data races that are not measured.
struct RaceLegend {
  std::string method;
  std::string description;
  std::string extra_memory;
  std::string springs_computed;
  std::string repeatable;
};

/// Makes the table `races`: for every scene and integrator one line per method, with its time, its ratio to
/// `serial` and its other costs. Methods without a legend, and rows of other backends, are left out.
TableMaker race_tables(std::vector<RaceLegend> legend);

/// Makes the table `scaling`: ns per node and step of every backend and integrator, scene by scene, and its
/// ratio to that of the same backend on the scene `base`. Above 1, the cost grows faster than the scene.
TableMaker scaling_tables(std::string base);

/// Makes the table `peers`: on every scene one line per backend, with its time relative to `openmp` on as
/// many processors, the processors that it used, its error against the reference, and its notes.
TableMaker peer_tables();

/// A row with those of the same backend, scene and integrator on other numbers of threads.
struct ThreadRow {
  const ResultRow* row = nullptr;
  std::string_view backend;  ///< without the number of threads
  int threads = 0;           ///< that computed its steps; if these were more than requested, the request
  /// The row on the fewest threads, and their number.
  const ResultRow* fewest = nullptr;
  int fewest_threads = 0;

  /// Speed-up over the row on the fewest threads.
  std::optional<RatioInterval> speedup() const { return times_as_fast(row, fewest); }
};

/// The rows with several numbers of threads, in order. Rows with more threads than the run are left out, such
/// as `threads-mutex:10` on two processors: their threads share CPUs, which is no scaling. Of rows that count
/// and have the same number only the first is taken: `openmp` uses fewer threads on a narrow cloth, however
/// many are requested. A row that does not count has the requested number.
std::vector<ThreadRow> thread_rows(RowPointers rows, const Provenance& provenance);

/// Adds the table `threads` of thread_rows after the tables of `maker`: times, speed-ups over the fewest
/// threads, and efficiencies, which are speed-ups divided by the ratio of threads.
TableMaker with_thread_table(TableMaker maker);

/// A program in ranks, and the same ranks with the whole scene in each.
inline constexpr std::string_view ranks_backend = "mpi", copies_backend = "mpi-copies";

/// "mpi:4"
std::string name_in_ranks(std::string_view backend, int ranks);

/// A scene that is named as a multiple of another one in width: cloth10k-x4.
struct WideScene {
  std::string_view base;
  int times = 1;
};
/// Splits such a name; any other name is its own base, `times` 1.
WideScene wide_scene(std::string_view scene);

/// Number of stages by name of integrator.
using StageCounts = std::map<std::string, int, std::less<>>;

/// Makes the table `cluster`: for every scene in 1, 2, 4, ... processes the time per step, its shares of
/// computing, packing and waiting, the messages, two efficiencies, and the prediction of a model of
/// computing, latency and volume.
TableMaker cluster_tables(StageCounts stages);

}  // namespace mssim
