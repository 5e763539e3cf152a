#include "backends/implicit/constraints/spring_batches.h"

#include <algorithm>
#include <bit>
#include <map>
#include <numeric>
#include <tuple>

#include "backends/implicit/constraints/spring_order.h"
#include "backends/layouts/cuthill_mckee.h"

namespace mssim {
namespace {

/// Where parts end: where no spring goes on, and the part has some nodes.
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

/// What threads lose at a barrier, in vectors of springs, which take 40 ns each on Zen 4: a guess at an idle
/// machine. On a busy one TeamGain lets a thread work alone.
constexpr double barrier_cost = 6;

struct PartCost {
  std::size_t part;
  double vectors;
  double barriers;
};

/// Gives the parts to threads, largest first, each to the one that has least. The smallest are shared, as
/// many as makes the step shortest: one body beside many of its size, or one alone.
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

SpringBatches::SpringBatches(const System& system, double dt_s, std::size_t lane_count,
                             std::size_t thread_count)
    : lanes(lane_count),
      threads(std::max<std::size_t>(1, thread_count)),
      surroundings(surroundings_of(system)),
      substeps(system.solver.substeps) {
  const double small_s = dt_s / system.solver.substeps;
  h_s = static_cast<float>(small_s);
  fall = static_cast<float>(small_s * system.gravity);
  kept = static_cast<float>(1 / (1 + small_s * system.viscous_damping));

  const std::vector<std::uint32_t> node_at = reverse_cuthill_mckee(system.nodes(), system.springs);
  const std::vector<std::uint32_t> place = places_in(node_at);
  const std::vector<std::size_t> ends = part_ends(system, place);

  slot.resize(system.nodes());
  std::vector<std::uint32_t> part_of(system.nodes());  // by scene node
  std::size_t slots = 0, begin = 0;
  for (const std::size_t end : ends) {
    const std::size_t first = slots;
    for (; begin < end; ++begin) {
      part_of[node_at[begin]] = static_cast<std::uint32_t>(parts.size());
      slot[node_at[begin]] = static_cast<std::uint32_t>(slots++);
    }
    slots = (slots + lanes - 1) / lanes * lanes;
    parts.push_back({first / lanes, slots / lanes, 0, 0});
  }
  nodes = AlignedArray(slots * record_floats);
  rest = AlignedArray(slots * 3);
  free = AlignedArray(slots);
  std::vector<double> mobility(system.nodes());
  for (std::size_t node = 0; node < system.nodes(); ++node) mobility[node] = 1 / system.node_mass[node];
  for (const std::uint32_t node : system.pins) mobility[node] = 0;
  for (std::size_t node = 0; node < system.nodes(); ++node) free.data()[slot[node]] = mobility[node] > 0;

  // By part, colour and constants.
  const SpringColouring order = spring_order(system);
  using Constants = std::tuple<std::uint32_t, double, double>;
  std::vector<std::vector<std::map<Constants, std::vector<Spring>>>> sorted(parts.size());
  for (std::size_t colour = 0; colour < order.colours(); ++colour) {
    std::vector<std::map<Constants, std::vector<Spring>>> of_part(parts.size());
    for (const Spring& spring : order.of_colour(colour))
      of_part[part_of[spring.first]][{spring.kind, mobility[spring.first], mobility[spring.second]}]
          .push_back(spring);
    for (std::size_t part = 0; part < parts.size(); ++part)
      if (!of_part[part].empty()) sorted[part].push_back(std::move(of_part[part]));
  }
  std::vector<float> entries;
  std::vector<PartCost> costs;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    parts[part].first_colour = colours.size();
    const std::size_t first_vector = entries.size() / (3 * lanes);
    for (auto& colour : sorted[part]) {
      const std::size_t first_batch = batches.size();
      for (auto& [constants, list] : colour) {
        std::ranges::sort(list, {}, [&](const Spring& spring) { return slot[spring.first]; });
        const double first_mobility = std::get<1>(constants), second_mobility = std::get<2>(constants);
        const auto compliance = [&](const Spring& spring) {
          return Compliance<float>(system.materials[spring.kind], spring.rest_length, small_s,
                                   first_mobility + second_mobility);
        };
        Batch batch{entries.size() / (3 * lanes),       0,
                    compliance(list.front()).stiffness, compliance(list.front()).damping,
                    static_cast<float>(first_mobility), static_cast<float>(second_mobility)};
        batch.end = batch.begin + (list.size() + lanes - 1) / lanes;
        list.resize((batch.end - batch.begin) * lanes, list.back());
        for (std::size_t i = 0; i < list.size(); i += lanes) {
          for (std::size_t lane = 0; lane < lanes; ++lane)
            entries.push_back(std::bit_cast<float>(slot[list[i + lane].first]));
          for (std::size_t lane = 0; lane < lanes; ++lane)
            entries.push_back(std::bit_cast<float>(slot[list[i + lane].second]));
          for (std::size_t lane = 0; lane < lanes; ++lane)
            entries.push_back(compliance(list[i + lane]).stiffness_rest);
        }
        batches.push_back(batch);
      }
      colours.push_back({first_batch, batches.size()});
    }
    parts[part].end_colour = colours.size();
    const std::size_t vectors = entries.size() / (3 * lanes) - first_vector;
    costs.push_back({part, static_cast<double>(vectors), static_cast<double>(sorted[part].size() + 1)});
  }
  springs = AlignedArray(entries.size());
  std::ranges::copy(entries, springs.data());
  distribute(*this, std::move(costs), threads);
  set_state(system.start);
}

void SpringBatches::set_state(const State& state) {
  write_records(state, slot, nodes.data());
  for (std::size_t node = 0; node < slot.size(); ++node) {
    float* out = rest.data() + rest_offset(slot[node]);
    const Vec3d& x = state.position[node];
    for (const double value : {x.x, x.y, x.z}) {
      *out = static_cast<float>(value - static_cast<double>(static_cast<float>(value)));
      out += lanes;
    }
  }
}

State SpringBatches::state() const {
  State state = read_records(nodes.data(), slot);
  for (std::size_t node = 0; node < slot.size(); ++node) {
    const float* in = rest.data() + rest_offset(slot[node]);
    state.position[node] += vec3_cast<double>(Vec3<float>{in[0], in[lanes], in[2 * lanes]});
  }
  return state;
}

}  // namespace mssim
