#include <algorithm>
#include <bit>
#include <map>
#include <set>
#include <tuple>
#include <variant>

#include "backends/implicit/constraints/step_constraints.h"
#include "backends/implicit/nodes/plain_nodes.h"
#include "backends/implicit/nodes/solvers.h"
#include "backends/vectors/step_kernels.h"

namespace mssim {
namespace {

#define MSSIM_INLINE inline
#include "backends/implicit/constraints/carried_sum-inl.h"
#undef MSSIM_INLINE

ClothColour colour_of(const GridPatch& grid, const Spring& spring) {
  const auto [first, second] = std::minmax(spring.first, spring.second);
  const std::uint32_t row = first / grid.columns, column = first % grid.columns;
  const bool odd_row = row % 2 != 0;
  if (second / grid.columns == row) {  // to the right
    if (spring.kind == bending) return column % 4 < 2 ? bending_from_columns_01 : bending_from_columns_23;
    return column % 2 == 0 ? structural_from_even_columns : structural_from_odd_columns;
  }
  if (spring.kind == bending) return row % 4 < 2 ? bending_below_rows_01 : bending_below_rows_23;
  if (spring.kind == structural) return odd_row ? structural_below_odd_rows : structural_below_even_rows;
  if (second % grid.columns > column) return odd_row ? falling_below_odd_rows : falling_below_even_rows;
  return odd_row ? rising_below_odd_rows : rising_below_even_rows;
}

template <class Real>
class SerialConstraints final : public Backend {
 public:
  SerialConstraints(const System& system, double dt_s)
      : nodes_(system), rest_(system.nodes()), velocity_rest_(system.nodes()), steps_(system, dt_s) {
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      mobility_.push_back(nodes_.pinned[i] ? Real{} : static_cast<Real>(1 / system.node_mass[i]));
    springs_.reserve(system.springs.size());
    for (const Spring& spring : spring_order(system).items)
      springs_.push_back(
          {spring.first, spring.second,
           compliant_spring<Real>(system.materials[spring.kind], spring.rest_length, steps_.small_s,
                                  static_cast<double>(mobility_[spring.first]) +
                                      static_cast<double>(mobility_[spring.second]))});
  }

  void set_state(const State& state) override {
    nodes_.set_state(state);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      rest_[i] = vec3_cast<Real>(state.position[i] - vec3_cast<double>(nodes_.x[i]));
      velocity_rest_[i] = vec3_cast<Real>(state.velocity[i] - vec3_cast<double>(nodes_.v[i]));
    }
  }
  State state() const override {
    State state = nodes_.state();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      state.position[i] += vec3_cast<double>(rest_[i]);
      state.velocity[i] += vec3_cast<double>(velocity_rest_[i]);
    }
    return state;
  }
  int threads() const override { return 1; }

  void step(int count) override {
    for (int step = 0; step < count; ++step) {
      for (std::size_t substep = 0; substep < steps_.substeps; ++substep) {
        fall();
        for (const CompliantSpring& spring : springs_) project(spring);
        for (std::size_t i = 0; i < nodes_.size(); ++i)
          carry_move(nodes_.x[i], rest_[i], steps_.h_s, nodes_.v[i]);
      }
      touch_floor();
    }
  }

 private:
  struct CompliantSpring {
    std::uint32_t first, second;
    LinearSpring<Real> law;
  };

  void fall() {
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (!nodes_.pinned[i]) carry_fall(nodes_.v[i], velocity_rest_[i], steps_.lost, steps_.fall);
  }

  void touch_floor() {
    nodes_.touch_floor();
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (!(nodes_.x[i].y > nodes_.floor_height)) rest_[i].y = 0;
  }

  void project(const CompliantSpring& spring) {
    Vec3<Real>&v1 = nodes_.v[spring.first], &v2 = nodes_.v[spring.second];
    const Vec3<Real> u = v2 - v1;
    const Vec3<Real> d = nodes_.x[spring.second] - nodes_.x[spring.first] + steps_.h_s * u;
    const Vec3<Real> impulse = spring_pull(dot(d, d), dot(u, d), spring.law) * d;
    v1 += mobility_[spring.first] * impulse;
    v2 -= mobility_[spring.second] * impulse;
  }

