#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "backends/backends.h"
#include "backends/interface/backend.h"
#include "bench/machine/provenance.h"
#include "integrators/integrator.h"

namespace mssim {

/// The integrator of that name. Throws UsageError naming the nearest or listing the known.
const Integrator& require_integrator(const std::string& name);

/// Those of `asked`, or where it is empty of `by_default`, in the order of the table; "all" alone stands for
/// every one. Throws UsageError like require_integrator.
std::vector<const Integrator*> chosen_integrators(const std::vector<std::string>& asked,
                                                  std::span<const std::string_view> by_default);

/// More host threads than this are a typing error, and would only fail later and less clearly.
inline constexpr int most_threads = 4096;

/// The largest number of processes.
inline constexpr int most_ranks = 65536;

/// The word for it that --memory takes.
std::string name_of(DeviceMemory memory);

/// Throws UsageError where there is a thread_excess. `asked`: what says the number, where that is not
/// --threads.
void require_few_threads(int threads, std::string_view asked = {});

/// `threads` as given or, for 0, one for every processor that this process may use, as far as a container's
/// quota lets it; OpenMP then gives as many, whatever OMP_DYNAMIC says. Throws UsageError where
/// OMP_THREAD_LIMIT is lower, and as require_few_threads, but where a launcher starts them elsewhere.
ExecutionOptions complete(ExecutionOptions options);

/// What a command line says of programs that are backends.
struct OwnBackendOptions {
  std::vector<std::string> folders;  ///< where descriptions are looked for first
  std::optional<double> limit_s;     ///< of every answer; none: as described, or 120 s
};

/// What the row is called of a backend that was asked for by this name or path.
std::string row_name(const std::string& asked);

/// Whether a row is another one of that backend: "openmp:2" of "openmp".
inline bool is_variant(std::string_view row, std::string_view backend) {
  return row.starts_with(backend) && row.substr(backend.size()).starts_with(':');
}

/// The rows of the TABLE of backends, in its order.
std::vector<const BackendInfo*> table_backends();

/// `rows`, and after them the backends that step nothing but garments.
std::vector<const BackendInfo*> with_garment_backends(std::vector<const BackendInfo*> rows);

/// The backends that a command may use: the rows of a table, and programs of the user's, which are looked up
/// when they are asked for. Rows stay where they are while this object lives, also where it is moved.
class BackendChoice {
 public:
  BackendChoice() = default;
  /// `known`: the rows of the table. `scenes`: as they were asked for; the folders of those that are files
  /// may hold descriptions.
  BackendChoice(std::vector<const BackendInfo*> known, const OwnBackendOptions& options,
                const std::vector<std::string>& scenes = {});

  /// The row of that name: of the table, the file of that path (which has a slash), or the one described as
  /// NAME.json; NAME:COUNT is one that runs in so many ranks, or one of the table on so many threads, and
  /// NAME:each one of the table that steps each body for itself (NAME:each:COUNT both). Throws UsageError
  /// naming the nearest or listing the known, where a name stands for two, and as require_few_threads;
  /// MissingProgram for a path at which nothing can be run; SceneError for a description that is wrong.
  const BackendInfo& require(const std::string& name);

  /// The rows of these names in the order of the table, and behind them those that are none of it. Throws
  /// like require().
  std::vector<const BackendInfo*> require_all(const std::vector<std::string>& names);

  /// `rows`, and before each that has threads it on those of `counts` that are less than execution.threads,
  /// ascending. Throws UsageError where there are several and one of the rows takes processes.
  std::vector<const BackendInfo*> with_fewer_threads(const std::vector<const BackendInfo*>& rows,
                                                     std::vector<int> counts,
                                                     const ExecutionOptions& execution);

  /// `rows`, and after each those of `names` that are its variants (require). Where one has too many threads
  /// for this machine, make_backend says so.
  std::vector<const BackendInfo*> with_variants(const std::vector<const BackendInfo*>& rows,
                                                std::span<const std::string_view> names);

  /// All that are described in --backend-folder and the user's own folder. Throws like require().
  std::vector<const BackendInfo*> described() { return described_in(folders_); }

  /// Those that come with mssim as programs of their own. Throws like require().
  std::vector<const BackendInfo*> shipped();

  /// Those that have been asked for and are no rows of the table.
  std::vector<const BackendInfo*> own() const;

 private:
  struct Row {
    explicit Row(BackendProgram its_program);
    Row(const BackendInfo& of, std::string_view how);
    BackendProgram program;  ///< of a program that was asked for
    std::string name;        ///< of a variant
    BackendInfo info;
  };

  std::vector<const BackendInfo*> described_in(const std::vector<std::filesystem::path>& folders);
  const BackendInfo& add(BackendProgram program);
  const BackendInfo& add_file(const std::filesystem::path& file);
  /// The row that a name with a colon stands for; null where nothing is called so. Throws UsageError.
  const BackendInfo* variant(const std::string& name);
  const BackendInfo& add_variant(const BackendInfo& info, std::string_view how);
  std::optional<std::filesystem::path> description_of(const std::string& name) const;

  std::vector<const BackendInfo*> known_;
  std::optional<double> limit_s_;
  std::vector<std::filesystem::path> folders_;        ///< of descriptions alone
  std::vector<std::filesystem::path> scene_folders_;  ///< which may hold some
  std::vector<std::unique_ptr<Row>> rows_;
};

/// Adds the programs of those rows that have one.
void add_programs(Provenance& provenance, const std::vector<const BackendInfo*>& rows,
                  const ExecutionOptions& execution);

/// Throws UsageError where --ranks or --launcher is given and none of these runs in processes: it would be
/// ignored.
void require_use_of_ranks(const ExecutionOptions& given, const std::vector<const BackendInfo*>& rows);

/// Throws Unavailable where --device is given, one of these needs a device, and there is none of that name.
void require_device(const ExecutionOptions& given, const std::vector<const BackendInfo*>& rows);

/// Processes of the one among them that runs in most.
int most_ranks_of(const std::vector<const BackendInfo*>& rows, const ExecutionOptions& execution);

}  // namespace mssim
