// kernels/body_contact.h: what a body does to a point of cloth, by its text in C++ and as OpenCL C.

#include "backends/devices/device_queue.h"
#include "laws/host_laws.h"
#include "tests/support/contact_fixture.h"
#include "tests/support/opencl_variants.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

constexpr double dt = 0.01;       ///< s
constexpr double push_speed = 1;  ///< m/s: 0.01 m a step
constexpr double friction = 0.5;

template <class Real>
Real to(double x) {
  return static_cast<Real>(x);
}

/// Numbers are given in double precision and computed with in Real.
template <class Real>
class BodyContactOf : public testing::Test {
 protected:
  using Planes = BodyPlanes<double>;
  using Point = ClothPoint<double>;
  using Response = ClothResponse<Real>;

  static constexpr double none = -1e30;
  /// Everything from z = -1 to z = 0.
  static constexpr Planes slab{0, 0, 1, 0, 0, 0, -1, 1};

  static ClothPoint<Real> in_real(const Point& p) {
    return {to<Real>(p.x), to<Real>(p.y), to<Real>(p.z), to<Real>(p.u), to<Real>(p.v), to<Real>(p.w)};
  }
  static BodyContact<Real> met(const Planes& planes, Real x, Real y, Real z) {
    return body_contact<Real>({to<Real>(planes.front_x), to<Real>(planes.front_y), to<Real>(planes.front_z),
                               to<Real>(planes.front_at), to<Real>(planes.back_x), to<Real>(planes.back_y),
                               to<Real>(planes.back_z), to<Real>(planes.back_at)},
                              x, y, z);
  }
  static Response after(const Planes& planes, const Point& point, double mu = friction) {
    const auto p = in_real(point);
    const Real step = to<Real>(dt);
    return body_response(p, met(planes, p.x + step * p.u, p.y + step * p.v, p.z + step * p.w), to<Real>(mu),
                         to<Real>(push_speed), step);
  }
  static void expect(const Response& got, const std::array<double, 7>& wanted) {
    const std::array<Real, 7> all{got.x, got.y, got.z, got.u, got.v, got.w, got.stuck};
    for (std::size_t i = 0; i < 7; ++i) EXPECT_NEAR(all[i], wanted[i], 4e-7) << i;
  }
};

using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(BodyContactOf, Reals);

TYPED_TEST(BodyContactOf, TheNearerPlaneDecides) {
  using Fixture = TestFixture;
  // A wedge: behind x + z = 0 and behind x - z = 0, of which x = 0, z = 0 is the edge.
  const double h = std::sqrt(0.5);
  const typename Fixture::Planes wedge{h, 0, h, 0, h, 0, -h, 0};
  const auto front = Fixture::met(wedge, -1, 5, to<TypeParam>(0.5));
  EXPECT_NEAR(front.distance, -0.5 * h, 1e-7);
  EXPECT_GT(front.z, 0.7);
  const auto back = Fixture::met(wedge, -1, 5, to<TypeParam>(-0.75));
  EXPECT_NEAR(back.distance, -0.25 * h, 1e-7);
  EXPECT_LT(back.z, -0.7);
  // Behind one of them alone is outside.
  EXPECT_NEAR(Fixture::met(wedge, 0, 0, 1).distance, h, 1e-7);
}

TYPED_TEST(BodyContactOf, WhatDoesNotComeInsideIsLeftAlone) {
  using Fixture = TestFixture;
  const typename Fixture::Planes empty{0, 0, 0, Fixture::none, 0, 0, 0, Fixture::none};
  const typename Fixture::Point point{1, 2, 0.0201, 3, -0.7, -2};
  const auto p = Fixture::in_real(point);
  for (const auto& planes : {Fixture::slab, empty}) {
    const auto after = Fixture::after(planes, point);
    EXPECT_EQ(after.x, p.x);
    EXPECT_EQ(after.y, p.y);
    EXPECT_EQ(after.z, p.z);
    EXPECT_EQ(after.u, p.u);
    EXPECT_EQ(after.v, p.v);
    EXPECT_EQ(after.w, p.w);
    EXPECT_EQ(after.stuck, 0);
  }
}

