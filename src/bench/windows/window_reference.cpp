#include "bench/windows/window_reference.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <memory>
#include <utility>

#include "backends/layouts/band_grid.h"
#include "backends/reference.h"
#include "bench/verification/blow_up.h"
#include "bench/verification/verification.h"
#include "platform/machine.h"

namespace mssim {
namespace {

constexpr int leg = 20;  ///< steps after which the domain is cut to what is still right
static_assert(std::ranges::find(window_looks, leg) != window_looks.end() && verification_steps % leg == 0);

GridWindow domain_for(const GridWindow& window, int steps, const Integrator& integrator,
                      const GridPatch& grid) {
  return domain_of(window, ghost_columns(integrator, static_cast<std::size_t>(steps)), grid);
}

/// What a state of a window says of another one in it.
State cut(const State& state, const GridWindow& from, const GridWindow& to) {
  State part;
  for (std::uint32_t row = to.row; row < to.row + to.rows; ++row) {
    const std::size_t first = std::size_t{row - from.row} * from.columns + (to.column - from.column);
    const auto copy = [&](const std::vector<Vec3d>& all, std::vector<Vec3d>& some) {
      const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
      some.insert(some.end(), begin, begin + to.columns);
    };
    copy(state.position, part.position);
    copy(state.velocity, part.velocity);
  }
  return part;
}

bool is_in_the_air(const State& state, const Floor& floor) {
  return std::ranges::all_of(state.position, [&](const Vec3d& x) { return x.y > floor.height; });
}

}  // namespace

GridWindow domain_of(const GridWindow& window, std::size_t reach, const GridPatch& grid) {
  const ColumnRange rows = with_ghosts({window.row, window.rows}, reach, grid.rows);
  const ColumnRange columns = with_ghosts({window.column, window.columns}, reach, grid.columns);
  return {static_cast<std::uint32_t>(rows.first), static_cast<std::uint32_t>(columns.first),
          static_cast<std::uint32_t>(rows.count), static_cast<std::uint32_t>(columns.count)};
}

WindowReference run_window_reference(const WindowedCloth& cloth, const GridWindow& window,
                                     const Integrator& integrator, double dt_s) {
  WindowReference reference{window, cloth.build(window), {}, {}};
  GridWindow domain = domain_for(window, verification_steps, integrator, cloth.grid);
  System system = cloth.build(domain);
  std::unique_ptr<Backend> backend = make_reference(system, integrator, dt_s);
  State before = system.start;
  bool in_the_air = true;
  const int comparable = comparable_steps(reference.system, integrator, dt_s, verification_steps);
  // To the end even after contact: a blow-up may only show then.
  for (int steps = 0; const int look : window_looks) {
    const int count = look - std::exchange(steps, look);
    backend->step(count);
    State state = backend->state();
    const GridWindow right = domain_for(window, verification_steps - steps, integrator, cloth.grid);
    const State right_state = cut(state, domain, right);
    if (const auto node = first_bad_node(right_state)) {
      BlowUp blow_up = find_blow_up(*backend, before, count).value_or(BlowUp{count, 0});
      blow_up.node = node_of_cloth(right, *node, cloth.grid);
      reference.failure = "the double-precision reference " + describe(blow_up, dt_s, steps - count);
      return reference;
    }
    in_the_air = in_the_air && is_in_the_air(right_state, system.floor);
    if (in_the_air && steps <= comparable) reference.states.push_back(cut(right_state, right, window));
    before = std::move(state);
    if (steps % leg != 0 || steps == verification_steps) continue;
    backend.reset();
    domain = right;
    system = cloth.build(domain);
    system.start = right_state;
    backend = make_reference(system, integrator, dt_s);
    before = right_state;
  }
  return reference;
}

double window_reference_bytes(const Integrator& integrator, const GridWindow& window, const GridPatch& grid) {
  constexpr double state_node = 2 * sizeof(Vec3d), states = 5;  // start, read, before, right, in the backend
  const GridWindow domain = domain_for(window, verification_steps, integrator, grid);
  const std::uint64_t springs = count_springs(domain.rows, domain.columns);
  return reference_memory(integrator, true).bytes(integrator, domain.nodes(), springs, 1) +
         static_cast<double>(domain.nodes()) * (states * state_node + sizeof(double)) +
         static_cast<double>(springs) * sizeof(Spring);
}

WindowReferences run_window_references(const WindowedCloth& cloth, const Integrator& integrator, double dt_s,
                                       std::size_t at_once) {
  WindowReferences all;
  all.windows.resize(cloth.windows.size());
  std::atomic<std::size_t> next = 0;
  {
    const OnAllProcessCpus unbound;  // threads that OpenMP does not start would share the CPU of this one
    std::vector<std::future<void>> threads;
    for (std::size_t thread = 0; thread < std::min(at_once, all.windows.size()); ++thread)
      threads.push_back(std::async(as_the_system_can, [&] {
        for (std::size_t i = next++; i < all.windows.size(); i = next++)
          all.windows[i] = run_window_reference(cloth, cloth.windows[i], integrator, dt_s);
      }));
    for (std::future<void>& thread : threads) thread.get();
  }
  std::size_t looks = window_looks.size();
  for (const WindowReference& window : all.windows) {
    if (window.failure) all.failure = window.failure;
    looks = std::min(looks, window.states.size());
  }
  if (looks > 0) all.steps = window_looks[looks - 1];
  if (!all.failure && looks == 0) all.failure = touches_at_once(window_looks.front());
  return all;
}

}  // namespace mssim
