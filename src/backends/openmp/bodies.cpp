#include "backends/openmp/bodies.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "backends/threads/chunk_tickets.h"

namespace mssim {
namespace {

/// Cost of a chunk, in entries of slices or in springs of all lanes, unless that makes too many chunks: some
/// microseconds.
constexpr std::size_t chunk_cost = 1024;

/// Minimum number of chunks per thread: awake threads can then take over small parts of a sleeping thread's
/// work. More chunks cost time in a scene whose stage takes microseconds.
constexpr std::size_t least_chunks = 4;

/// BodySteps::spins for slices: some microseconds.
constexpr int slice_spins = 300;

/// Cost of a node besides its springs, in springs.
constexpr std::size_t node_cost = 2;

/// Springs per spin of a waiting thread: a spin takes 35 ns on an Intel Xeon, a vector of springs 5. A thread
/// that slept while another one did its share must wake up before the other thread has finished both shares;
/// otherwise that one would keep doing both.
constexpr std::size_t springs_a_spin = 4;

/// Limit of spinning: about a tenth of a millisecond.
constexpr std::size_t most_spins = 4096;

/// Components of a position or a velocity.
constexpr std::size_t components = 3;

/// Costs of ranges of a shape's nodes, in springs of all lanes.
class PieceCosts {
 public:
  template <class Real>
  explicit PieceCosts(const AlikeBodiesOf<Real>& shape)
      : begun_before_(shape.first_spring), ended_before_(shape.nodes() + 1, 0) {
    for (const auto& spring : shape.springs) ++ended_before_[spring.other + 1];
    std::partial_sum(ended_before_.begin(), ended_before_.end(), ended_before_.begin());
  }
  std::size_t nodes() const { return ended_before_.size() - 1; }
  /// Cost of nodes [begin, end): all springs with an end there.
  std::size_t of(std::size_t begin, std::size_t end) const {
    return begun_before_[end] - ended_before_[begin] + (end - begin) * node_cost;
  }
  /// Largest end of nodes from `begin` on that cost at most `most`, but at least one node.
  std::size_t end_of(std::size_t begin, std::size_t most) const {
    std::size_t low = begin + 1, high = nodes();
    while (low < high) {
      const std::size_t middle = (low + high + 1) / 2;
      if (of(begin, middle) <= most)
        low = middle;
      else
        high = middle - 1;
    }
    return low;
  }

 private:
  std::vector<std::uint32_t> begun_before_;  // [nodes + 1]
  std::vector<std::size_t> ended_before_;    // [nodes + 1]
};

/// A share of a thread: nodes of a group.
struct Cut {
  std::size_t group, begin, end, share, cost;
};

/// Divides groups, one after the other, into shares that cost at most `most`.
std::vector<Cut> cut_groups(const std::vector<AlikeSlices::Group>& groups,
                            const std::vector<PieceCosts>& costs, std::size_t most) {
  std::vector<Cut> cuts;
  std::size_t share = 0, left = most;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const PieceCosts& of = costs[groups[g].shape];
    for (std::size_t begin = 0; begin < of.nodes();) {
      const std::size_t end = of.end_of(begin, left), cost = of.of(begin, end);
      if (cost > left && left < most) {  // not even one node fits
        ++share;
        left = most;
        continue;
      }
      cuts.push_back({g, begin, end, share, cost});
      left -= std::min(left, cost);
      begin = end;
    }
  }
  return cuts;
}

/// Divides groups into at most `count` shares with the lowest maximum cost.
std::vector<Cut> cut_groups_into(const std::vector<AlikeSlices::Group>& groups,
                                 const std::vector<PieceCosts>& costs, std::size_t shares) {
  std::size_t low = 1, high = 1;
  for (const AlikeSlices::Group& group : groups) high += costs[group.shape].of(0, costs[group.shape].nodes());
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    const std::vector<Cut> cuts = cut_groups(groups, costs, middle);
    if (cuts.empty() || cuts.back().share < shares)
      high = middle;
    else
      low = middle + 1;
  }
  return cut_groups(groups, costs, high);
}

template <class Real>
typename BodyLanesOf<Real>::Piece piece_of(const AlikeSlices::Group& group, const Cut& cut,
                                           const AlikeBodiesOf<Real>& bodies, std::size_t node_floats) {
  typename BodyLanesOf<Real>::Piece piece{
      group.shape, 2 * node_floats * group.first_slice, cut.begin, cut.end, cut.end, {}};
  for (std::size_t node = 0; node < cut.end; ++node)
    for (std::size_t s = bodies.first_spring[node]; s < bodies.first_spring[node + 1]; ++s) {
      const auto& spring = bodies.springs[s];
      if (node >= cut.begin)
        piece.reach = std::max<std::size_t>(piece.reach, spring.other + 1);
      else if (spring.other >= cut.begin && spring.other < cut.end)
        piece.cut.push_back({static_cast<std::uint32_t>(node * node_floats),
                             static_cast<std::uint32_t>(spring.other * node_floats), spring.stiffness_rest});
    }
  return piece;
}

}  // namespace

template <class Real>
void BodySteps<Real>::make_pairs_where_stepped(
    std::size_t size, const std::function<std::size_t(std::size_t chunk)>& first_number) {
  constexpr std::size_t page = AlignedArrayOf<Real>::alignment / sizeof(Real);
  this->make_pairs(size);
#pragma omp parallel for num_threads(static_cast <int>(threads)) schedule(static, 1)
  for (std::size_t range = 0; range < threads; ++range) {
    const std::size_t begin = first_number(chunks.size() * range / threads);
    const std::size_t end = first_number(chunks.size() * (range + 1) / threads);
    for (AlignedArrayOf<Real>& pair : this->pairs)
      for (std::size_t i = begin; i < std::min(end, pair.size()); i += page) pair.data()[i] = 0;
  }
}