  PlainNodes<Real> nodes_;
  std::vector<Vec3<Real>> rest_;           // [nodes] m, rounding errors of their x
  std::vector<Vec3<Real>> velocity_rest_;  // [nodes] m/s, those of their v
  std::vector<Real> mobility_;             // [nodes] 1/kg, 0 if pinned
  std::vector<CompliantSpring> springs_;   // in the order of the method
  const SmallSteps<Real> steps_;
};

/// A cloth of at most cached_bytes, which the nearest caches hold, needs only one substep per pass; a larger
/// one uses most_depth. On Zen 4, a substep of 350,000 nodes took 2.2 times as long as a semi-implicit Euler
/// step with one substep per pass, 1.9 times with two, and 1.7 times with five or ten; of 40,000 nodes, 2.4
/// times with any number. More substeps leave more work between the threads, which only some of them do.
constexpr std::size_t cached_bytes = std::size_t{4} << 20, most_depth = 4;

/// The rounding errors of a vector in float.
Vec3d rest_of(const Vec3d& x) { return x - vec3_cast<double>(vec3_cast<float>(x)); }

/// Fewest blocks per thread for passes of `depth` substeps.
constexpr std::size_t least_blocks(std::size_t depth) { return 4 * depth; }

/// Ends of parts: where no spring crosses and the part has enough nodes.
std::vector<std::size_t> part_ends(const System& system, const std::vector<std::uint32_t>& place) {
  constexpr std::size_t fewest_nodes = 256;
  std::vector<std::size_t> ends;
  std::size_t begin = 0;
  for (const std::size_t end : component_ends(system.springs, place)) {
    if (end - begin < fewest_nodes && end < place.size()) continue;
    ends.push_back(end);
    begin = end;
  }
  return ends;
}

/// Cost of a barrier in vectors of springs, which take 40 ns each on Zen 4: an estimate for an idle machine.
/// On a busy one, TeamGain lets one thread work alone.
constexpr double barrier_cost = 6;

struct PartCost {
  std::size_t part;
  double vectors;
  double barriers;
};

/// Assigns the parts to threads, largest first, each to the least loaded thread. The smallest parts are
/// shared, as many as minimises the step time: for example one body beyond an even number, or a single body.
void distribute(SpringBatches& bodies, std::vector<PartCost> costs, std::size_t threads) {
  std::ranges::stable_sort(costs, std::ranges::greater(), &PartCost::vectors);
  double best = HUGE_VAL;
  for (std::size_t own = costs.size() + 1; own-- > 0;) {
    std::vector<double> load(threads, 0);
    std::vector<std::vector<std::size_t>> parts(threads);
    for (std::size_t i = 0; i < own; ++i) {
      const auto least = std::ranges::min_element(load);
      *least += costs[i].vectors;
      parts[static_cast<std::size_t>(least - load.begin())].push_back(costs[i].part);
    }
    double time = *std::ranges::max_element(load);
    std::vector<std::size_t> shared;
    for (std::size_t i = own; i < costs.size(); ++i) {
      time += costs[i].vectors / static_cast<double>(threads) + barrier_cost * costs[i].barriers;
      shared.push_back(costs[i].part);
    }
    if (time >= best) continue;
    best = time;
    bodies.own_parts = std::move(parts);
    bodies.shared_parts = std::move(shared);
  }
}

}  // namespace

SpringColouring spring_order(const System& system) {
  const auto* grid = std::get_if<GridPatch>(&system.topology);
  if (grid == nullptr) return colour_springs(system.springs, system.nodes());
  return {cloth_colours, [&](const auto& visit) {
            for (const Spring& spring : system.springs) visit(colour_of(*grid, spring), spring);
          }};
}

