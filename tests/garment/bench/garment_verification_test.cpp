// Mistakes that a backend which dresses could make must be found.
#include "garment/bench/garment_verification.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "garment/contact/body_maps.h"
#include "garment/fitting/fitting.h"
#include "garment/stepping/dressing_backend.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"
#include "tests/support/dressing_step.h"
#include "tests/support/garment_system.h"

namespace mssim {
namespace {

/// Jeans, dressed once for all tests.
struct Jeans {
  SceneSpec spec = find_scene("jeans1k");
  System system = build_system(spec);
  double dt_s = spec.dt_s.value();
  State draped;
  GarmentReference reference;

  Jeans() {
    const auto backend = make_openmp_dressing(system, semi_euler, dt_s, 2);
    const DressingResult result =
        dress(*backend, system, dt_s, {}, [](const State&, std::int64_t) { return true; });
    EXPECT_TRUE(result.settled);
    draped = result.state;
    reference = run_garment_reference(system, semi_euler, dt_s, draped);
  }
};

const Jeans& jeans() {
  static const Jeans once;
  return once;
}

Verification verify_stepping(const System& stepped) {
  return verify_garment(*make_serial_dressing(stepped, semi_euler, jeans().dt_s), jeans().system,
                        jeans().reference, jeans().dt_s);
}

TEST(GarmentVerification, PassesTheBackendsThatDress) {
  const Jeans& scene = jeans();
  ASSERT_FALSE(scene.reference.failure);
  ASSERT_EQ(scene.reference.seaming.size(), 20U);
  ASSERT_EQ(scene.reference.draped.size(), 20U);
  const auto single = make_serial_dressing(scene.system, semi_euler, scene.dt_s);
  const auto vectors = make_openmp_dressing(scene.system, semi_euler, scene.dt_s, 2);
  for (Backend* backend : std::initializer_list<Backend*>{single.get(), vectors.get()}) {
    const Verification found = verify_garment(*backend, scene.system, scene.reference, scene.dt_s);
    EXPECT_FALSE(found.failure) << *found.failure;
    EXPECT_GT(found.position_error, 0) << "single precision cannot be exact";
    EXPECT_LT(found.position_error, scene.reference.tolerance / 2);
    EXPECT_LT(std::abs(found.energy_drift), 1e-4);
  }
}

TEST(GarmentVerification, AllowsWhatFiveStepsRoundAndOneNodeWhatContactMoves) {
  const Jeans& scene = jeans();
  double highest = 0;
  for (const Vec3d& x : scene.system.start.position) highest = std::max(highest, x.y);
  const double unit = mean_rest_length(scene.system);
  EXPECT_NEAR(scene.reference.tolerance * unit, 4 * std::sqrt(5) * highest / (1 << 24), 1e-9);
  // 1 m/s for five steps of 0.52 ms.
  EXPECT_NEAR(scene.reference.farthest * unit, 2.6e-3, 1e-9);
}

/// A mistake, made in the system that the backend under test steps, and what of it the failure must say.
struct Mistake {
  std::string name;
  std::string found_while;
  std::function<void(System&)> make;
};

void weaken(System& system, std::size_t spring) {
  system.materials.push_back({0, 0});
  system.springs.at(spring).kind = static_cast<std::uint32_t>(system.materials.size() - 1);
}

/// Of the first panel, whose materials come first.
void stiffen(System& system, GridSpringKind kind) { system.materials.at(kind).stiffness *= 1.01; }

/// The body as its maps have it, farther out.
std::vector<std::shared_ptr<const BodyMaps>> maps_farther_out(double metres) {
  SceneSpec spec = jeans().spec;
  std::get<GarmentSpec>(spec.content).skin_m += metres;
  return std::get<Garment>(build_system(spec).topology).body_maps;
}

TEST(GarmentVerification, FindsEveryMistake) {
  const std::vector<Mistake> mistakes{
      {"a spring of the first panel is missing", "seams close", [](System& s) { weaken(s, 1); }},
      {"a spring amid the springs is missing", "seams close",
       [](System& s) { weaken(s, s.springs.size() / 2); }},
      {"the last spring is missing", "seams close", [](System& s) { weaken(s, s.springs.size() - 1); }},
      {"structural springs of a panel 1 % too stiff", "seams close",
       [](System& s) { stiffen(s, structural); }},
      {"its shear springs 1 % too stiff", "seams close", [](System& s) { stiffen(s, shear); }},
      {"its bending springs 1 % too stiff", "seams close", [](System& s) { stiffen(s, bending); }},
      {"the first joint is missing", "seams close",
       [](System& s) { garment_in(s).joints.erase(garment_in(s).joints.begin()); }},
      {"a joint amid the joints is missing", "seams close",
       [](System& s) {
         auto& joints = garment_in(s).joints;
         joints.erase(joints.begin() + static_cast<std::ptrdiff_t>(joints.size() / 2));
       }},
      {"seams pull 1 % harder", "seams close", [](System& s) { garment_in(s).dressing.seam_force *= 1.01; }},
      {"no correction", "", [](System& s) { garment_in(s).dressing.correction = VelocityCorrection::none; }},
      {"the other correction", "",
       [](System& s) { garment_in(s).dressing.correction = VelocityCorrection::published; }},
      {"one sweep less", "", [](System& s) { garment_in(s).dressing.correction_sweeps = 1; }},
      {"damping 10 % off while the seams close", "seams close",
       [](System& s) { garment_in(s).dressing.seaming_damping *= 1.1; }},
      {"damping 10 % off when draped", "when draped", [](System& s) { s.viscous_damping *= 1.1; }},
      {"no gravity", "when draped", [](System& s) { s.gravity = 0; }},
      {"no friction", "when draped", [](System& s) { garment_in(s).dressing.friction = 0; }},
      {"friction 10 % off", "when draped", [](System& s) { garment_in(s).dressing.friction *= 0.9; }},
      {"maps half a millimetre farther out", "seams close",
       [](System& s) { garment_in(s).body_maps = maps_farther_out(0.0005); }},
      {"no body at all", "seams close", [](System& s) { garment_in(s).body_maps.clear(); }},
  };
  for (const Mistake& mistake : mistakes) {
    System wrong = jeans().system;
    mistake.make(wrong);
    const Verification found = verify_stepping(wrong);
    ASSERT_TRUE(found.failure) << mistake.name << ": error " << found.position_error << " of "
                               << jeans().reference.tolerance;
    EXPECT_NE(found.failure->find(mistake.found_while), std::string::npos)
        << mistake.name << ": " << *found.failure;
  }
}

/// Forwards all, but one step of each call is done wrong.
class PushesOneNodeAway final : public DressingBackend {
 public:
  PushesOneNodeAway(const Jeans& scene, double metres)
      : inner_(make_serial_dressing(scene.system, semi_euler, scene.dt_s)), metres_(metres) {}
  void set_state(const State& state) override { inner_->set_state(state); }
  void step(int count) override { inner_->step(count); }
  State state() const override {
    State state = inner_->state();
    if (inner_->progress().draping) state.position[17].z += metres_;
    return state;
  }
  std::string device() const override { return "made up"; }
  int threads() const override { return 1; }
  DressingProgress progress() const override { return inner_->progress(); }

