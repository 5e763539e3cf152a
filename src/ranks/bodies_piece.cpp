#include <cstring>
#include <optional>
#include <utility>

#include "backends/layouts/spring_graph.h"
#include "backends/openmp/bodies.h"
#include "backends/openmp/openmp.h"
#include "platform/machine.h"
#include "ranks/piece.h"
#include "ranks/shares.h"
#include "scene/scene_kinds.h"
#include "text/text.h"

namespace mssim {
namespace {

const std::vector<BodySpec>& list_of(const SceneSpec& scene) {
  return std::get<BodiesSpec>(scene.content).list;
}

/// The scene with only these bodies.
SceneSpec with_bodies(const SceneSpec& scene, const std::vector<BodySpec>& bodies) {
  SceneSpec some = scene;
  std::get<BodiesSpec>(some.content).list = bodies;
  return some;
}

/// [bodies] nodes and springs of each. Every shape is meshed once.
std::vector<SceneCounts> counts_of_bodies(const SceneSpec& scene) {
  const std::vector<BodySpec>& list = list_of(scene);
  std::vector<SceneCounts> counts;
  for (std::size_t body = 0; body < list.size(); ++body) {
    const auto first =
        static_cast<std::size_t>(std::ranges::find(list, list[body].shape, &BodySpec::shape) - list.begin());
    counts.push_back(first < body ? counts[first] : counts_of(with_bodies(scene, {list[body]})));
  }
  return counts;
}

/// Throws Unavailable, on all ranks, if their meshes differ, for example because of another TetGen.
void require_same_meshes(const Session& session, const std::vector<SceneCounts>& bodies) {
  std::string own;
  for (const SceneCounts& body : bodies) own += fmt::format("{} {} ", body.nodes, body.springs_unique);
  const std::vector<std::string> all = session.gather(own);
  for (int rank = 1; rank < session.ranks(); ++rank)
    if (all[static_cast<std::size_t>(rank)] != all.front())
      throw Unavailable("{} meshes these bodies differently from {}: install the same TetGen on both",
                        session.name_of(rank), session.name_of(0));
}

std::string bodies_in_words(std::size_t count) {
  return fmt::format("{} {}", count, count == 1 ? "body" : "bodies");
}

std::vector<std::vector<BodyShare>> shares_for(int ranks, const std::vector<std::size_t>& nodes) {
  if (auto shares = body_shares(nodes, ranks)) return std::move(*shares);
  throw Unsupported("{} cannot be cut for {}: a part of a body has at least {} nodes, so give at most {}",
                    bodies_in_words(nodes.size()), pluralize(static_cast<std::uint64_t>(ranks), "rank"),
                    least_share, pluralize(static_cast<std::uint64_t>(most_ranks(nodes, ranks)), "rank"));
}

std::vector<std::size_t> nodes_of(const std::vector<SceneCounts>& bodies) {
  return mapped<std::size_t>(bodies, &SceneCounts::nodes);
}

/// A body with nodes on this rank, in the system of all such bodies.
struct BodyHere {
  std::size_t number;      ///< index in the scene
  std::size_t scene_node;  ///< its first node in the scene
  std::size_t first_node, nodes;
  std::vector<Spring> springs;  ///< between its nodes, from 0
};

/// Finds these bodies. `system`: all of them, one after the other.
std::vector<BodyHere> bodies_here(const System& system, const std::vector<std::size_t>& numbers,
                                  const std::vector<std::size_t>& nodes) {
  std::vector<BodyHere> here;
  std::size_t first = 0;
  auto spring = system.springs.begin();
  for (std::size_t number = 0, scene_node = 0; number < nodes.size(); scene_node += nodes[number++]) {
    if (!std::ranges::binary_search(numbers, number)) continue;
    BodyHere& body = here.emplace_back(BodyHere{number, scene_node, first, nodes[number], {}});
    const auto offset = static_cast<std::uint32_t>(first);
    first += body.nodes;
    for (; spring != system.springs.end() && spring->first < first; ++spring)
      body.springs.push_back(
          {spring->first - offset, spring->second - offset, spring->rest_length, spring->kind});
  }
  return here;
}

/// [bodies][nodes] the rank of each node of the divided bodies; empty for whole ones. The first rank of a
/// divided body cuts it and sends the result to all, because METIS may differ between machines.
std::vector<std::vector<int>> ranks_of_nodes(const Session& session, const std::vector<BodyHere>& here,
                                             const std::vector<std::vector<BodyShare>>& shares,
                                             const std::vector<std::size_t>& nodes) {
  std::string own;
  for (const BodyHere& body : here) {
    const std::vector<BodyShare>& share = shares[body.number];
    if (share.size() == 1 || share.front().rank != session.rank()) continue;
    const auto wanted = mapped<std::size_t>(share, &BodyShare::nodes);
    std::vector<int> ranks;
    for (const std::uint32_t part : graph_partition(body.nodes, body.springs, wanted))
      ranks.push_back(share[part].rank);
    own.append(reinterpret_cast<const char*>(ranks.data()), ranks.size() * sizeof(int));
  }
  const std::vector<std::string> all = session.gather(own);
  std::vector<std::size_t> taken(all.size(), 0);  // [ranks] values read from its text
  std::vector<std::vector<int>> rank_of(shares.size());
  for (std::size_t body = 0; body < shares.size(); ++body) {
    if (shares[body].size() == 1) continue;
    const auto cutter = static_cast<std::size_t>(shares[body].front().rank);
    rank_of[body].resize(nodes[body]);
    std::memcpy(rank_of[body].data(), all[cutter].data() + taken[cutter], nodes[body] * sizeof(int));
    taken[cutter] += nodes[body] * sizeof(int);
  }
  return rank_of;
}

/// [ranks] the scene's nodes that each steps.
std::vector<std::vector<NodeRun>> runs_of_ranks(int ranks, const std::vector<std::vector<BodyShare>>& shares,
                                                const std::vector<std::vector<int>>& rank_of,
                                                const std::vector<std::size_t>& nodes) {
  std::vector<std::vector<NodeRun>> all(static_cast<std::size_t>(ranks));
  std::size_t first = 0;
  const auto add = [&](int rank, std::size_t node, std::size_t count) {
    std::vector<NodeRun>& runs = all[static_cast<std::size_t>(rank)];
    if (!runs.empty() && runs.back().first + runs.back().count == node)
      runs.back().count += count;
    else
      runs.push_back({node, count});
  };
  for (std::size_t body = 0; body < shares.size(); first += nodes[body++]) {
    if (shares[body].size() == 1) add(shares[body].front().rank, first, nodes[body]);
    for (std::size_t node = 0; node < rank_of[body].size(); ++node) add(rank_of[body][node], first + node, 1);
  }
  return all;
}

/// The part of this rank. `system`: all bodies with nodes on it.
BodiesPart part_of_rank(int rank, const System& system, const std::vector<BodyHere>& here,
                        const std::vector<std::vector<int>>& rank_of) {
  std::vector<std::uint32_t> place(system.nodes());
  std::vector<int> owner(system.nodes(), rank);
  for (const BodyHere& body : here) {
    const std::vector<std::uint32_t> places = places_in(reverse_cuthill_mckee(body.nodes, body.springs));
    for (std::size_t i = 0; i < places.size(); ++i)
      place[body.first_node + i] = static_cast<std::uint32_t>(body.scene_node) + places[i];
    std::ranges::copy(rank_of[body.number], owner.begin() + static_cast<std::ptrdiff_t>(body.first_node));
  }
  return part_of_bodies(system, place, owner, rank);
}

/// The bodies of a scene that one rank steps, whole ones and parts of divided ones, with openmp's own vector
/// code: bitwise identical with openmp for the same instruction set. Bodies do not touch each other, so only
/// the ranks of a divided body exchange messages while they step.
class BodiesPiece final : public Piece {
 public:
  BodiesPiece(const Session& session, const RankJob& job)
      : kernel_(common_kernel(session, step_kernels<SlicedBodies>(*job.integrator), job.roots)) {
    session.wait_at_most(longest_meshing_s);
    const std::vector<SceneCounts> counts = counts_of_bodies(job.scene);
    require_same_meshes(session, counts);
    const std::vector<std::size_t> nodes = nodes_of(counts);
    for (const std::size_t body : nodes) scene_nodes_ += body;
    shares_ = shares_for(session.ranks(), nodes);
    std::vector<std::size_t> numbers;
    std::vector<BodySpec> specs;
    for (std::size_t body = 0; body < shares_.size(); ++body)
      if (std::ranges::find(shares_[body], session.rank(), &BodyShare::rank) != shares_[body].end()) {
        numbers.push_back(body);
        specs.push_back(list_of(job.scene)[body]);
      }
    const System system = build_system(with_bodies(job.scene, specs));
    const std::vector<BodyHere> here = bodies_here(system, numbers, nodes);
    const std::vector<std::vector<int>> rank_of = ranks_of_nodes(session, here, shares_, nodes);
    session.wait_at_most(longest_silence_s);
    runs_ = runs_of_ranks(session.ranks(), shares_, rank_of, nodes);
    for (std::size_t rank = 0; rank < runs_.size() && session.rank() != 0; ++rank)
      if (static_cast<int>(rank) != session.rank()) runs_[rank] = {};

    const BodiesPart part = part_of_rank(session.rank(), system, here, rank_of);
    if (part.graph.own == system.nodes()) {
      whole_ = make_openmp(system, *job.integrator, job.dt_s,
                           {.threads = job.threads, .instruction_set = kernel_.instruction_set});
      return;
    }
    bodies_.emplace(part.system, SlicedGraph(part.system, kernel_.lanes, part.graph), *job.integrator,
                    job.dt_s, static_cast<std::size_t>(job.threads));
    if (!part.neighbours.empty()) bodies_->messages = &messages_.emplace(session, part, *bodies_);
    bodies_->set_state(part.system.start);
  }