QuarteredRows::QuarteredRows(const System& system, double dt_s, std::size_t lanes, std::size_t thread_count)
    : SmallSteps<float>(system, dt_s),
      layout(std::get<GridPatch>(system.topology), lanes),
      nodes(layout.rows * layout.row_floats() +
            lanes),  // a vector of the last nodes may begin one node further
      rest(layout.rows * layout.row_floats()) {
  const auto& grid = std::get<GridPatch>(system.topology);
  const double mass = require_uniform_mass(system);
  for (const GridSpringKind kind : {structural, shear, bending}) {
    const auto by_mass =
        constants_from<double>([mass](double number) { return number / mass; }, system.materials[kind]);
    const auto rest_length = static_cast<double>(grid.rest_length(kind));
    of_free.push_back(compliant_spring<float>(by_mass, rest_length, small_s, 2));
    of_pinned.push_back(compliant_spring<float>(by_mass, rest_length, small_s, 1));
  }

  std::set<std::size_t> pinned_rows;
  for (const std::uint32_t node : system.pins) pinned_rows.insert(node / layout.columns);
  const std::size_t row_flags = QuarterLayout::streams * layout.pitch;
  free = AlignedArray((1 + pinned_rows.size()) * row_flags + lanes);
  const auto flag = [&](std::size_t row, std::size_t column) -> float& {
    return free.data()[row * row_flags + column % QuarterLayout::streams * layout.pitch +
                       column / QuarterLayout::streams];
  };
  for (std::size_t row = 0; row <= pinned_rows.size(); ++row)
    for (std::size_t column = 0; column < layout.columns; ++column) flag(row, column) = 1;
  free_of_row.assign(layout.rows, free.data());
  for (std::size_t i = 0; const std::size_t row : pinned_rows)
    free_of_row[row] = free.data() + ++i * row_flags;
  for (const std::uint32_t node : system.pins) {
    const auto row = std::distance(pinned_rows.begin(), pinned_rows.find(node / layout.columns));
    flag(1 + static_cast<std::size_t>(row), node % layout.columns) = 0;
  }

  threads = threads_for(blocks() / least_blocks(1), thread_count);
  if (nodes.bytes() > cached_bytes) depth = most_depth;
  while (threads > 1 && depth > 1 && blocks() / threads < least_blocks(depth)) --depth;
}

void QuarteredRows::set_state(const State& state) {
  for (std::size_t node = 0; node < state.position.size(); ++node) {
    const std::size_t row = node / layout.columns, column = node % layout.columns;
    const std::size_t x = layout.offset(row, column), v = x + 3 * layout.pitch;
    write_vector(nodes.data() + x, layout.pitch, state.position[node]);
    write_vector(nodes.data() + v, layout.pitch, state.velocity[node]);
    write_vector(rest.data() + x, layout.pitch, rest_of(state.position[node]));
    write_vector(rest.data() + v, layout.pitch, rest_of(state.velocity[node]));
  }
}

State QuarteredRows::state() const {
  State state;
  state.position.reserve(layout.rows * layout.columns);
  state.velocity.reserve(layout.rows * layout.columns);
  const auto vector_at = [&](std::size_t place) {
    return read_vector(nodes.data() + place, layout.pitch) + read_vector(rest.data() + place, layout.pitch);
  };
  for (std::size_t row = 0; row < layout.rows; ++row)
    for (std::size_t column = 0; column < layout.columns; ++column) {
      const std::size_t x = layout.offset(row, column);
      state.add(vector_at(x), vector_at(x + 3 * layout.pitch));
    }
  return state;
}

