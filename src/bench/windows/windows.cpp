#include "bench/windows/windows.h"

#include <cmath>
#include <memory>
#include <utility>

#include "backends/backends.h"
#include "backends/layouts/band_grid.h"
#include "platform/machine.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Rows and columns of a window of a large cloth. The reference's domain around it costs more than the window
/// itself.
constexpr std::uint32_t usual_side = 128;
constexpr std::uint32_t least_side = 8;
/// Windows per shorter side of a small cloth.
constexpr std::uint32_t windows_a_side = 8;

bool overlap(const GridWindow& a, const GridWindow& b) {
  return a.row < b.row + b.rows && b.row < a.row + a.rows && a.column < b.column + b.columns &&
         b.column < a.column + a.columns;
}

/// The i-th number, from 0 to 1, of a sequence whose first n numbers are spread evenly for every n: the
/// fractions of multiples of `step`.
double spread(std::size_t i, double step) {
  const double multiple = step * static_cast<double>(i + 1);
  return multiple - std::floor(multiple);
}

// Powers of the root of x^3 = x + 1, whose multiples fill a square evenly.
constexpr double row_step = 0.7548776662466927, column_step = 0.5698402909980532;

constexpr int leg = 20;  ///< steps after which the domain is cut to the rows that are still right
static_assert(std::ranges::find(window_looks, leg) != window_looks.end() && verification_steps % leg == 0);

/// Number, in the whole cloth, of a node of a window.
std::size_t node_of_cloth(const GridWindow& window, std::size_t node, const GridPatch& grid) {
  return (window.row + node / window.columns) * grid.columns + window.column + node % window.columns;
}

/// The nodes on which the states of a window after `steps` steps depend.
GridWindow domain_for(const GridWindow& window, int steps, const Integrator& integrator,
                      const GridPatch& grid) {
  const std::size_t reach = ghost_columns(integrator, static_cast<std::size_t>(steps));
  const ColumnRange rows = with_ghosts({window.row, window.rows}, reach, grid.rows);
  const ColumnRange columns = with_ghosts({window.column, window.columns}, reach, grid.columns);
  return {static_cast<std::uint32_t>(rows.first), static_cast<std::uint32_t>(columns.first),
          static_cast<std::uint32_t>(rows.count), static_cast<std::uint32_t>(columns.count)};
}

/// Appends `count` nodes of a state, from the `first` on.
void append(State& some, const State& all, std::size_t first, std::size_t count) {
  for (std::size_t i = first; i < first + count; ++i) some.add(all.position[i], all.velocity[i]);
}

/// The part of a state of window `from` that belongs to window `to`.
State cut(const State& state, const GridWindow& from, const GridWindow& to) {
  State part;
  for (std::uint32_t row = to.row; row < to.row + to.rows; ++row)
    append(part, state, std::size_t{row - from.row} * from.columns + (to.column - from.column), to.columns);
  return part;
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
  // Continues after contact, because a blow-up may only appear then.
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

}  // namespace

