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

/// The integrator of that name. Throws UsageError with the nearest name or a list.
const Integrator& require_integrator(const std::string& name);

/// The integrators in `asked` or, if it is empty, `by_default`, in the order of the table; a single "all"
/// means every one. Throws UsageError like require_integrator.
std::vector<const Integrator*> chosen_integrators(const std::vector<std::string>& asked,
                                                  std::span<const std::string_view> by_default);

/// Largest number of host threads. More are a typing error, and would fail later with a less clear message.
inline constexpr int most_threads = 4096;

/// Largest number of processes.
inline constexpr int most_ranks = 65536;

/// Highway's name of an instruction set of vector code; `name` is that or the usual one (AVX-512 for AVX3).
/// Throws UsageError with a list if this CPU, or mssim's vector code, has none of that name.
std::string_view require_instruction_set(const std::string& name);

/// The values of --memory and --roots.
std::string name_of(DeviceMemory memory);
std::string name_of(Roots roots);

/// Throws UsageError if thread_excess() or OMP_THREAD_LIMIT does not allow so many. `asked`: what says the
/// number, if it is not --threads.
void require_few_threads(int threads, std::string_view asked = {});

/// Completes the options. An `instruction_set` becomes Highway's name (require_instruction_set). If `threads`
/// is 0, takes one thread per processor that this process may use, within a container's quota, and has OpenMP
/// provide as many, regardless of OMP_DYNAMIC. Throws like require_instruction_set and require_few_threads;
/// if a launcher starts the processes elsewhere, there may be more threads than thread_excess() allows.
ExecutionOptions complete(ExecutionOptions options);

/// Command-line options for programs that are backends.
struct OwnBackendOptions {
  std::vector<std::string> folders;  ///< searched first for descriptions
  std::optional<double> limit_s;     ///< for every answer; none: as described, or 120 s
};

/// What a user asks for: scenes, and the backends and integrators with which each is stepped.
struct AskedCombinations {
  std::vector<std::string> scenes;
  std::vector<std::string> backends;
  OwnBackendOptions own_backends;
  std::vector<std::string> integrators;
  ExecutionOptions execution;
};

/// Whether the backend of that name is a program that comes with mssim.
bool is_shipped(const std::string& name);

/// The name of the row of a backend that was requested by this name or path.
std::string row_name(const std::string& asked);

/// Whether a row is a variant of that backend: "openmp:2" of "openmp".
inline bool is_variant(std::string_view row, std::string_view backend) {
  return row.starts_with(backend) && row.substr(backend.size()).starts_with(':');
}

/// The rows of the TABLE of backends, in its order.
std::vector<const BackendInfo*> table_backends();

/// `rows`, then the backends that step only garments.
std::vector<const BackendInfo*> with_garment_backends(std::vector<const BackendInfo*> rows);

/// The backends that a command may use: rows of a table, and users' programs, which are looked up on request.
/// Rows keep their addresses during the lifetime of this object, even if it is moved.
class BackendChoice {
 public:
  BackendChoice() = default;
  /// `known`: rows of the table. `scenes`: the requested scenes; the folders of those that are files may
  /// contain descriptions.
  BackendChoice(std::vector<const BackendInfo*> known, const OwnBackendOptions& options,
                const std::vector<std::string>& scenes = {});

  /// The row for a name: a row of the table, the file at a path (with a slash), or the program described in
  /// NAME.json. NAME:COUNT is a program in that many ranks, or a row of the table with that many threads.
  /// NAME:each is a row of the table that steps one body after the other, and NAME:SET one whose vector code
  /// is for that instruction set; NAME:each:COUNT and NAME:SET:COUNT are both. NAME:double steps in double
  /// precision, if the row has make_in_double, also as NAME:double:COUNT and NAME:double:SET. Throws
  /// UsageError with the nearest name or a list, for an ambiguous name, and like require_few_threads;
  /// MissingProgram for a path without an executable program; SceneError for a wrong description.
  const BackendInfo& require(const std::string& name);

  /// The rows of these names: first those of the table, in its order, then the others. Throws like require().
  std::vector<const BackendInfo*> require_all(const std::vector<std::string>& names);

  /// `rows`, with additional rows for lesser instruction sets. Each row that has vector code is preceded by
  /// rows for all of `sets`, which are the best first, but the first; the least comes first. Throws
  /// UsageError if there are several sets and one of the rows uses processes.
  std::vector<const BackendInfo*> with_lesser_sets(const std::vector<const BackendInfo*>& rows,
                                                   const std::vector<std::string_view>& sets);

  /// `rows`, with additional rows for smaller numbers of threads. Each row that has threads is preceded by
  /// rows for those of `counts` below execution.threads, ascending. Throws UsageError if there are several
  /// counts and one of the rows uses processes.
  std::vector<const BackendInfo*> with_fewer_threads(const std::vector<const BackendInfo*>& rows,
                                                     std::vector<int> counts,
                                                     const ExecutionOptions& execution);

  /// `rows`, each followed by those of `names` that are its variants (require). If one has too many threads
  /// for this machine, make_backend throws.
  std::vector<const BackendInfo*> with_variants(const std::vector<const BackendInfo*>& rows,
                                                std::span<const std::string_view> names);

  /// All backends described in --backend-folder and the user's own folder. Throws like require(); if `broken`
  /// is given, leaves those out for which it would throw, and adds the sentences to `broken`.
  std::vector<const BackendInfo*> described(std::vector<std::string>* broken = nullptr) {
    return described_in(folders_, broken);
  }

  /// Backends that come with mssim as separate programs. Throws like described().
  std::vector<const BackendInfo*> shipped(std::vector<std::string>* broken = nullptr);

  /// Requested backends that are not rows of the table.
  std::vector<const BackendInfo*> own() const;

 private:
  struct Row {
    explicit Row(BackendProgram its_program);
    Row(const BackendInfo& of, std::string_view how);
    BackendProgram program;  ///< of a requested program
    std::string name;        ///< of a variant
    BackendInfo info;
  };

  std::vector<const BackendInfo*> described_in(const std::vector<std::filesystem::path>& folders,
                                               std::vector<std::string>* broken);
  const BackendInfo& add(BackendProgram program);
  /// The row for a name with a colon; null if there is none. Throws UsageError.
  const BackendInfo* variant(const std::string& name);
  const BackendInfo& add_variant(const BackendInfo& info, std::string_view how);
  std::optional<std::filesystem::path> description_of(const std::string& name) const;

  std::vector<const BackendInfo*> known_;
  std::optional<double> limit_s_;
  std::vector<std::filesystem::path> folders_;        ///< only of descriptions
  std::vector<std::filesystem::path> scene_folders_;  ///< may also contain descriptions
  std::vector<std::unique_ptr<Row>> rows_;
};

/// Adds to the provenance what the rows run with: the settings, and the programs of those that have one.
void add_execution(Provenance& provenance, const std::vector<const BackendInfo*>& rows,
                   const ExecutionOptions& execution);

/// Throws UsageError if --ranks, --launcher, --device or --instruction-set is given but none of these rows
/// uses it, and Unavailable if no device has the name that --device gives.
void require_use_of_options(const ExecutionOptions& given, const std::vector<const BackendInfo*>& rows);

/// Largest number of processes of any of these rows.
int most_ranks_of(const std::vector<const BackendInfo*>& rows, const ExecutionOptions& execution);

}  // namespace mssim