template <class Real>
SlicedBodiesOf<Real>::SlicedBodiesOf(const System& system, const Integrator& method, double dt_s,
                                     std::size_t slice_lanes, std::size_t thread_count)
    : SlicedBodiesOf(
          system, (require_nameable_records(system, record_floats), SlicedGraphOf<Real>(system, slice_lanes)),
          method, dt_s, thread_count) {}

template <class Real>
SlicedBodiesOf<Real>::SlicedBodiesOf(const System& system, SlicedGraphOf<Real> graph,
                                     const Integrator& method, double dt_s, std::size_t thread_count)
    : BodySteps<Real>(system, method, dt_s), lanes(graph.lanes) {
  require_nameable_records(system, record_floats);
  entries = slice_entries(graph, record_floats, [](std::uint32_t node_slot) { return node_slot; });
  constants = AlignedArrayOf<Real>(graph.slots() * slice_constants);
  for (std::size_t i = 0; i < graph.slots(); ++i) {
    Real* of_slot = constants.data() + slot_offset(i, slice_constants, lanes);
    *write_constants(of_slot, lanes, graph.constants[i]) = static_cast<Real>(graph.held[i]);
  }
  slot.assign(graph.slot.begin(), graph.slot.end() - static_cast<std::ptrdiff_t>(graph.ghosts));
  first_entry = std::move(graph.first_entry);
  this->threads = threads_for(slices(), thread_count);
  this->spins = slice_spins;
  const auto cost_before = [&](std::size_t slice) { return cost_of_slices_before(first_entry, slice); };
  const std::size_t by_cost = cost_before(slices()) / chunk_cost;
  const std::size_t count = std::min(
      {std::max(least_chunks * this->threads, by_cost), slices(), std::size_t{ChunkTickets::most_chunks}});
  this->chunks = balanced_ranges({0, graph.first_edge_slice}, count, cost_before);
  if (graph.ghosts > 0) edge_chunks = balanced_ranges({graph.first_edge_slice, slices()}, count, cost_before);
  this->make_pairs_where_stepped((graph.slots() + graph.ghosts) * record_floats, [&](std::size_t chunk) {
    return (chunk < this->chunks.size() ? this->chunks[chunk].begin : graph.first_edge_slice) * lanes *
           record_floats;
  });
}

template <class Real>
BodyLanesOf<Real>::BodyLanesOf(const System& system, const std::vector<AlikeBodiesOf<Real>>& bodies,
                               const Integrator& method, double dt_s, std::size_t lane_count,
                               std::size_t thread_count)
    : BodySteps<Real>(system, method, dt_s), slices(bodies, lane_count) {
  const std::size_t node_floats = components * lane_count;
  const std::size_t allowed_nodes = std::numeric_limits<std::uint32_t>::max() / node_floats;
  std::vector<PieceCosts> costs;
  std::size_t most_nodes = 0;
  for (const AlikeBodiesOf<Real>& of : bodies) {
    if (of.nodes() > allowed_nodes)
      throw Unsupported("a body has {} nodes; openmp supports at most {}", of.nodes(), allowed_nodes);
    most_nodes = std::max(most_nodes, of.nodes());
    shapes.push_back({of.constants, of.pinned, of.first_spring, of.springs, {}});
    for (auto& spring : shapes.back().springs) spring.other *= static_cast<std::uint32_t>(node_floats);
    costs.emplace_back(of);
  }

  const std::vector<Cut> cuts = cut_groups_into(slices.groups, costs, std::max<std::size_t>(1, thread_count));
  std::size_t all = 0;
  for (const Cut& cut : cuts) all += cut.cost;
  const std::size_t least = std::max(chunk_cost, all / (ChunkTickets::most_chunks / 2));
  std::size_t cost = least, largest = 0;
  for (const Cut& cut : cuts) {
    const bool next_share = !pieces.empty() && cut.share != cuts[pieces.size() - 1].share;
    if (cost >= least || next_share) {
      this->chunks.push_back({pieces.size(), pieces.size()});
      cost = 0;
    }
    pieces.push_back(
        piece_of(slices.groups[cut.group], cut, bodies[slices.groups[cut.group].shape], node_floats));
    cost += cut.cost;
    largest = std::max(largest, cost);
    ++this->chunks.back().end;
  }
  this->spins = static_cast<int>(std::min<std::size_t>(most_spins, largest / springs_a_spin));
  this->threads = threads_for(this->chunks.size(), thread_count);
  for (std::size_t thread = 0; thread < this->threads; ++thread)
    forces.emplace_back(most_nodes * node_floats);
  this->make_pairs_where_stepped(slices.floats(), [&](std::size_t chunk) {
    if (chunk == this->chunks.size()) return slices.floats();
    const Piece& piece = pieces[this->chunks[chunk].begin];
    return piece.offset + 2 * piece.begin * components * lane_count;
  });
}

template <class Real>
std::uint64_t BodyLanesOf<Real>::stored_springs() const {
  std::uint64_t stored = 0;
  for (const AlikeBodiesOf<Real>& shape : shapes) stored += shape.springs.size();
  return stored;
}

template struct SlicedBodiesOf<float>;
template struct SlicedBodiesOf<double>;
template struct BodyLanesOf<float>;
template struct BodyLanesOf<double>;

}  // namespace mssim
