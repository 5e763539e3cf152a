#include "garment/body/mannequin.h"
#include "garment/body/stance.h"
#include "mesh/meshing.h"
#include "tests/support/body_with_arms.h"
#include "tests/support/testing.h"
#include "text/error.h"

namespace mssim {
namespace {

/// The points of `body`, which stands as patterns need it, as a file of this stance has them.
Surface laid_out(Surface body, const BodyStance& stance) {
  const Vec3d up = direction_of(stance.up), ahead = direction_of(stance.facing), left = cross(up, ahead);
  for (Vec3d& point : body.points) {
    const Vec3d p = 1 / stance.unit_m * (point - stance.move);
    point = p.x * left + p.y * up + p.z * ahead;
  }
  return body;
}

/// 1.48 m high.
const Surface& form() {
  static const Surface body = mannequin({}, 48);
  return body;
}

class EachStance : public testing::TestWithParam<std::tuple<LengthUnit, UpAxis, Facing>> {};

TEST_P(EachStance, IsFound) {
  const auto& [unit, up, facing] = GetParam();
  if (!is_level(facing, up)) return;
  const BodyStance stance{unit.metres, up, facing, 0, {0.3, -0.12, 4}};
  const Surface file = laid_out(form(), stance);
  const StanceGuess guess = guess_stance(file, {});
  EXPECT_THAT(guess.doubts, IsEmpty());
  EXPECT_EQ(guess.stance.unit_m, unit.metres);
  EXPECT_EQ(guess.stance.up, up);
  EXPECT_EQ(guess.stance.facing, facing);
  const Surface found = stood_up(file, guess.stance);
  // In depth it stands in the middle, wherever the form does.
  double depth = 0;
  for (std::size_t p = 0; p < found.points.size(); ++p) {
    EXPECT_NEAR(found.points[p].x, form().points[p].x, 1e-4);
    EXPECT_NEAR(found.points[p].y, form().points[p].y, 1e-4);
    depth += found.points[p].z - form().points[p].z;
  }
  EXPECT_NEAR(depth / static_cast<double>(found.points.size()), found.points[0].z - form().points[0].z, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Stances, EachStance,
                         testing::Combine(testing::ValuesIn(length_units().begin(), length_units().end()),
                                          testing::Values(UpAxis::y, UpAxis::z),
                                          testing::Values(Facing::plus_x, Facing::minus_x, Facing::plus_y,
                                                          Facing::minus_y, Facing::plus_z, Facing::minus_z)));

TEST(StanceGuess, ArmsThatAreHeldSidewaysAreNoUprightAxis) {
  PersonForm form;
  form.triangles = 4'000;
  form.arm_angle_degrees = 88;
  for (const bool z_up : {false, true})
    for (const double degrees : {0.0, 90.0}) {
      const StanceGuess guess = guess_stance(posed(body_with_arms(form), {1, degrees, {}, z_up}), {});
      const Facing ahead = z_up ? Facing::minus_y : Facing::plus_z;
      EXPECT_EQ(guess.stance.up, z_up ? UpAxis::z : UpAxis::y);
      EXPECT_EQ(guess.stance.facing, degrees == 0 ? ahead : Facing::plus_x);
      EXPECT_THAT(guess.doubts, IsEmpty());
    }
}

TEST(StanceGuess, ABodyThatLooksBetweenTheAxesIsTurned) {
  PersonForm form;
  form.triangles = 4'000;
  const Surface person = body_with_arms(form);
  for (const double degrees : {-44.0, -20.0, 37.0, 135.0, 200.0, 300.0}) {
    const StanceGuess guess = guess_stance(posed(person, {1, degrees, {0.1, 0, 2}, degrees > 0}), {});
    SCOPED_TRACE(degrees);
    EXPECT_THAT(guess.doubts,
                ElementsAre(AllOf(StartsWith("facing: its legs are oblique"), HasSubstr("give --facing"))));
    const Surface found = stood_up(posed(person, {1, degrees, {0.1, 0, 2}, degrees > 0}), guess.stance);
    for (std::size_t p = 0; p < found.points.size(); p += 100) {
      EXPECT_NEAR(found.points[p].x, person.points[p].x, 0.02);
      EXPECT_NEAR(found.points[p].z - found.points[0].z, person.points[p].z - person.points[0].z, 0.03);
    }
  }
  const Surface askew = posed(person, {1, 30, {}, false});
  const StanceGuess given = guess_stance(askew, {{}, {}, Facing::plus_z});
  EXPECT_EQ(given.stance.turn_deg, 0);
  EXPECT_THAT(given.doubts, ElementsAre(HasSubstr("30 degrees off the axis; turn_deg")));
}

TEST(StanceGuess, WhatIsGivenIsKept) {
  const StanceGuess guess = guess_stance(form(), {0.001, UpAxis::y, Facing::minus_z});
  EXPECT_EQ(guess.stance.unit_m, 0.001);
  EXPECT_EQ(guess.stance.facing, Facing::minus_z);
  EXPECT_THAT(guess.doubts, ElementsAre(StartsWith("unit: the body is 0.0015 m high")));
  EXPECT_EQ(guess_stance(form(), {{}, {}, Facing::minus_z}).stance.up, UpAxis::y);
  EXPECT_EQ(guess_stance(laid_out(form(), {1, UpAxis::z, Facing::plus_x, 0, {}}), {{}, UpAxis::z, {}})
                .stance.facing,
            Facing::plus_x);
}

TEST(StanceGuess, WhatCannotBeIsRefused) {
  EXPECT_THAT(sentence_of<InputError>([] {
                guess_stance(form(), {{}, UpAxis::y, Facing::plus_y});
              }),
              HasSubstr("it cannot look along y, which is its upright axis"));
  Surface lying = form();
  for (Vec3d& point : lying.points) point = {point.y, -point.x, point.z};
  EXPECT_THAT(sentence_of<InputError>([&] { guess_stance(lying, {}); }),
              HasSubstr("upright neither in y nor in z; turn it"));
  Surface huge = form();
  for (Vec3d& point : huge.points) point = 300.0 * point;
  EXPECT_THAT(sentence_of<InputError>([&] { guess_stance(huge, {}); }),
              HasSubstr("give the unit with --unit"));
  EXPECT_EQ(guess_stance(huge, {0.1, {}, {}}).stance.unit_m, 0.1);
}

TEST(StanceGuess, WhatIsNotCertainIsSaid) {
  Surface child = form();
  for (Vec3d& point : child.points) point = 0.7 * point;
  EXPECT_THAT(guess_stance(child, {}).doubts, ElementsAre(StartsWith("unit: in m the body is 1.0388 m")));
  // Half a turn about x = z = 0 of the lower legs: the toes point to both sides.
  Surface undecided = form();
  for (Vec3d& point : undecided.points)
    if (point.x < 0) point.z = -point.z;
  EXPECT_THAT(guess_stance(undecided, {}).doubts,
              ElementsAre(StartsWith("facing: its feet reach about as far")));
  const Surface box = surface_of(BoxShape{{0.4, 1.7, 0.3}, {2, 4, 2}});
  EXPECT_THAT(guess_stance(box, {}).doubts,
              ElementsAre(StartsWith("up and facing: it has no two legs"), StartsWith("facing: its feet")));
}

TEST(LengthUnits, APersonIsOneInOneUnitAlone) {
  for (const LengthUnit& unit : length_units())
    for (double height = shortest_person; height <= tallest_person; height += 0.01) {
      const auto guess = guess_unit(height / unit.metres);
      ASSERT_TRUE(guess && guess->certain) << unit.name << ' ' << height;
      EXPECT_EQ(guess->unit.name, unit.name) << height;
    }
  EXPECT_FALSE(guess_unit(2.5)->certain);
  // In centimetres 1.495 times the tallest person, and 1.505 times.
  EXPECT_EQ(guess_unit(329)->unit.name, "cm");
  EXPECT_FALSE(guess_unit(331));
  EXPECT_FALSE(guess_unit(0));
  EXPECT_FALSE(guess_unit(std::nan("")));
}

}  // namespace
}  // namespace mssim
