#include "geometry/surface.h"

#include "garment/body/mannequin.h"
#include "geometry/triangle_tree.h"
#include "mesh/meshing.h"
#include "tests/support/mesh_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

std::string surface_complaint(const Surface& surface) {
  return sentence_of<InputError>([&] { validate_surface(surface, "cube"); });
}

TEST(Surface, ClosedSurfacesAreAccepted) {
  EXPECT_EQ(surface_complaint(unit_cube()), "");
  EXPECT_EQ(surface_complaint(both(unit_cube(), unit_cube({2, 0, 0}))), "");
}

TEST(Surface, TheVolumeIsTheEnclosedOne) {
  EXPECT_NEAR(volume_of(unit_cube({1000, 0, 0})), 1, 1e-12);
  EXPECT_NEAR(volume_of(both(unit_cube(), unit_cube({2, 0, 0}))), 2, 1e-12);
}

TEST(Surface, AHoleIsNamedByItsEdge) {
  Surface surface = unit_cube();
  surface.triangles.pop_back();
  EXPECT_THAT(surface_complaint(surface),
              AllOf(StartsWith("cube: the edge from (0, 1, 1) to (0, 0, 1) belongs to one triangle"),
                    HasSubstr("close the hole")));
}

TEST(Surface, AnEdgeOfManyTrianglesIsRefused) {
  Surface surface = unit_cube();
  surface.points.push_back({2, 2, 2});
  surface.triangles.push_back({surface.triangles[0][0], surface.triangles[0][1], 8});
  EXPECT_THAT(surface_complaint(surface), HasSubstr("belongs to 3 triangles"));
}

TEST(Surface, ATriangleTurnedRoundIsRefused) {
  Surface surface = unit_cube();
  std::swap(surface.triangles[4][0], surface.triangles[4][1]);
  EXPECT_THAT(surface_complaint(surface), HasSubstr("in the same direction; turn one of them round"));
}

