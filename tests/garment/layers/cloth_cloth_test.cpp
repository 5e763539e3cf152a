#include "garment/layers/cloth_cloth.h"

#include "model/system.h"
#include "tests/support/cloth_layers_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

using testing::Each;

constexpr float held = std::numeric_limits<float>::infinity();
constexpr double dt = 1e-3;  // s

/// A node of 1 kg over the middle of the first triangle of a level cell of nodes of 3 kg, 1 mm above it. The
/// effective inverse mass of a contact is 1/1 + 3 (1/3)^2 / 3 = 10/9 1/kg.
LayeredCloth node_over_triangle(float triangle_mass = 3) {
  LayeredCloth cloth;
  cloth.add(0, 2, 2, level(0, 3), triangle_mass);
  cloth.add(1, 2, 2, [](double row, double column) { return Vec3d{2, 0.001 + 9 * (row + column), -1}; });
  return cloth;
}

constexpr std::uint32_t over = 4;  // the node

TEST(ClothCloth, StopsWhatApproachesAndConservesMomentum) {
  LayeredCloth cloth = node_over_triangle();
  cloth.set_node_velocity(over, {0, -2, 0});
  ClothClothCollision collision = cloth.collision({.thickness = 0.003, .friction = 0, .push_speed = 0});
  cloth.collide(collision, dt);
  ASSERT_EQ(collision.contacts().size(), 1U);
  // Impulse 2 / (10/9) = 1.8 N s; each corner gets a third of it.
  EXPECT_NEAR(cloth.speed(over).y, -0.2, 1e-6);
  for (const std::uint32_t corner : {0U, 1U, 3U}) EXPECT_NEAR(cloth.speed(corner).y, -0.2, 1e-6);
  EXPECT_EQ(cloth.speed(2).y, 0);
  EXPECT_NEAR(cloth.momentum().y, -2, 1e-6);
  EXPECT_NEAR(cloth.point(over).y, 0.001, 1e-9);  // no push
}

TEST(ClothCloth, LetsGoWhatMovesAway) {
  LayeredCloth cloth = node_over_triangle();
  cloth.set_node_velocity(over, {1, 2, 3});
  ClothClothCollision collision = cloth.collision({.push_speed = 0});
  cloth.collide(collision, dt);
  EXPECT_EQ(cloth.speed(over), (Vec3d{1, 2, 3}));
  EXPECT_EQ(cloth.speed(0), Vec3d{});
}

TEST(ClothCloth, SlowsSlidingByCoulombsLaw) {
  for (const double friction : {0.0, 0.25, 0.6}) {
    SCOPED_TRACE(friction);
    LayeredCloth cloth = node_over_triangle(held);
    cloth.set_node_velocity(over, {0.6F, -2, 0.8F});
    ClothClothCollision collision = cloth.collision({.friction = friction});
    cloth.collide(collision, dt);
    // 1 m/s across, 2 m/s of normal change: what is left is 1 - 2 friction, or nothing.
    const double left = std::max(0.0, 1 - 2 * friction);
    EXPECT_NEAR(cloth.speed(over).x, 0.6 * left, 1e-6);
    EXPECT_NEAR(cloth.speed(over).y, 0, 1e-6);
    EXPECT_NEAR(cloth.speed(over).z, 0.8 * left, 1e-6);
    EXPECT_EQ(cloth.speed(0), Vec3d{});
  }
}

TEST(ClothCloth, MovesLayersApartNoFasterThanItMayAndNoFartherThanTheThickness) {
  const auto gap_after = [](double push_speed, int steps, double height, bool also_inner_moves) {
    LayeredCloth cloth = node_over_triangle(also_inner_moves ? 3 : held);
    cloth.position[1][over] = static_cast<float>(height);
    ClothClothCollision collision = cloth.collision({.thickness = 0.003, .push_speed = push_speed});
    for (int i = 0; i < steps; ++i) cloth.collide(collision, dt);
    for (const auto& axis : cloth.velocity) EXPECT_THAT(axis, Each(0));
    return cloth.point(over).y - (cloth.point(0).y + cloth.point(1).y + cloth.point(3).y) / 3;
  };
  for (const bool also_inner_moves : {false, true}) {
    EXPECT_NEAR(gap_after(0.5, 1, 0.001, also_inner_moves), 0.0015, 1e-7);
    EXPECT_NEAR(gap_after(0.5, 2, 0.001, also_inner_moves), 0.002, 1e-7);
    EXPECT_NEAR(gap_after(0.5, 9, 0.001, also_inner_moves), 0.003, 1e-7);
    EXPECT_NEAR(gap_after(50, 1, 0.001, also_inner_moves), 0.003, 1e-7);
    // From the wrong side, through the layer.
    EXPECT_NEAR(gap_after(0.5, 1, -0.002, also_inner_moves), -0.0015, 1e-7);
    EXPECT_NEAR(gap_after(0.5, 20, -0.002, also_inner_moves), 0.003, 1e-7);
    // Out of reach.
    EXPECT_NEAR(gap_after(0.5, 5, -0.0031, also_inner_moves), -0.0031, 1e-7);
    EXPECT_NEAR(gap_after(0.5, 5, 0.0031, also_inner_moves), 0.0031, 1e-7);
  }
}

