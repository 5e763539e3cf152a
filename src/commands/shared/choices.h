#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "backends/interface/backend.h"
#include "commands/arguments/arguments.h"
#include "integrators/integrator.h"
#include "output/tables/table.h"

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

/// Declares an argument that takes scenes: names or files. `target` must outlive the parsing.
Argument add_scenes(Arguments& arguments, const std::string& name, std::vector<std::string>& target,
                    const std::string& description);

/// Declares --format of a listing. `target` must outlive the parsing.
void declare_listing_format(Arguments& arguments, ListingFormat& target);

/// Declares --threads, --ranks, --launcher, --device, --memory and --roots. `options` must outlive the
/// parsing.
void declare_execution(Arguments& arguments, ExecutionOptions& options);

/// The word for it that --memory takes.
std::string name_of(DeviceMemory memory);

/// Throws UsageError for more threads than eight for each processor that this process may use: each step
/// would take as long as the system needs to let all of them run.
void require_few_threads(int threads);

/// `threads` as given or, for 0, one for every processor that this process may use, as far as a container's
/// quota lets it; OpenMP then gives as many, whatever OMP_DYNAMIC says. Throws UsageError where
/// OMP_THREAD_LIMIT is lower, and as require_few_threads, but where a launcher starts them elsewhere.
ExecutionOptions complete(ExecutionOptions options);

}  // namespace mssim