  /// Without ghosts: messages bring them before the first stage.
  std::vector<NodeRun> taken_by(int rank) const override { return runs_[static_cast<std::size_t>(rank)]; }
  std::vector<NodeRun> owned_by(int rank) const override { return taken_by(rank); }
  std::size_t scene_nodes() const override { return scene_nodes_; }
  void set_state(const State& state) override {
    whole_ ? whole_->set_state(state) : bodies_->set_state(state);
  }
  State state() const override { return whole_ ? whole_->state() : bodies_->state(); }
  void step(int count) override { whole_ ? whole_->step(count) : kernel_.step(*bodies_, count); }
  RankCosts costs() const override { return messages_ ? messages_->costs() : RankCosts{}; }
  int threads() const override { return whole_ ? whole_->threads() : static_cast<int>(bodies_->threads); }
  std::string device() const override { return whole_ ? whole_->device() : kernel_.device(); }
  std::string note() const override {
    const auto divided = static_cast<std::size_t>(
        std::ranges::count_if(shares_, [](const auto& shares) { return shares.size() > 1; }));
    const std::size_t whole = shares_.size() - divided;
    if (divided == 0) return "whole bodies";
    if (whole == 0) return bodies_in_words(divided) + " divided";
    return fmt::format("{} whole, {} divided", bodies_in_words(whole), divided);
  }

 private:
  StepKernel<SlicedBodies> kernel_;
  std::vector<std::vector<BodyShare>> shares_;  ///< [bodies of the scene]
  std::vector<std::vector<NodeRun>> runs_;      ///< [ranks] on rank 0; on other ranks only their own
  std::size_t scene_nodes_ = 0;
  std::unique_ptr<Backend> whole_;      ///< openmp, if this rank has only whole bodies
  std::optional<SlicedBodies> bodies_;  ///< otherwise
  std::optional<GhostMessages> messages_;
};

}  // namespace

void require_shares(const SceneSpec& scene, int ranks) {
  shares_for(ranks, nodes_of(counts_of_bodies(scene)));
}

std::unique_ptr<Piece> make_bodies_piece(const Session& session, const RankJob& job) {
  return std::make_unique<BodiesPiece>(session, job);
}

}  // namespace mssim