TEST(ClothCloth, LeavesHeldNodesWhereTheyAre) {
  LayeredCloth cloth = node_over_triangle(held);
  cloth.mass[over] = held;
  cloth.set_node_velocity(over, {0, -2, 0});
  const LayeredCloth before = cloth;
  ClothClothCollision collision = cloth.collision();
  cloth.collide(collision, dt);
  EXPECT_EQ(collision.contacts().size(), 1U);
  EXPECT_EQ(cloth.position, before.position);
  EXPECT_EQ(cloth.velocity, before.velocity);
}

/// The fastest approach along the normals of the last contacts, m/s.
double fastest_approach(const LayeredCloth& cloth, const ClothClothCollision& collision) {
  double fastest = 0;
  for (const ClothContact& contact : collision.contacts()) {
    Vec3d relative = cloth.speed(contact.node);
    for (std::size_t corner = 0; corner < 3; ++corner)
      relative -= double{contact.weight[corner]} * cloth.speed(contact.triangle[corner]);
    fastest = std::max(fastest, -dot(relative, vec3_cast<double>(contact.normal)));
  }
  return fastest;
}

TEST(ClothCloth, LeavesNothingThatApproachesAfterEnoughSweeps) {
  // Every node touches the other sheet, at random speeds, so that contacts disturb each other.
  LayeredCloth before;
  before.add(0, 12, 15, level(0, 0.01));
  before.add(1, 14, 11, level(0.002, 0.01, 0.0132, 0.0117), 0.5F);
  std::mt19937 random(3);
  for (auto& axis : before.velocity) {
    for (float& speed : axis) speed = static_cast<float>(random() % 2000) / 1000 - 1;
  }
  const auto left_after = [&](std::uint32_t sweeps) {
    LayeredCloth cloth = before;
    ClothClothCollision collision = cloth.collision({.friction = 0, .push_speed = 0, .sweeps = sweeps});
    cloth.collide(collision, dt);
    EXPECT_GT(collision.contacts().size(), 200U);
    EXPECT_LT(length(cloth.momentum() - before.momentum()), 1e-4);  // of some 200 kg m/s in all directions
    return fastest_approach(cloth, collision);
  };
  EXPECT_LT(left_after(2000), 1e-4);
  EXPECT_LT(left_after(2), 1);
  EXPECT_GT(left_after(1), left_after(2));
}

constexpr double step_dt = 5e-4;  // s, half of what the springs below allow

/// Steps sheets of springs of one spacing; collides their layers, if given a collision.
class FallingCloth {
 public:
  FallingCloth(LayeredCloth& cloth, double spacing) : cloth_(cloth) {
    for (const GarmentPanel& panel : cloth.garment.panels) {
      for (Spring spring : springs_of({panel.rows, panel.columns, spacing})) {
        spring.first += panel.first_node;
        spring.second += panel.first_node;
        springs_.push_back(spring);
      }
    }
  }

  void step(ClothClothCollision* collision, double gravity) {
    for (const Spring& spring : springs_) {
      const Vec3d along = cloth_.point(spring.second) - cloth_.point(spring.first);
      const Vec3d relative = cloth_.speed(spring.second) - cloth_.speed(spring.first);
      const double now = length(along);
      const double pull = 16 * (now - double{spring.rest_length}) + 0.001 * dot(relative, along) / now;  // N
      accelerate(spring.first, step_dt * pull / now * along);
      accelerate(spring.second, -step_dt * pull / now * along);
    }
    for (std::uint32_t node = 0; node < cloth_.mass.size(); ++node)
      accelerate(node, -step_dt * gravity * std::min(double{cloth_.mass[node]}, 1.0) * Vec3d{0, 1, 0});
    if (collision) cloth_.collide(*collision, step_dt);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t node = 0; node < cloth_.mass.size(); ++node)
        cloth_.position[axis][node] += static_cast<float>(step_dt) * cloth_.velocity[axis][node];
    }
  }

 private:
  void accelerate(std::uint32_t node, const Vec3d& impulse) {
    const double inverse_mass = 1 / double{cloth_.mass[node]};
    cloth_.velocity[0][node] += static_cast<float>(inverse_mass * impulse.x);
    cloth_.velocity[1][node] += static_cast<float>(inverse_mass * impulse.y);
    cloth_.velocity[2][node] += static_cast<float>(inverse_mass * impulse.z);
  }

  LayeredCloth& cloth_;
  std::vector<Spring> springs_;
};