SpringBatches::SpringBatches(const System& system, double dt_s, std::size_t lane_count,
                             std::size_t thread_count)
    : SmallSteps<float>(system, dt_s), lanes(lane_count) {
  const std::vector<std::uint32_t> node_at = reverse_cuthill_mckee(system.nodes(), system.springs);
  const std::vector<std::uint32_t> place = places_in(node_at);
  const std::vector<std::size_t> ends = part_ends(system, place);

  slot.resize(system.nodes());
  std::vector<std::uint32_t> part_of(system.nodes());  // [scene nodes]
  std::size_t slots = 0, begin = 0;
  for (const std::size_t end : ends) {
    const std::size_t first = slots;
    for (; begin < end; ++begin) {
      part_of[node_at[begin]] = static_cast<std::uint32_t>(parts.size());
      slot[node_at[begin]] = static_cast<std::uint32_t>(slots++);
    }
    slots = round_up(slots, lanes);
    parts.push_back({first / lanes, slots / lanes, 0, 0});
  }
  threads = threads_for(slots / lanes, thread_count);
  nodes = AlignedArray(slots * record_floats);
  rest = AlignedArray(slots * rest_components);
  free = AlignedArray(slots);
  std::vector<double> mobility(system.nodes());
  for (std::size_t node = 0; node < system.nodes(); ++node) mobility[node] = 1 / system.node_mass[node];
  for (const std::uint32_t node : system.pins) mobility[node] = 0;
  for (std::size_t node = 0; node < system.nodes(); ++node) free.data()[slot[node]] = mobility[node] > 0;

  // By part, colour and constants.
  const SpringColouring order = spring_order(system);
  using Constants = std::tuple<std::uint32_t, double, double>;
  std::vector<std::map<std::size_t, std::map<Constants, std::vector<Spring>>>> sorted(parts.size());
  for (std::size_t colour = 0; colour < order.groups(); ++colour)
    for (const Spring& spring : order.of(colour))
      sorted[part_of[spring.first]][colour][{spring.kind, mobility[spring.first], mobility[spring.second]}]
          .push_back(spring);
  std::size_t vectors = 0;
  for (const auto& of_part : sorted)
    for (const auto& [colour, of_colour] : of_part)
      for (const auto& [constants, list] : of_colour) vectors += (list.size() + lanes - 1) / lanes;
  springs = AlignedArray(vectors * 3 * lanes);
  float* entry = springs.data();
  const auto written = [&] { return static_cast<std::size_t>(entry - springs.data()) / (3 * lanes); };
  std::vector<PartCost> costs;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    parts[part].first_colour = colours.size();
    const std::size_t first_vector = written();
    for (auto& [colour, of_colour] : sorted[part]) {
      const std::size_t first_batch = batches.size();
      for (auto& [constants, list] : of_colour) {
        std::ranges::sort(list, {}, [&](const Spring& spring) { return slot[spring.first]; });
        const double first_mobility = std::get<1>(constants), second_mobility = std::get<2>(constants);
        const auto compliance = [&](const Spring& spring) {
          return compliant_spring<float>(system.materials[spring.kind], spring.rest_length, small_s,
                                         first_mobility + second_mobility);
        };
        Batch batch{written(), 0, compliance(list.front()).constants, static_cast<float>(first_mobility),
                    static_cast<float>(second_mobility)};
        batch.end = batch.begin + (list.size() + lanes - 1) / lanes;
        list.resize((batch.end - batch.begin) * lanes, list.back());
        for (std::size_t i = 0; i < list.size(); i += lanes) {
          for (std::size_t lane = 0; lane < lanes; ++lane)
            *entry++ = std::bit_cast<float>(slot[list[i + lane].first]);
          for (std::size_t lane = 0; lane < lanes; ++lane)
            *entry++ = std::bit_cast<float>(slot[list[i + lane].second]);
          for (std::size_t lane = 0; lane < lanes; ++lane)
            *entry++ = compliance(list[i + lane]).stiffness_rest;
        }
        batches.push_back(batch);
      }
      colours.push_back({first_batch, batches.size()});
    }
    parts[part].end_colour = colours.size();
    costs.push_back(
        {part, static_cast<double>(written() - first_vector), static_cast<double>(sorted[part].size() + 1)});
    sorted[part] = {};
  }
  distribute(*this, std::move(costs), threads);
}

void SpringBatches::set_state(const State& state) {
  write_records(state, slot, nodes.data());
  for (std::size_t node = 0; node < slot.size(); ++node) {
    float* const of_x = rest.data() + slot_offset(slot[node], rest_components, lanes);
    write_vector(of_x, lanes, rest_of(state.position[node]));
    write_vector(of_x + 3 * lanes, lanes, rest_of(state.velocity[node]));
  }
}

State SpringBatches::state() const {
  State state = read_records(nodes.data(), slot);
  for (std::size_t node = 0; node < slot.size(); ++node) {
    const float* const of_x = rest.data() + slot_offset(slot[node], rest_components, lanes);
    state.position[node] += read_vector(of_x, lanes);
    state.velocity[node] += read_vector(of_x + 3 * lanes, lanes);
  }
  return state;
}

std::unique_ptr<Backend> make_serial_constraints(const System& system, const Integrator& /*integrator*/,
                                                 double dt_s, const ExecutionOptions& /*options*/) {
  return std::make_unique<SerialConstraints<float>>(system, dt_s);
}

std::unique_ptr<Backend> make_constraints_reference(const System& system, const Integrator& /*integrator*/,
                                                    double dt_s, const std::function<bool()>& /*stop*/) {
  return std::make_unique<SerialConstraints<double>>(system, dt_s);
}

std::unique_ptr<Backend> make_openmp_constraints(const System& system, const Integrator& /*integrator*/,
                                                 double dt_s, const ExecutionOptions& options) {
  return make_vector_backend<QuarteredRows, SpringBatches>(system, dt_s, options);
}

}  // namespace mssim
