#include "backends/accumulation/accumulation_methods.h"

#include <array>

#include "backends/accumulation/gather_vectors.h"
#include "backends/accumulation/methods.h"
#include "backends/backends.h"
#include "backends/spring_list/threads_mutex.h"

namespace mssim {
namespace {

constexpr MemoryUse with_private_arrays{.node = 17, .pair_node = 24, .thread_node = 12};
constexpr MemoryUse with_coloured_copy{.node = 25, .pair_node = 24, .spring = 20};
constexpr MemoryUse with_both_ends{.node = 33, .pair_node = 24, .spring = 32};
constexpr MemoryUse in_padded_rows{.pair_node = 24, .storage = Storage::separate};

/// A method that steps the plain list.
constexpr AccumulationMethod of_list(std::string_view name, std::string_view description, auto make,
                                     const MemoryUse& memory, std::string_view extra_memory,
                                     std::string_view springs_computed, Repeatable repeatable,
                                     ThreadStack stack = ThreadStack::openmp) {
  return {{name, "", description, false, stack, make, memory, memory},
          extra_memory,
          springs_computed,
          repeatable};
}

const std::array<AccumulationMethod, 9>& table() {
  static const std::array<AccumulationMethod, 9> rows{{
      {baseline_backend(), "none", "once", Repeatable::always},
      of_list("mutex-per-group",
              "one lock for all nodes, taken to add the forces of 512 springs (threads-mutex)",
              make_threads_mutex, spring_list_memory, "6 KiB a thread", "once", Repeatable::never,
              ThreadStack::usual),
      of_list("lock-per-node", "a spinning lock of one byte a node, taken for each end of a spring",
              make_lock_per_node, spring_list_memory, "1 byte a node", "once", Repeatable::never),
      of_list("atomic", "atomic additions, three for each end of a spring", make_atomic, spring_list_memory,
              "none", "once", Repeatable::never),
      of_list("thread-private", "an array of forces for each thread, summed afterwards", make_thread_private,
              with_private_arrays, "12 bytes a node and thread", "once", Repeatable::at_same_threads),
      of_list("colouring", "springs of one colour share no node; the threads meet after each colour",
              make_colouring, with_coloured_copy, "16 bytes a spring", "once", Repeatable::always),
      of_list("gather", "each node sums its own springs", make_gather, with_both_ends,
              "32 bytes a spring, 8 a node", "twice", Repeatable::always),
      {{"gather-vectors",
        "",
        "vectors of a cloth's nodes sum their own springs, from rows of a layout of its own",
        false,
        ThreadStack::openmp,
        make_gather_vectors,
        in_padded_rows,
        {}},
       "a layout of its own",
       "twice",
       Repeatable::always},
      {best_host_backend(), "a layout of its own", "once, but twice on bodies that differ",
       Repeatable::always},
  }};
  return rows;
}

}  // namespace

std::string_view name_of(Repeatable repeatable) {
  switch (repeatable) {
    case Repeatable::never:
      return "no";
    case Repeatable::at_same_threads:
      return "at the same number of threads";
    case Repeatable::always:
      return "yes";
  }
  return "";
}

std::span<const AccumulationMethod> accumulation_methods() { return table(); }

}  // namespace mssim