constexpr float node_mass = 4e-5F;  // kg: 0.4 kg/m^2 on squares of 1 cm

TEST(ClothCloth, DrapesASheetOverALayerWithFolds) {
  for (const bool on : {true, false}) {
    SCOPED_TRACE(on ? "on" : "off");
    LayeredCloth cloth;
    const auto folds = [](double row, double column) {
      return Vec3d{0.01 * column, 0.02 * std::sin(0.25 * column + 0.1 * row), -0.01 * row};
    };
    cloth.add(0, 28, 32, folds, held);
    cloth.add(1, 22, 24, level(0.025, 0.01, 0.0337, -0.0312), node_mass);
    ClothClothCollision collision = cloth.collision({.thickness = 0.003});
    FallingCloth falling(cloth, 0.01);
    std::size_t most = 0;
    for (int step = 0; step < 500; ++step) {
      falling.step(on ? &collision : nullptr, 9.81);
      if (step % 20 == 19) most = std::max(most, crossings(cloth));
    }
    if (on) {
      EXPECT_EQ(most, 0U);
      EXPECT_EQ(nodes_on_wrong_side(cloth, 0.02), 0U);
      EXPECT_GT(collision.contacts().size(), 100U);
      // It lies in the folds: its heights differ by more than half of theirs.
      const auto& height = cloth.position[1];
      const auto [low, high] = std::minmax_element(height.begin() + 28 * 32, height.end());
      EXPECT_GT(*high - *low, 0.02);
    } else {
      EXPECT_GT(most, 10U);
    }
  }
}

TEST(ClothCloth, HoldsALayerOffTheSeamOfTwoPanels) {
  // A roof of two panels that share their ridge, which is a border of both.
  LayeredCloth cloth;
  const auto roof = [](double x, double row) { return Vec3d{x, -0.3 * std::abs(x), -0.01 * row}; };
  cloth.add(
      0, 30, 17, [&](double row, double column) { return roof(-0.16 + 0.01 * column, row); }, held);
  cloth.add(
      0, 30, 17, [&](double row, double column) { return roof(0.01 * column, row); }, held);
  cloth.add(1, 22, 24, level(0.006, 0.01, -0.1133, -0.0312), node_mass);
  ClothClothCollision collision = cloth.collision({.thickness = 0.003});
  FallingCloth falling(cloth, 0.01);
  for (int step = 0; step < 400; ++step) {
    falling.step(&collision, 9.81);
    if (step % 20 == 19) {
      ASSERT_EQ(crossings(cloth), 0U) << step;
    }
  }
  EXPECT_EQ(nodes_on_wrong_side(cloth, 0.02), 0U);
  EXPECT_GT(collision.contacts().size(), 200U);
}

TEST(ClothCloth, DoesNothingBetweenPanelsOfOneLayer) {
  LayeredCloth cloth = node_over_triangle();
  cloth.set_node_velocity(over, {0, -2, 0});
  const LayeredCloth before = cloth;
  cloth.garment.panels[1].layer = 0;
  ClothClothCollision collision = cloth.collision();
  cloth.collide(collision, dt);
  EXPECT_TRUE(collision.contacts().empty());
  EXPECT_EQ(cloth.position, before.position);
  EXPECT_EQ(cloth.velocity, before.velocity);
}

TEST(ClothCloth, RefusesBadSettingsAndMasses) {
  const LayeredCloth good = node_over_triangle();
  const auto refusal = [](const LayeredCloth& cloth, const ClothClothSettings& settings) {
    return sentence_of<std::invalid_argument>([&] { cloth.collision(settings); });
  };
  EXPECT_EQ(refusal(good, {}), "");
  EXPECT_THAT(refusal(good, {.thickness = 0}), HasSubstr("the thickness in metres is 0, give"));
  EXPECT_THAT(refusal(good, {.thickness = NAN}), HasSubstr("the thickness in metres"));
  EXPECT_THAT(refusal(good, {.friction = -0.5}), HasSubstr("the friction is -0.5, give"));
  EXPECT_THAT(refusal(good, {.push_speed = INFINITY}), HasSubstr("the push speed in m/s is inf, give"));
  EXPECT_THAT(refusal(good, {.sweeps = 0}), HasSubstr("the number of sweeps is 0, give at least 1"));
  LayeredCloth weightless = good;
  weightless.mass[5] = 0;
  EXPECT_THAT(refusal(weightless, {}),
              AllOf(HasSubstr("node 5 has a mass of 0 kg"), HasSubstr("give it a positive")));
}

}  // namespace
}  // namespace mssim
