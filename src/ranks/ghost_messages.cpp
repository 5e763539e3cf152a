#include "ranks/ghost_messages.h"

#include <algorithm>
#include <span>

namespace mssim {
namespace {

/// Of a node in a message.
constexpr std::size_t node_floats = 6;
/// Where a record has the velocity (backends/layouts/node_records.h).
constexpr std::size_t velocity = 4;

}  // namespace

GhostMessages::GhostMessages(const Session& session, const BodiesPart& part, const SlicedBodies& bodies)
    : first_ghost_slot_(bodies.slices() * bodies.lanes), messages_(session) {
  for (const BodiesPart::Neighbour& neighbour : part.neighbours)
    for (const std::uint32_t node : neighbour.edge) edge_slots_.push_back(bodies.slot[node]);
  sent_.resize(edge_slots_.size() * node_floats);
  received_.resize((part.system.nodes() - part.graph.own) * node_floats);
  std::span<const float> sent = sent_;
  std::span<float> received = received_;
  for (const BodiesPart::Neighbour& neighbour : part.neighbours) {
    const std::size_t sends = neighbour.edge.size() * node_floats, takes = neighbour.ghosts * node_floats;
    messages_.add(neighbour.rank, sent.first(sends), received.first(takes));
    sent = sent.subspan(sends);
    received = received.subspan(takes);
  }
}

RankCosts GhostMessages::costs() const {
  RankCosts costs = messages_.costs();
  costs.packed_s += packed_s_;
  return costs;
}

void GhostMessages::begin(const float* records) {
  pack(records);
  messages_.begin();
}

void GhostMessages::finish(float* records) {
  messages_.finish();
  unpack(records);
}

void GhostMessages::pack(const float* records) {
  const SecondsAdded timed(packed_s_);
  float* to = sent_.data();
  for (const std::uint32_t slot : edge_slots_) {
    const float* record = records + std::size_t{slot} * record_floats;
    to = std::copy_n(record, 3, to);
    to = std::copy_n(record + velocity, 3, to);
  }
}

void GhostMessages::unpack(float* records) {
  const SecondsAdded timed(packed_s_);
  float* record = records + first_ghost_slot_ * record_floats;
  for (std::size_t i = 0; i < received_.size(); i += node_floats, record += record_floats) {
    std::copy_n(received_.data() + i, 3, record);
    std::copy_n(received_.data() + i + 3, 3, record + velocity);
  }
}

}  // namespace mssim
