#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "output/tables/table.h"

namespace mssim {

/// How Hong et al. ran a step: the name in the published CSV files and the heading in their tables.
struct PaperConfiguration {
  std::string_view name;
  std::string_view caption;
};
inline constexpr std::array<PaperConfiguration, 4> paper_configurations{{
    {"cpu-only", "CPU only"},
    {"multi-thread-cpu", "Multi-thread CPU"},
    {"gpu", "GPU"},
    {"gpu+multi-thread-cpu", "GPU + multi-thread CPU"},
}};

/// A row of the TABLE of published tables of times (Hong et al. 2016).
struct PublishedTableInfo {
  std::string_view name;             ///< of our files, and in that of the data file, hong2016_NAME.csv
  std::string_view title;            ///< what it measures, and its number in the paper
  std::string_view springs_counted;  ///< how often the published counts contain a unique spring
};
inline constexpr std::array<PublishedTableInfo, 2> published_table_kinds{{
    {"table1", "Cloth: Table 1 of Hong et al. (2016)", "twice"},
    {"table3", "Bodies: Table 3 of Hong et al. (2016)", "three times"},
}};

/// One published table of times. The numbers stand in data files only.
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
  /// Does the table have any time for this scene?
  bool has_scene(std::uint64_t nodes, std::optional<std::uint64_t> springs_published) const;

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

}  // namespace mssim