TYPED_TEST(BodyContactOf, SlidingLosesFrictionTimesWhatIsDropped) {
  using Fixture = TestFixture;
  // 1 mm above, falling with 1 m/s: 9 mm deep after the step. It stays where it is and slides on with 3 -
  // 0.5.
  Fixture::expect(Fixture::after(Fixture::slab, {0, 7, 0.001, 3, 0, -1}), {0, 7, 0.001, 2.5, 0, 0, 0});
  // Both directions alike: 5 m/s lose 0.5.
  Fixture::expect(Fixture::after(Fixture::slab, {0, 7, 0.001, 3, 4, -1}), {0, 7, 0.001, 2.7, 3.6, 0, 0});
  // Already 4 mm inside: that much is left once the fall is dropped, and is pushed out.
  Fixture::expect(Fixture::after(Fixture::slab, {0, 7, -0.004, 3, 0, -1}), {0, 7, 0, 2.5, 0, 0, 0});
  // Without friction nothing is lost.
  Fixture::expect(Fixture::after(Fixture::slab, {0, 7, 0.001, 3, 0, -1}, 0), {0, 7, 0.001, 3, 0, 0, 0});
}

TYPED_TEST(BodyContactOf, FrictionThatTakesAllOfTheVelocityHoldsThePoint) {
  using Fixture = TestFixture;
  Fixture::expect(Fixture::after(Fixture::slab, {1, 0, 0, 0.4, 0, -1}), {1, 0, 0, 0, 0, 0, 1});
  Fixture::expect(Fixture::after(Fixture::slab, {1, 0, 0, 0.6, 0, -1}), {1, 0, 0, 0.1, 0, 0, 0});
  // Straight down: held if there is any friction.
  Fixture::expect(Fixture::after(Fixture::slab, {1, 0, 0, 0, 0, -1}), {1, 0, 0, 0, 0, 0, 1});
  Fixture::expect(Fixture::after(Fixture::slab, {1, 0, 0, 0, 0, -1}, 0), {1, 0, 0, 0, 0, 0, 0});
}

TYPED_TEST(BodyContactOf, WhatLeavesKeepsItsVelocity) {
  using Fixture = TestFixture;
  // From 9 to 4 mm deep: the 4 mm are pushed out.
  Fixture::expect(Fixture::after(Fixture::slab, {0, 0, -0.009, 1, 2, 0.5}), {0, 0, -0.005, 1, 2, 0.5, 0});
  // At rest inside: no velocity comes of it.
  Fixture::expect(Fixture::after(Fixture::slab, {0, 0, -0.006, 0, 0, 0}), {0, 0, 0, 0, 0, 0, 0});
}

TYPED_TEST(BodyContactOf, ThePushIsLimited) {
  using Fixture = TestFixture;
  Fixture::expect(Fixture::after(Fixture::slab, {0, 0, -0.03, 0, 0, 0}), {0, 0, -0.02, 0, 0, 0, 0});
  // Nearer to the back it leaves there.
  Fixture::expect(Fixture::after(Fixture::slab, {0, 0, -0.97, 0, 0, 1}), {0, 0, -0.98, 0, 0, 0, 1});
}

TYPED_TEST(BodyContactOf, TheResponseFollowsTheNormal) {
  using Fixture = TestFixture;
  // A slope: 1 m/s along it (in y and down the slope), 0.5 into it, 2 mm deep before the step.
  const typename Fixture::Planes slope{0.6, 0, 0.8, 0, -0.6, 0, -0.8, 9};
  const double u = 0.8 * 0.6 - 0.6 * 0.5, w = -0.6 * 0.6 - 0.8 * 0.5;
  Fixture::expect(Fixture::after(slope, {-0.6 * 0.002, 3, -0.8 * 0.002, u, 0.8, w}),
                  {0, 3, 0, 0.75 * 0.8 * 0.6, 0.75 * 0.8, -0.75 * 0.6 * 0.6, 0});
}

TEST(BodyColumn, IsOnTheBorderBesideTheMaps) {
  const auto column = [](double x) { return body_column(x, -1.0, 10.0, 19.0); };
  EXPECT_DOUBLE_EQ(column(-0.75), 2.5);
  EXPECT_EQ(column(0.95), 19);
  for (const double far : {1.5, 1e300, double{HUGE_VAL}, std::nan("")}) EXPECT_EQ(column(far), 19);
  for (const double far : {-1.5, -1e300, -double{HUGE_VAL}}) EXPECT_EQ(column(far), 0);
}