std::vector<GridWindow> choose_windows(const GridPatch& grid, std::size_t parts,
                                       std::optional<std::uint32_t> pinned_row, std::size_t count) {
  const std::uint32_t side =
      std::clamp(std::min(grid.rows, grid.columns) / windows_a_side, least_side, usual_side);
  const std::uint32_t rows = std::min(side, grid.rows), columns = std::min(side, grid.columns);
  const std::uint32_t last_row = grid.rows - rows, last_column = grid.columns - columns;
  std::vector<GridWindow> chosen;
  const auto place = [&](std::uint32_t row, std::uint32_t column) {
    const GridWindow window{std::min(row, last_row), std::min(column, last_column), rows, columns};
    if (chosen.size() >= count ||
        std::ranges::any_of(chosen, [&](const GridWindow& other) { return overlap(window, other); }))
      return false;
    chosen.push_back(window);
    return true;
  };
  const auto row_at = [&](std::size_t i) {
    return static_cast<std::uint32_t>(spread(i, row_step) * (last_row + 1.0));
  };
  const auto around = [](std::size_t middle, std::uint32_t length) {
    return static_cast<std::uint32_t>(middle - std::min<std::size_t>(middle, length / 2));
  };
  place(0, 0);
  place(last_row, last_column);
  constexpr std::size_t tries = 16;
  for (std::size_t part = 1; part < parts; ++part) {
    const std::size_t seam = part_of({0, grid.columns}, part, parts).first;
    for (std::size_t i = 0; i < tries && !place(row_at(part + i), around(seam, columns)); ++i) continue;
  }
  if (pinned_row) place(around(*pinned_row, rows), around(grid.columns / 2, columns));
  place(0, last_column);
  place(last_row, 0);
  for (std::size_t i = 0; i < tries * count && chosen.size() < count; ++i)
    place(row_at(i), static_cast<std::uint32_t>(spread(i, column_step) * (last_column + 1.0)));
  return chosen;
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
  WindowReferences all{cloth, integrator, dt_s};
  all.windows.resize(cloth.windows.size());
  for_each_at_once(all.windows.size(), at_once, [&](std::size_t i) {
    all.windows[i] = run_window_reference(cloth, cloth.windows[i], integrator, dt_s);
  });
  std::size_t looks = window_looks.size();
  for (const WindowReference& window : all.windows) {
    if (window.failure) all.failure = window.failure;
    looks = std::min(looks, window.states.size());
  }
  if (looks > 0) all.steps = window_looks[looks - 1];
  if (!all.failure && looks == 0) all.failure = touches_at_once(window_looks.front());
  return all;
}

std::optional<BlowUp> find_blow_up(Backend& backend, const WindowedCloth& cloth, int steps) {
  std::optional<BlowUp> blow_up = find_blow_up(backend, State{}, steps);
  if (blow_up) {
    const std::size_t of_window = cloth.windows.front().nodes();
    blow_up->node =
        node_of_cloth(cloth.windows[blow_up->node / of_window], blow_up->node % of_window, cloth.grid);
  }
  return blow_up;
}

Verification verify_windows(Backend& backend, const WindowReferences& reference) {
  if (reference.failure) return {.failure = reference.failure};
  backend.set_state(State{});
  backend.step(reference.steps);
  return compare_windows(backend, backend.state(), reference, reference.steps);
}

Verification compare_windows(Backend& backend, const State& state, const WindowReferences& reference,
                             int steps) {
  Verification result;
  const std::string after = " after " + pluralize(steps, "step");
  double energy_off = 0, in_motion = 0, worst = 0;  // worst: in tolerances
  std::size_t first = 0;                            // of the window's nodes
  for (const WindowReference& one : reference.windows) {
    State part;
    append(part, state, first, one.window.nodes());
    first += one.window.nodes();
    if (first_bad_node(part)) {
      const auto blow_up = find_blow_up(backend, reference.cloth, steps);
      result.failure = blow_up ? describe(*blow_up, reference.dt_s) : std::string(finite_in_the_next);
      return result;
    }
    const State& right = one.after(steps);
    const Energy expected = energy_of(one.system, right);
    energy_off += energy_of(one.system, part).total() - expected.total();
    in_motion += energy_in_motion(one.system, right, expected);
    const double error = position_deviation(one.system, right, part);
    const double tolerance = position_tolerance(one.system, reference.integrator, steps);
    result.position_error = std::max(result.position_error.value_or(0), error);
    if (error <= tolerance || error / tolerance <= worst) continue;
    worst = error / tolerance;
    result.failure = fmt::format(
        "position error {:.6g} of a rest length exceeds {:.6g}{} in the window that starts at row {} and "
        "column {}",
        error, tolerance, after, one.window.row, one.window.column);
  }
  const double drift = energy_off / in_motion;
  result.energy_drift = drift;
  if (!result.failure && !(std::abs(drift) <= energy_tolerance))
    result.failure =
        fmt::format("energy in the windows is off by {:.6g} of the energy in motion, more than {:.6g},{}",
                    drift, energy_tolerance, after);
  return result;
}

std::string share_seen(const WindowedCloth& cloth) {
  return fmt::format("verified in {}, {:.2g} % of the nodes", pluralize(cloth.windows.size(), "window"),
                     100 * static_cast<double>(cloth.windows.size() * cloth.windows.front().nodes()) /
                         static_cast<double>(cloth.nodes()));
}

}  // namespace mssim