TEST(Surface, ASurfaceThatPointsInwardsIsRefused) {
  Surface surface = unit_cube();
  for (auto& triangle : surface.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_THAT(surface_complaint(surface), HasSubstr("encloses a volume of -1 m^3; reverse its triangles"));
}

TEST(Surface, BadPointsAndTrianglesAreNamed) {
  Surface surface = unit_cube();
  surface.points[3].y = std::numeric_limits<double>::infinity();
  EXPECT_THAT(surface_complaint(surface), HasSubstr("point 3 (from 0) has the coordinates"));

  surface = unit_cube();
  surface.triangles[2][1] = 8;
  EXPECT_THAT(surface_complaint(surface),
              HasSubstr("triangle 2 (from 0) names point 8 but there are only 8"));

  surface = unit_cube();
  surface.triangles[2][1] = surface.triangles[2][0];
  EXPECT_THAT(surface_complaint(surface), HasSubstr("has no area"));

  surface = unit_cube();
  surface.points.push_back({7, 8, 9});
  EXPECT_THAT(surface_complaint(surface), HasSubstr("the point (7, 8, 9) belongs to no triangle"));

  EXPECT_THAT(surface_complaint({}), HasSubstr("no triangles"));
}

TEST(Surface, GeneratedSurfacesAreClosedAndNearlyFillTheirShape) {
  const double pi = std::numbers::pi;
  const Surface box = surface_of(BoxShape{{0.1, 0.2, 0.3}, {2, 3, 4}});
  EXPECT_EQ(box.points.size(), 2U * (2 * 3 + 3 * 4 + 4 * 2) + 2);
  EXPECT_NEAR(volume_of(box), 0.1 * 0.2 * 0.3, 1e-12);

  const Surface sphere = surface_of(SphereShape{0.5, 7});
  EXPECT_EQ(sphere.points.size(), 10U * 7 * 7 + 2);
  EXPECT_NEAR(volume_of(sphere), 4 * pi / 3 * 0.125, 0.01);
  for (const Vec3d& point : sphere.points) EXPECT_NEAR(dot(point, point), 0.25, 1e-6);

  const Surface torus = surface_of(TorusShape{0.3, 0.1, 40, 15});
  EXPECT_EQ(torus.points.size(), 40U * 15);
  EXPECT_NEAR(volume_of(torus), 2 * pi * pi * 0.3 * 0.01, 0.003);

  for (const Surface& surface : {box, sphere, torus}) EXPECT_EQ(surface_complaint(surface), "");
}

TEST(Surface, CoordinatesAreWholeMicrometres) {
  const Surface sphere = surface_of(SphereShape{0.1234567, 3});
  ASSERT_FALSE(sphere.points.empty());
  for (const Vec3d& point : sphere.points)
    for (const double coordinate : {point.x, point.y, point.z})
      EXPECT_EQ(coordinate, std::round(coordinate * 1e6) / 1e6);
}

TEST(Surface, ShapesThatCannotBeAreRefused) {
  const auto complaint_about = [](const auto& shape) {
    return sentence_of<InputError>([&] { surface_of(shape); });
  };
  EXPECT_THAT(complaint_about(BoxShape{{1, 0, 1}, {1, 1, 1}}),
              HasSubstr("size along y is 0 m; give a length"));
  EXPECT_THAT(complaint_about(BoxShape{{1, 1, std::nan("")}, {1, 1, 1}}), HasSubstr("size along z is nan m"));
  EXPECT_THAT(complaint_about(SphereShape{-1, 3}), HasSubstr("radius is -1 m"));
  EXPECT_THAT(complaint_about(TorusShape{0.3, 0.3, 10, 8}), HasSubstr("leaves no hole"));
  EXPECT_THAT(complaint_about(TorusShape{0.3, 0.1, 11, 8}), HasSubstr("an odd number"));
}

TEST(InteriorPoints, ExactlySoManyLieInsideAndAwayFromTheSurface) {
  const SphereShape sphere{0.5, 4};
  for (const std::uint32_t count : {1U, 100U, 777U})
    for (const std::uint32_t seed : {1U, 2U}) {
      const std::vector<Vec3d> points = points_of({sphere, {count, seed, 0.2, 0.6}}).interior;
      ASSERT_EQ(points.size(), count);
      // The spacing is less than that of the sphere's whole volume, and cannot be less than half of it here.
      const double spacing = std::cbrt(volume_of(surface_of(sphere)) / count);
      for (const Vec3d& point : points) EXPECT_GT(sphere.radius_m - length(point), 0.6 * spacing / 2);
    }
}

bool is_inside(const BoxShape& box, const Vec3d& point) {
  return std::abs(point.x) < box.size.x / 2 && std::abs(point.y) < box.size.y / 2 &&
         std::abs(point.z) < box.size.z / 2;
}

// A lattice over the whole cube around it would have billions of cells.
TEST(InteriorPoints, LieInARod) {
  const BoxShape rod{{2, 0.002, 0.002}, {500, 1, 1}};
  const std::vector<Vec3d> points = points_of({rod, {400, 1, 0.1, 0.6}}).interior;
  ASSERT_EQ(points.size(), 400U);
  std::set<int> tenths;
  for (const Vec3d& point : points) {
    EXPECT_TRUE(is_inside(rod, point));
    tenths.insert(static_cast<int>(std::floor(5 * (point.x + 1))));
  }
  EXPECT_EQ(tenths.size(), 10U) << "all along the rod";
}

// The planes of a lattice over a rope have billions of lines.
TEST(InteriorPoints, LieInARope) {
  const BoxShape rope{{1000, 0.01, 0.01}, {1000, 1, 1}};
  const std::vector<Vec3d> points = points_of({rope, {1000, 1453, 0.1, 0.05}}).interior;
  ASSERT_EQ(points.size(), 1000U);
  for (const Vec3d& point : points) EXPECT_TRUE(is_inside(rope, point));
}

TEST(InteriorPoints, LieInTheTrianglesOfACoarseShape) {
  const std::array<Shape, 4> shapes{SphereShape{0.09, 1}, SphereShape{0.09, 2}, TorusShape{0.3, 0.1, 4, 3},
                                    TorusShape{0.3, 0.1, 10, 5}};
  for (const Shape& shape : shapes)
    for (const double margin : {0.0, 0.3}) {
      const ShapePoints points = points_of({shape, {200, 1453, 0.5, margin}});
      ASSERT_EQ(points.interior.size(), 200U);
      const TriangleTree triangles(points.surface);
      for (const Vec3d& point : points.interior) EXPECT_EQ(triangles.winding_by_angles(point), 1);
    }
}

TEST(InteriorPoints, TooDenseForMicrometresAreRefused) {
  const auto complaint = [](const Shape& shape, std::uint32_t count) {
    return sentence_of<InputError>([&] { points_of({shape, {count, 1, 0.1, 0.6}}); });
  };
  const auto tells =
      AllOf(HasSubstr(" m apart"), HasSubstr("larger body"), HasSubstr("fewer cells or points"));
  EXPECT_THAT(complaint(SphereShape{1e-4, 40}, 10), tells);
  EXPECT_THAT(complaint(BoxShape{{1, 1, 1e-4}, {1, 1, 100}}, 0), AllOf(HasSubstr("1e-06"), tells));
  EXPECT_THAT(complaint(TorusShape{2e-4, 1e-4, 100, 100}, 0), tells);
  EXPECT_THAT(complaint(BoxShape{{1e-4, 1e-4, 1e-4}, {1, 1, 1}}, 10'000), tells);
}

TEST(InteriorPoints, FollowFromTheSeedAlone) {
  const BoxShape box{{1, 1, 1}, {3, 3, 3}};
  const auto points = [&](std::uint32_t seed) { return points_of({box, {50, seed, 0.2, 0.6}}).interior; };
  EXPECT_EQ(points(5), points(5));
  EXPECT_NE(points(5), points(6));
}

/// A sphere of radius 1 without the triangles that lie wholly above `height`, on one of the two sides.
Surface open_sphere(double height, double sign = 1) {
  Surface surface = surface_of(SphereShape{1, 12});
  std::erase_if(surface.triangles, [&](const auto& triangle) {
    return std::ranges::all_of(triangle,
                               [&](std::uint32_t p) { return sign * surface.points[p].y > height; });
  });
  // Points of no triangle go, as a file's reader would have it.
  Surface used;
  PointNumbers<std::uint32_t> numbers(used);
  for (auto& triangle : surface.triangles)
    for (std::uint32_t& point : triangle) point = numbers.of(point, [&] { return surface.points[point]; });
  used.triangles = surface.triangles;
  return used;
}

TEST(Openings, AClosedSurfaceHasNone) {
  EXPECT_THAT(openings_of(mannequin({}, 16)), IsEmpty());
  Surface body = unit_cube();
  EXPECT_THAT(close_openings(body, 1), IsEmpty());
  EXPECT_EQ(body.triangles, unit_cube().triangles);
}

TEST(Openings, AreMeasuredAndTheLargestComesFirst) {
  Surface surface = both(open_sphere(0.95), open_sphere(0.8, -1));
  const std::vector<Opening> openings = openings_of(surface);
  ASSERT_EQ(openings.size(), 2U);
  EXPECT_TRUE(openings[0].is_ring);
  EXPECT_GT(openings[0].edges(), openings[1].edges());
  EXPECT_NEAR(openings[0].centre.x, 0, 0.02);
  EXPECT_NEAR(openings[0].centre.y, -0.78, 0.06);
  EXPECT_NEAR(openings[0].size, 2 * 0.65, 0.15);
  EXPECT_NEAR(openings[1].centre.y, 0.92, 0.04);
}

TEST(Openings, ThatAreClosedLeaveASurfaceThatEnclosesTheVolume) {
  Surface surface = open_sphere(0.95);
  const double whole = volume_of(surface_of(SphereShape{1, 12}));
  EXPECT_EQ(close_openings(surface, 1).size(), 1U);
  EXPECT_EQ(sentence_of<InputError>([&] { validate_surface(surface, "sphere"); }), "");
  EXPECT_THAT(openings_of(surface), IsEmpty());
  EXPECT_LT(volume_of(surface), whole);
  EXPECT_GT(volume_of(surface), 0.98 * whole);
}

TEST(Openings, ThatAreSpannedGetNoNewPointsAndFollowTheirRing) {
  // A strip from nearly pole to pole: a fan's middle lies deep within the sphere.
  Surface surface = surface_of(SphereShape{1, 12});
  const double whole = volume_of(surface);
  std::erase_if(surface.triangles, [&](const auto& triangle) {
    return std::ranges::all_of(triangle, [&](std::uint32_t corner) {
      const Vec3d& p = surface.points[corner];
      return p.z > 0 && std::abs(p.x) < 0.35 && std::abs(p.y) < 0.85;
    });
  });
  ASSERT_EQ(openings_of(surface).size(), 1U);
  Surface spanned = surface, with_middle = surface;
  span_openings(spanned);
  close_openings(with_middle, 2);
  EXPECT_EQ(spanned.points, surface.points);
  EXPECT_EQ(spanned.triangles.size(), surface.triangles.size() + openings_of(surface).front().edges() - 2);
  EXPECT_THAT(openings_of(spanned), IsEmpty());
  EXPECT_LT(whole - volume_of(spanned), 0.5 * (whole - volume_of(with_middle)));
}

TEST(Openings, AreNotSpannedByAnEdgeThatTheSurfaceHas) {
  // A roof whose short ridge would also be the shortest edge across what is open below it.
  Surface roof{{{-0.2, 0, 0}, {0.2, 0, 0}, {0, -0.3, 1}, {0, -0.3, -1}}, {{0, 2, 1}, {0, 1, 3}}};
  span_openings(roof);
  EXPECT_EQ(sentence_of<InputError>([&] { validate_surface(roof, "roof"); }), "");
  EXPECT_EQ(roof.triangles.size(), 4U);
}

TEST(Openings, AMissingTriangleIsPutBack) {
  const Surface whole = surface_of(SphereShape{1, 4});
  Surface surface = whole;
  surface.triangles.pop_back();
  EXPECT_EQ(close_openings(surface, 1).front().edges(), 3U);
  EXPECT_EQ(surface.points, whole.points);
  EXPECT_NEAR(volume_of(surface), volume_of(whole), 1e-12);
  EXPECT_EQ(sentence_of<InputError>([&] { validate_surface(surface, "sphere"); }), "");
}

TEST(Openings, ThatTouchInAPointAreToldApart) {
  // Two opposite triangles of the four that meet in the middle of a side of the cube.
  Surface cube = surface_of(BoxShape{{1, 1, 1}, {2, 2, 2}});
  const auto middle = std::ranges::find_if(
      cube.points, [](const Vec3d& p) { return std::abs(p.x) < 1e-9 && std::abs(p.z) < 1e-9 && p.y > 0.4; });
  const auto top = static_cast<std::uint32_t>(middle - cube.points.begin());
  std::vector<std::size_t> around;
  for (std::size_t t = 0; t < cube.triangles.size(); ++t)
    if (std::ranges::find(cube.triangles[t], top) != cube.triangles[t].end()) around.push_back(t);
  ASSERT_GE(around.size(), 4U);
  const auto share_an_edge = [&](std::size_t a, std::size_t b) {
    return std::ranges::count_if(cube.triangles[a], [&](std::uint32_t p) {
             return std::ranges::find(cube.triangles[b], p) != cube.triangles[b].end();
           }) == 2;
  };
  const auto other = std::find_if(around.begin() + 1, around.end(),
                                  [&](std::size_t t) { return !share_an_edge(around[0], t); });
  ASSERT_NE(other, around.end());
  cube.triangles.erase(cube.triangles.begin() + static_cast<std::ptrdiff_t>(*other));
  cube.triangles.erase(cube.triangles.begin() + static_cast<std::ptrdiff_t>(around[0]));
  const std::vector<Opening> openings = close_openings(cube, 2);
  ASSERT_EQ(openings.size(), 2U);
  for (const Opening& opening : openings) EXPECT_EQ(opening.edges(), 3U);
  EXPECT_EQ(sentence_of<InputError>([&] { validate_surface(cube, "cube"); }), "");
  EXPECT_NEAR(volume_of(cube), 1, 1e-12);
}

TEST(Openings, LargeOnesAreRefusedAndNothingIsFilled) {
  Surface surface = open_sphere(0.5);
  const std::size_t before = surface.triangles.size();
  EXPECT_THAT(
      sentence_of<InputError>([&] { close_openings(surface, 0.2); }),
      AllOf(StartsWith("the opening of "), HasSubstr(" edges around ("), HasSubstr(" is 1.7"),
            HasSubstr(" m across, and at most 0.2 m are closed; close it where the surface was made")));
  EXPECT_EQ(surface.triangles.size(), before);
}

TEST(Openings, TrianglesThatDisagreeMakeNoRing) {
  Surface surface = open_sphere(0.95);
  const Opening ring = openings_of(surface).front();
  for (auto& triangle : surface.triangles)
    if (std::ranges::find(triangle, ring.points[0]) != triangle.end() &&
        std::ranges::find(triangle, ring.points[1]) != triangle.end())
      std::swap(triangle[1], triangle[2]);
  EXPECT_FALSE(openings_of(surface).front().is_ring && openings_of(surface).back().is_ring);
  EXPECT_THAT(sentence_of<InputError>([&] { close_openings(surface, 1); }),
              HasSubstr("does not enclose a hole"));
}

TEST(Openings, OfManyPointsAreMeasuredFromTheirCentre) {
  constexpr std::uint32_t corners = 4000;
  Surface disc{{{0, 0, 0}}, {}};
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    disc.points.push_back({std::cos(angle), std::sin(angle), 0});
    disc.triangles.push_back({0, 1 + i, 1 + (i + 1) % corners});
  }
  const std::vector<Opening> openings = openings_of(disc);
  ASSERT_EQ(openings.size(), 1U);
  EXPECT_NEAR(openings[0].size, 2, 1e-9);
}

TEST(Openings, OfNoSurfaceAtAllDoNoHarm) {
  Surface triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  EXPECT_EQ(close_openings(triangle, 2).size(), 1U);
  const Surface three_four_five{{{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}};
  EXPECT_DOUBLE_EQ(openings_of(three_four_five).front().size, 5);
  EXPECT_THAT(sentence_of<InputError>([&] { validate_surface(triangle, "it"); }), HasSubstr("volume"));
  Surface point{{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}}};
  EXPECT_THAT(close_openings(point, 1), IsEmpty());
  Surface nothing;
  EXPECT_THAT(close_openings(nothing, 1), IsEmpty());
}

/// Every triangle with corners of its own, each off by up to `jitter` along every axis.
Surface apart(const Surface& surface, double jitter) {
  Surface loose;
  std::mt19937 random(1);
  const auto off = [&] { return jitter * (2 * static_cast<double>(random()) / 4294967295.0 - 1); };
  for (const auto& triangle : surface.triangles) {
    const auto first = static_cast<std::uint32_t>(loose.points.size());
    for (const std::uint32_t point : triangle)
      loose.points.push_back(surface.points[point] + Vec3d{off(), off(), off()});
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  return loose;
}

Surface slab(double thickness) {
  Surface flat = unit_cube();
  for (Vec3d& point : flat.points) point.y *= thickness;
  return flat;
}

TEST(JoinedCorners, ThatDifferInTheirLastDigitsBecomeOne) {
  // A body, and one that is thinner than what is merged, whose two sides stay apart.
  for (const auto& [whole, jitter] : {std::pair{surface_of(SphereShape{1, 12}), 0.0},
                                      {surface_of(SphereShape{1, 12}), 3e-6},
                                      {mannequin({}, 24), 1e-6},
                                      {slab(5e-6), 2e-8}}) {
    Surface loose = apart(whole, jitter);
    EXPECT_EQ(join_corners(loose), 3 * whole.triangles.size() - whole.points.size());
    EXPECT_EQ(loose.points.size(), whole.points.size());
    EXPECT_EQ(sentence_of<InputError>([&] { validate_surface(loose, "joined"); }), "");
    EXPECT_NEAR(volume_of(loose) / volume_of(whole), 1, 0.05);
  }
}

TEST(JoinedCorners, OfWhatIsClosedOrOpenOrFartherApartStayAsTheyAre) {
  for (const Surface& surface :
       {slab(1e-6), both(unit_cube(), unit_cube({1 + 1e-6, 0, 0})), open_sphere(0.5), Surface{}}) {
    Surface same = surface;
    EXPECT_EQ(join_corners(same), 0U);
    EXPECT_EQ(same.points, surface.points);
    EXPECT_EQ(sentence_of<InputError>([&] { require_joined(same); }), "");
  }
  const Surface whole = surface_of(SphereShape{1, 12});
  Surface loose = apart(whole, 1e-3);
  join_corners(loose);
  const auto says_so = AllOf(HasSubstr("triangles do not join: "), HasSubstr("merge the points"));
  EXPECT_THAT(sentence_of<InputError>([&] { require_joined(loose); }), says_so);
  EXPECT_THAT(sentence_of<InputError>([&] { close_openings(loose, 1); }), says_so)
      << "they would be closed one by one";
  EXPECT_THAT(sentence_of<InputError>([&] { validate_surface(loose, "a"); }), says_so);
}

}  // namespace
}  // namespace mssim