/// Numbers of a point and of its pixel, and of the response; the kernel has each of all points side by side.
constexpr std::size_t inputs = 14, outputs = 8;
constexpr const char* kernel = R"(
__kernel void meet(__global const Real* in, __global Real* out, float friction, float push_speed, float dt) {
  size_t n = get_global_size(0), i = get_global_id(0);
  struct ClothPoint p = {in[i], in[n + i], in[2 * n + i], in[3 * n + i], in[4 * n + i], in[5 * n + i]};
  struct BodyPlanes planes = {in[6 * n + i],  in[7 * n + i],  in[8 * n + i],  in[9 * n + i],
                              in[10 * n + i], in[11 * n + i], in[12 * n + i], in[13 * n + i]};
  Real step = (Real)(dt);
  struct BodyContact met = body_contact(planes, p.x + step * p.u, p.y + step * p.v, p.z + step * p.w);
  struct ClothResponse after = body_response(p, met, (Real)(friction), (Real)(push_speed), step);
  out[i] = after.x;
  out[n + i] = after.y;
  out[2 * n + i] = after.z;
  out[3 * n + i] = after.u;
  out[4 * n + i] = after.v;
  out[5 * n + i] = after.w;
  out[6 * n + i] = after.stuck;
  out[7 * n + i] = body_column(p.x, (Real)(-0.01f), (Real)(1000.0f), (Real)(15.0f));
}
)";

class OpenclBodyContact : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(OfEachWidth, OpenclBodyContact, testing::ValuesIn(opencl_lanes),
                         [](const auto& test) { return std::to_string(test.param) + "_lanes"; });

TEST_P(OpenclBodyContact, DoesTheSame) {
  const std::size_t points = 64;
  const auto lanes = static_cast<std::size_t>(GetParam());
  std::vector<float> in(inputs * points);
  RandomPoints random;
  for (std::size_t i = 0; i < points; ++i) {
    const Vec3d x = random.point(-0.02, 0.02), v = random.point(-2, 2);
    const Vec3d front = random.direction(), back = random.direction();
    const std::array<double, inputs> numbers{x.x,     x.y,     x.z,   v.x,    v.y,    v.z,    front.x,
                                             front.y, front.z, 0.004, back.x, back.y, back.z, 0.03};
    for (std::size_t k = 0; k < inputs; ++k) in[k * points + i] = static_cast<float>(numbers[k]);
  }
  const DeviceQueue queue(first_opencl_device(), DeviceMemory::shared);
  const cl::Program program =
      queue.build(program_text(GetParam(), {"lanes.h", "node_laws.h", "spring_constants.h", "parameters.h",
                                            "body_contact.h"}) +
                  kernel);
  const auto given = queue.copy_of(std::span<const float>(in));
  const auto result = queue.zeros<float>(outputs * points);
  cl::Kernel meet(program, "meet");
  meet.setArg(0, given.buffer());
  meet.setArg(1, result.buffer());
  meet.setArg(2, to<float>(friction));
  meet.setArg(3, to<float>(push_speed));
  meet.setArg(4, to<float>(dt));
  queue.launch({meet, {cl::NDRange(points / lanes), cl::NullRange}});
  const auto out =
      result.read([](std::span<const float> all) { return std::vector(all.begin(), all.end()); });

  int inside = 0, stuck = 0;
  for (std::size_t i = 0; i < points; ++i) {
    const auto at = [&](std::size_t k) { return in[k * points + i]; };
    const ClothPoint<float> p{at(0), at(1), at(2), at(3), at(4), at(5)};
    const BodyPlanes<float> planes{at(6), at(7), at(8), at(9), at(10), at(11), at(12), at(13)};
    const auto step = to<float>(dt);
    const auto met = body_contact(planes, p.x + step * p.u, p.y + step * p.v, p.z + step * p.w);
    const auto after = body_response(p, met, to<float>(friction), to<float>(push_speed), step);
    inside += met.distance < 0;
    stuck += after.stuck > 0;
    const std::array<float, outputs> wanted{
        after.x, after.y, after.z,     after.u,
        after.v, after.w, after.stuck, body_column(p.x, -0.01F, 1000.0F, 15.0F)};
    for (std::size_t k = 0; k < outputs; ++k)
      EXPECT_NEAR(out[k * points + i], wanted[k], k == 7 ? 1e-4 : 2e-6) << i << ", " << k;
  }
  EXPECT_GT(inside, 10);
  EXPECT_LT(inside, 60);
  EXPECT_GT(stuck, 2);
}

}  // namespace
}  // namespace mssim
