// A backend for each body of a scene, behind one.

#include "backends/backends.h"
#include "integrators/all_integrators.h"
#include "tests/support/backend_checks.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

constexpr double dt_s = 1e-5;

BackendInfo each_of(std::string_view backend) {
  BackendInfo info = *find_backend(backend);
  info.each_body = true;
  return info;
}

/// Two blocks whose nodes stand mixed in the scene.
System mixed_blocks() {
  const System apart = two_solid_blocks();
  const std::size_t nodes = apart.nodes();
  constexpr std::size_t stride = 7;
  EXPECT_NE(nodes % stride, 0U);
  System mixed = apart;
  std::vector<std::uint32_t> place(nodes);
  for (std::size_t i = 0; i < nodes; ++i) place[i] = static_cast<std::uint32_t>(stride * i % nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    mixed.node_mass[place[i]] = apart.node_mass[i];
    mixed.start.position[place[i]] = apart.start.position[i];
    mixed.start.velocity[place[i]] = apart.start.velocity[i];
  }
  for (Spring& spring : mixed.springs)
    spring.first = place[spring.first], spring.second = place[spring.second];
  for (Tetrahedron& corners : std::get<TetrahedralMesh>(mixed.topology).tetrahedra)
    for (std::uint32_t& corner : corners) corner = place[corner];
  return mixed;
}

TEST(EachBody, OfSerialHasTheBitsOfAllTogetherWithEveryIntegrator) {
  const System system = mixed_blocks();
  for (const Integrator* integrator : all_integrators) {
    if (is_implicit(*integrator)) continue;
    const double dt = backend_dt_of(*integrator);
    const auto together = make_backend(*find_backend("serial"), system, *integrator, dt, {.threads = 1});
    const auto each = make_backend(each_of("serial"), system, *integrator, dt, {.threads = 1});
    together->step(20);
    EXPECT_TRUE(same_state(state_after(*each, 20), together->state())) << integrator->name;
    const State later = each->state();
    each->step(3);
    each->set_state(later);
    EXPECT_TRUE(same_state(each->state(), together->state())) << integrator->name << " set";
  }
}

TEST(EachBody, OfEveryBackendAgreesWithTheReference) {
  const System system = two_solid_blocks();
  for (const BackendInfo& backend : backends())
    for (const char* name : {"semi-euler", "rk4", "implicit-euler"}) {
      const Integrator* integrator = find_integrator(name);
      if (integrator == nullptr || (is_implicit(*integrator) && !backend.make_implicit)) continue;
      const double dt = backend_dt_of(*integrator);
      const auto each = make_backend(each_of(backend.name), system, *integrator, dt, {.threads = 2});
      EXPECT_TRUE(agrees(*each, system, *integrator, dt)) << backend.name << ", " << name;
    }
}

TEST(EachBody, RefusesACloth) {
  for (const BackendInfo& backend : backends())
    EXPECT_THROW(make_backend(each_of(backend.name), cloth_system(4, 5), *find_integrator("rk4"), dt_s,
                              {.threads = 1}),
                 Unsupported)
        << backend.name;
}

/// Notes which of them steps.
class NotedBackend final : public Backend {
 public:
  NotedBackend(const System& system, int number, std::vector<int>& steps)
      : state_(system.start), springs_(system.springs.size()), number_(number), steps_(steps) {}
  void set_state(const State& state) override { state_ = state; }
  void step(int count) override { steps_.insert(steps_.end(), static_cast<std::size_t>(count), number_); }
  State state() const override { return state_; }
  std::string device() const override { return "a device"; }
  int threads() const override { return 1 + number_; }
  int steps_per_pass() const override { return 3 - number_; }
  std::optional<std::uint64_t> stored_springs() const override {
    return number_ == 0 ? std::optional<std::uint64_t>(1) : std::nullopt;
  }
  bool runs_on_host() const override { return false; }
  std::string note() const override { return "slow here"; }

 private:
  State state_;
  std::uint64_t springs_;
  int number_;
  std::vector<int>& steps_;
};

TEST(EachBody, StepsThemInTurnAndAnswersForAll) {
  const System system = two_solid_blocks();
  std::vector<int> steps;
  int made = 0;
  std::vector<std::size_t> springs;
  const auto each = make_for_each_body(system, [&](const System& body) {
    springs.push_back(body.springs.size());
    return std::make_unique<NotedBackend>(body, made++, steps);
  });
  EXPECT_EQ(made, 2);
  each->step(2);
  EXPECT_THAT(steps, ElementsAre(0, 1, 0, 1));
  EXPECT_EQ(each->threads(), 2);
  EXPECT_EQ(each->steps_per_pass(), 2);
  EXPECT_EQ(each->stored_springs(), 1 + springs.at(1));
  EXPECT_EQ(each->device(), "a device");
  EXPECT_FALSE(each->runs_on_host());
  EXPECT_EQ(each->note(), "slow here") << "once";
  EXPECT_TRUE(same_state(each->state(), system.start));
}

TEST(Threads, ThatARowSaysAndThatAreTooManyHereMakeItUnavailable) {
  BackendInfo info = *find_backend("threads-mutex");
  info.threads = 100'000;
  EXPECT_THAT(sentence_of<Unavailable>([&] {
                make_backend(info, two_solid_blocks(), *find_integrator("rk4"), dt_s, {.threads = 1});
              }),
              AllOf(HasSubstr("100000 threads"), testing::ContainsRegex("at most [0-9]+")));
}

}  // namespace
}  // namespace mssim
