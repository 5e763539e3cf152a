#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

/// One published table of times (Hong et al. 2016, Table 1 or 3). The numbers stand in data files only.
class PublishedTable {
 public:
  /// Reads integrator, configuration, nodes, springs, ms_per_step. Throws CsvError.
  explicit PublishedTable(const std::filesystem::path& csv_file);

  /// Milliseconds per step, none where the table has none. A scene is told by its nodes and its springs as
  /// the paper counts them, so that another scene of as many nodes has no published time.
  std::optional<double> ms(std::string_view integrator, std::string_view configuration, std::uint64_t nodes,
                           std::uint64_t springs_published) const;
  /// Does the table have any time for this scene?
  bool has_scene(std::uint64_t nodes, std::uint64_t springs_published) const;

 private:
  struct Time {
    std::string integrator, configuration;
    std::uint64_t nodes = 0, springs = 0;
    double ms = 0;
  };
  std::vector<Time> times_;
};

/// Table 1 (cloth) from the data folder. Throws CsvError, and std::runtime_error when the folder is missing.
PublishedTable published_table1();

}  // namespace mssim
