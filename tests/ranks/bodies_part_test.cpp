#include <thread>

#include "backends/layouts/spring_graph.h"
#include "backends/openmp/bodies.h"
#include "backends/openmp/openmp.h"
#include "backends/vectors/step_kernels.h"
#include "integrators/all_integrators.h"
#include "ranks/shares.h"
#include "tests/support/backend_checks.h"
#include "tests/support/mail.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// What MPI is between processes, between threads: whole records.
class MailOfNodes final : public NodeMessages<float> {
 public:
  /// `mail`: [ranks][ranks] from the one to the other.
  MailOfNodes(int rank, std::vector<std::vector<Mail>>& mail, const BodiesPart& part,
              const SlicedBodies& bodies)
      : rank_(static_cast<std::size_t>(rank)), mail_(mail), part_(part), bodies_(bodies) {}

  void begin(const float* records) override {
    EXPECT_EQ(begun_++, finished_);
    for (const BodiesPart::Neighbour& neighbour : part_.neighbours) {
      std::vector<float> letter;
      for (const std::uint32_t node : neighbour.edge) {
        const float* record = records + std::size_t{bodies_.slot[node]} * record_floats;
        letter.insert(letter.end(), record, record + record_floats);
      }
      mail_[rank_][static_cast<std::size_t>(neighbour.rank)].send(letter.data(), letter.size());
    }
  }
  void advance() override { EXPECT_GE(begun_, finished_); }
  void finish(float* records) override {
    EXPECT_EQ(begun_, ++finished_);
    float* ghosts = records + bodies_.slices() * bodies_.lanes * record_floats;
    for (const BodiesPart::Neighbour& neighbour : part_.neighbours) {
      mail_[static_cast<std::size_t>(neighbour.rank)][rank_].receive(ghosts);
      ghosts += neighbour.ghosts * record_floats;
    }
  }
  int exchanges() const { return finished_; }
  bool is_balanced() const { return begun_ == finished_; }

 private:
  std::size_t rank_;
  std::vector<std::vector<Mail>>& mail_;
  const BodiesPart& part_;
  const SlicedBodies& bodies_;
  int begun_ = 0, finished_ = 0;
};

/// Bodies, and who steps which of their nodes.
struct Divided {
  std::string name;
  System bodies;
  std::vector<int> owner;
  int ranks;
};

std::vector<int> owners(const System& bodies, const std::function<int(std::uint32_t)>& rank_of) {
  std::vector<int> owner;
  for (std::uint32_t node = 0; node < bodies.nodes(); ++node) owner.push_back(rank_of(node));
  return owner;
}

std::vector<Divided> divided_bodies() {
  // Low enough to meet the floor within the steps.
  const System block = solid_block(5, 6, 7, 0.002), blocks = two_solid_blocks();
  std::mt19937 random(5);
  std::vector<Divided> all;
  all.push_back({"halves", block, owners(block, [](std::uint32_t node) { return node < 100 ? 1 : 0; }), 2});
  all.push_back(
      {"layers", block, owners(block, [](std::uint32_t node) { return static_cast<int>(node / 42); }), 5});
  all.push_back(
      {"at random", block, owners(block, [&](std::uint32_t) { return static_cast<int>(random() % 3); }), 3});
  all.push_back({"one node", block, owners(block, [](std::uint32_t node) { return node == 17 ? 1 : 0; }), 2});
  all.push_back({"one of two bodies", blocks,
                 owners(blocks, [](std::uint32_t node) { return node < 60 ? 1 : (node < 90 ? 0 : 2); }), 3});
  all.push_back(
      {"whole ones", blocks, owners(blocks, [](std::uint32_t node) { return node < 60 ? 1 : 0; }), 2});
  return all;
}

BodiesPart part_of(const Divided& divided, int rank) {
  const std::vector<std::uint32_t> places =
      places_in(reverse_cuthill_mckee(divided.bodies.nodes(), divided.bodies.springs));
  return part_of_bodies(divided.bodies, places, divided.owner, rank);
}

/// The state after some steps, each part by threads that know nothing of the others but what the mail brings.
State state_of_parts(const Divided& divided, const Integrator& integrator, std::size_t threads, int steps) {
  const auto ranks = static_cast<std::size_t>(divided.ranks);
  const StepKernel<SlicedBodies> kernel = step_kernels<SlicedBodies>(integrator).front();
  std::vector<std::vector<Mail>> mail(ranks);
  for (std::vector<Mail>& from : mail) from = std::vector<Mail>(ranks);
  State all = divided.bodies.start;
  const auto step_part = [&](int rank) {
    const BodiesPart part = part_of(divided, rank);
    SlicedBodies bodies(part.system, SlicedGraph(part.system, kernel.lanes, part.graph), integrator,
                        backend_dt_of(integrator), threads);
    MailOfNodes messages(rank, mail, part, bodies);
    if (!part.neighbours.empty()) bodies.messages = &messages;
    bodies.set_state(part.system.start);
    kernel.step(bodies, steps / 2);  // in two calls: messages must not be under way between them
    EXPECT_TRUE(messages.is_balanced());
    kernel.step(bodies, steps - steps / 2);
    EXPECT_EQ(messages.exchanges(),
              part.neighbours.empty() ? 0 : steps * static_cast<int>(integrator.stage_count));
    const State state = bodies.state();
    for (std::size_t node = 0, own = 0; node < divided.owner.size(); ++node)
      if (divided.owner[node] == rank) {
        all.position[node] = state.position[own];
        all.velocity[node] = state.velocity[own++];
      }
  };
  std::vector<std::thread> running;
  for (int rank = 0; rank < divided.ranks; ++rank) running.emplace_back(step_part, rank);
  for (std::thread& thread : running) thread.join();
  return all;
}

class EachIntegratorInBodyPieces : public testing::TestWithParam<std::string_view> {};

TEST_P(EachIntegratorInBodyPieces, GivesTheBitsOfTheWhole) {
  const Integrator& integrator = *find_integrator(GetParam());
  constexpr int steps = 151;
  for (const Divided& divided : divided_bodies()) {
    const State expected =
        state_after(*make_openmp(divided.bodies, integrator, backend_dt_of(integrator), {1, ""}), steps);
    EXPECT_NE(expected.position, divided.bodies.start.position);
    for (const std::size_t threads : {1U, 2U, 3U}) {
      SCOPED_TRACE(divided.name + ", " + std::to_string(threads) + " threads");
      const State state = state_of_parts(divided, integrator, threads, steps);
      EXPECT_EQ(state.position, expected.position);
      EXPECT_EQ(state.velocity, expected.velocity);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Table, EachIntegratorInBodyPieces, testing::ValuesIn(names_of(integrators)),
                         ByName());

TEST(BodiesPieces, MeetTheFloorWithinTheStepsOfTheseTests) {
  const System block = solid_block(5, 6, 7, 0.002);
  for (const Integrator& integrator : integrators) {
    const auto end_of = [&](const System& system) {
      return state_after(*make_openmp(system, integrator, backend_dt_of(integrator), {1, ""}), 151).position;
    };
    EXPECT_NE(end_of(block), end_of(without_floor(block))) << integrator.name;
  }
}

}  // namespace
}  // namespace mssim
