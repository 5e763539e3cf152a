#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "backends/vectors/step_kernels.h"
#include "ranks/messages.h"
#include "ranks/requests.h"

namespace mssim {

/// Keeps those of a processor's kernels that one with the instruction set of the variable
/// MSSIM_INSTRUCTION_SET would have, by which different processors can be tried on one machine.
template <class Data>
std::vector<StepKernel<Data>> kernels_of_rank(std::vector<StepKernel<Data>> kernels) {
  const std::string name = variable("MSSIM_INSTRUCTION_SET");
  const auto first = std::ranges::find_if(
      kernels, [&](const auto& kernel) { return kernel.instruction_set == std::string_view(name); });
  if (first != kernels.end()) kernels.erase(kernels.begin(), first);
  return kernels;
}

/// A kernel with which all ranks give the same bits: the best of each where that is the same one, and else
/// the best that finds roots exactly. `kernels`: those of this processor. Throws Unsupported, on all ranks,
/// where their bits would differ.
template <class Data>
StepKernel<Data> common_kernel(const Session& session, const std::vector<StepKernel<Data>>& kernels,
                               Roots roots) {
  const std::vector<StepKernel<Data>> own = kernels_of_rank(kernels);
  const StepKernel<Data> best = best_kernel(own, roots);
  const std::vector<std::string> sets = session.gather(best.instruction_set);
  if (std::ranges::count(sets, sets.front()) == std::ssize(sets)) return best;
  const StepKernel<Data> exact = best_kernel(own, Roots::exact);
  const std::vector<std::string> roundings = session.gather(exact.fuses ? "once" : "twice");
  const auto other = std::ranges::find_if(
      roundings, [&](const std::string& rounding) { return rounding != roundings.front(); });
  if (other == roundings.end()) return exact;
  const auto rank = static_cast<std::size_t>(other - roundings.begin());
  throw Unsupported(session.name_of(0) + " has " + sets.front() + " and " +
                    session.name_of(static_cast<int>(rank)) + " " + sets[rank] +
                    ", which round differently: take machines of one kind");
}

}  // namespace mssim