 private:
  std::unique_ptr<DressingBackend> inner_;
  double metres_;
};

TEST(GarmentVerification, FindsOneNodeThatIsFartherOffThanContactMovesIt) {
  const auto verified = [](double metres) {
    PushesOneNodeAway backend(jeans(), metres);
    return verify_garment(backend, jeans().system, jeans().reference, jeans().dt_s);
  };
  EXPECT_FALSE(verified(0.0002).failure) << "what contact may do";
  const Verification found = verified(0.006);
  ASSERT_TRUE(found.failure);
  EXPECT_NE(found.failure->find("of one node when draped"), std::string::npos) << *found.failure;
}

TEST(GarmentVerification, SaysWhereASimulationBlowsUp) {
  const Jeans& scene = jeans();
  const auto backend = make_serial_dressing(scene.system, semi_euler, 40 * scene.dt_s);
  const Verification found = verify_garment(*backend, scene.system, scene.reference, 40 * scene.dt_s);
  ASSERT_TRUE(found.failure);
  const GarmentReference blown_up =
      run_garment_reference(scene.system, semi_euler, 1e6 * scene.dt_s, scene.draped);
  ASSERT_TRUE(blown_up.failure);
  EXPECT_NE(blown_up.failure->find("the double-precision reference blew up at step"), std::string::npos)
      << *blown_up.failure;
  EXPECT_EQ(verify_garment(*backend, scene.system, blown_up, scene.dt_s).failure, blown_up.failure);
}

}  // namespace
}  // namespace mssim
