// Threads that take chunks of work by ticket, phase after phase. Compiled once per instruction set, so the
// guard toggles.
#if defined(MSSIM_CHUNK_PHASES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MSSIM_CHUNK_PHASES_INL_H_
#undef MSSIM_CHUNK_PHASES_INL_H_
#else
#define MSSIM_CHUNK_PHASES_INL_H_
#endif

#include <omp.h>

#include <cstdint>
#include <utility>

#include "backends/layouts/update_nodes-inl.h"
#include "backends/threads/chunk_tickets.h"

HWY_BEFORE_NAMESPACE();
namespace mssim::HWY_NAMESPACE {

/// The pairs in a stage, counted from the first one of a call: `state` and `next` change places every step.
/// `base`: in the first one.
template <std::size_t method>
HWY_INLINE Pairs pairs_in(const Pairs& base, std::uint32_t stage) {
  Pairs pairs = base;
  if (stage / integrators[method].stage_count % 2 != 0)
    std::swap(pairs[index(Pair::state)], pairs[index(Pair::next)]);
  return pairs;
}

/// Calls act(thread, ticket) for every chunk of so many phases, one phase after the other. Whoever has
/// finished the n-th one calls between(n), while all others wait: `spins` times before they offer their
/// cores, which should last about as long as a chunk takes.
template <class Act, class Between>
HWY_INLINE void work_in_phases(std::size_t chunks, std::size_t threads, std::uint32_t phases, int spins,
                               const Act& act, const Between& between) {
  ChunkTickets tickets(static_cast<std::uint32_t>(chunks), static_cast<std::uint32_t>(threads));
  std::uint32_t opened = 1;  // only whoever has finished a phase touches it
  tickets.open();
#pragma omp parallel num_threads(static_cast <int>(threads))
  {
    const auto thread = static_cast<std::uint32_t>(omp_get_thread_num());
    tickets.work_until_closed(
        thread, spins, [&](const ChunkTickets::Ticket& ticket) HWY_ATTR { act(thread, ticket); },
        [&] {
          between(opened);
          if (opened == phases) return tickets.close();
          ++opened;
          tickets.open();
        });
  }
}

/// Calls take(count) until it has taken `count` steps in all: a ticket numbers a call's phases, of which a
/// stage may have two.
template <std::size_t method, class Take>
HWY_INLINE void take_in_calls(int count, const Take& take) {
  constexpr int most = 1 << 20;
  static_assert(2 * most * integrators[method].stage_count <= ChunkTickets::most_phases);
  for (; count > most; count -= most) take(most);
  take(count);
}

}  // namespace mssim::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
