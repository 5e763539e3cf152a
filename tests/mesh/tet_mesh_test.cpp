#include "mesh/meshing.h"
#include "mesh/tetgen.h"
#include "output/tables/suite_tables.h"
#include "scene/scene_file.h"
#include "tests/support/backend_checks.h"
#include "tests/support/mesh_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// Nodes - edges + faces - tetrahedra: 1 for a solid ball, 0 for a solid torus.
std::int64_t euler_characteristic(const TetMesh& mesh) {
  auto faces = faces_of(mesh);
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return static_cast<std::int64_t>(mesh.nodes.size() + faces.size()) -
         static_cast<std::int64_t>(edges_of(mesh).size() + mesh.tetrahedra.size());
}

/// Two tetrahedra that share a face.
const std::string good_nodes = "5 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 1 1 1\n";
const std::string good_tetrahedra = "2 4 0\n0 0 1 2 3\n1 1 2 3 4\n";

TetMesh parse(const std::string& nodes, const std::string& tetrahedra) {
  return parse_tetgen_files({"a.node", nodes}, {"a.ele", tetrahedra});
}

void expect_good(const TetMesh& mesh) {
  ASSERT_EQ(mesh.nodes.size(), 5U);
  EXPECT_EQ(mesh.nodes[4], (Vec3d{1, 1, 1}));
  EXPECT_THAT(mesh.tetrahedra, ElementsAre(Tetrahedron{0, 1, 2, 3}, Tetrahedron{1, 2, 3, 4}));
}

TEST(TetgenFiles, AreReadNumberedFromZero) { expect_good(parse(good_nodes, good_tetrahedra)); }

TEST(TetgenFiles, AreReadNumberedFromOneWithCommentsAttributesAndMarkers) {
  expect_good(parse(
      "# made by hand\r\n\r\n  5 3 2 1 # header\r\n1 0 0 0 .5 6 1\r\n 2\t1 0 0 .5 6 1\r\n3 0 1 0 .5 6 1\r\n"
      "4 0 0 1e0 .5 6 -1\r\n# between\r\n5 +1 1.0 1 .5 6 1",
      "2 4 1\n1 1 2 3 4 7\n\n2 2 3 4 5 7 # last\n# Generated\n"));
}

TEST(TetgenFiles, AMirroredMeshIsTurned) {
  const TetMesh mesh = parse(good_nodes, "2 4 0\n0 0 1 3 2\n1 1 2 4 3\n");
  EXPECT_THAT(mesh.tetrahedra, ElementsAre(Tetrahedron{0, 1, 2, 3}, Tetrahedron{1, 2, 3, 4}));
}

TEST(TetgenFiles, ReadBackAsTheyWereWritten) {
  TetMesh mesh = parse(good_nodes, good_tetrahedra);
  mesh.nodes[4] = {1.0 / 3, 1 + 1e-15, 1.23456789e-10};
  const TetMesh again = parse(node_text(mesh.nodes), ele_text(mesh.tetrahedra));
  EXPECT_EQ(again.nodes, mesh.nodes);
  EXPECT_EQ(again.tetrahedra, mesh.tetrahedra);
}

struct BrokenFile {
  const char* nodes;  ///< nullptr: the good ones
  const char* tetrahedra;
  const char* begin;  ///< of the message
  const char* about;  ///< in it
};

#define FOUR_NODES "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n"
#define FIVE_NODES "5 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n"

const BrokenFile broken_files[]{
    {"", nullptr, "a.node, line ", "the file ends before the number of nodes"},
    {"# only this\n", nullptr, "a.node, line 1: ", "truncated"},
    {"five 3 0 0\n", nullptr, "a.node, line 1: ", "the number of nodes is \"five\""},
    {"\x01\x7f\xff\n", nullptr, "a.node, line 1: ", "is \"\\u0001\\u007f\xef\xbf\xbd\""},
    {"0 3 0 0\n", nullptr, "a.node, line 1: ", "the number of nodes is 0"},
    {"99999999999999999999 3 0 0\n", nullptr, "a.node, line 1: ", "99999999999999999999"},
    {"9000000000000000000 3 0 0\n0 0 0 0\n", nullptr, "a.node, line 1: ", "more than a file of 34 bytes"},
    {"1 2 0 0\n", nullptr, "a.node, line 1: ", "the dimension is 2"},
    {"1 3 -1 0\n", nullptr, "a.node, line 1: ", "attributes is -1"},
    // Found by fuzzing: such a number overflowed when the others were added to it.
    {"1 3 9223372036854775807 0\n", nullptr,
     "a.node, line 1: ", "attributes is 9223372036854775807; give one from 0 to 1000"},
    {"1 3 0 1001\n", nullptr, "a.node, line 1: ", "boundary markers is 1001"},
    {FOUR_NODES, nullptr, "a.node, line 4: ", "the file ends before node 4 of 4"},
    {FOUR_NODES "3 0 0", nullptr, "a.node, line 5: ", "there are 3 numbers"},
    {FOUR_NODES "3 0 0 0 0", nullptr, "a.node, line 5: ", "there are 5 numbers"},
    {FOUR_NODES "3 0 0 x", nullptr, "a.node, line 5: ", "z is \"x\""},
    {FOUR_NODES "3 0 nan 1", nullptr, "a.node, line 5: ", "y is \"nan\""},
    {FOUR_NODES "3 -2e9 0 1", nullptr, "a.node, line 5: ", "x is \"-2e9\"; give a number from -1e9 to 1e9"},
    {FOUR_NODES "4 0 0 1", nullptr, "a.node, line 5: ", "node 4 is where node 3 is expected"},
    {FOUR_NODES "3 0 0 1\n4 1 1 1", nullptr, "a.node, line 6: ", "continues after the 4 nodes"},
    {"1 3 0 0\n7 0 0 0\n", nullptr, "a.node, line 2: ", "the first node has the number 7"},
    {FIVE_NODES "4 0 0 1\n", nullptr, "a.node, line 6: ", "another node is at (0, 0, 1)"},
    {nullptr, "1 4 0\n0 0 1 2 3\n", "a.node, line 6: ", "no tetrahedron has this node"},
    {nullptr, "", "a.ele, line ", "the file ends before the number of tetrahedra"},
    {nullptr, "0 4 0\n", "a.ele, line 1: ", "the number of tetrahedra is 0"},
    {nullptr, "4000000000 4 0\n0 0 1 2 3\n", "a.ele, line 1: ", "more than a file of 25 bytes"},
    {nullptr, "2 10 0\n", "a.ele, line 1: ", "give linear tetrahedra"},
    {nullptr, "2 4 0\n0 0 1 2 3\n", "a.ele, line 2: ", "before tetrahedron 2 of 2"},
    {nullptr, "2 4 0\n0 0 1 2 3\n1 1 2 3", "a.ele, line 3: ", "there are 4 numbers"},
    {nullptr, "2 4 0\n0 0 1 2 3\n1 1 2 3 4.5", "a.ele, line 3: ", "is \"4.5\"; give a whole number"},
    {nullptr, "2 4 0\n0 0 1 2 3\n1 1 2 3 5\n", "a.ele, line 3: ", "node 5 is not one of the nodes 0 to 4"},
    {nullptr, "2 4 0\n0 0 1 2 3\n1 1 2 3 -1\n", "a.ele, line 3: ", "node -1 is not one of"},
    {nullptr, "2 4 0\n0 0 1 2 3\n1 1 2 4 3\n", "a.ele, line 3: ", "volume is -0.33333"},
    {nullptr, "2 4 0\n0 0 1 2 2\n1 1 2 3 4\n", "a.ele, line 2: ", "it is flat"},
    {nullptr, "3 4 0\n0 0 1 2 3\n1 1 2 3 4\n2 0 1 2 3\n", "a.ele, line 4: ", "shares a face with two"},
    {nullptr, "2 4 0\n0 0 1 2 3\n1 1 2 3 4\nmore", "a.ele, line 4: ", "continues after the 2 tetrahedra"}};

TEST(TetgenFiles, ThatAreBrokenAreRefusedWithPlaceAndValue) {
  for (const auto& [nodes, tetrahedra, begin, about] : broken_files)
    EXPECT_THAT(sentence_of<InputError>(
                    [&, n = nodes, t = tetrahedra] { parse(n ? n : good_nodes, t ? t : good_tetrahedra); }),
                AllOf(StartsWith(begin), HasSubstr(about), Not(HasSubstr("\n"))));
}

TEST(TetgenFiles, OfOneEndlessLineAreRefusedBeforeItIsSplitIntoWords) {
  std::string words = "5 3 0 0\n0";
  while (words.size() <= 9 + (std::size_t{1} << 20)) words += " 1";
  EXPECT_THAT(sentence_of<InputError>([&] { parse(words, good_tetrahedra); }),
              AllOf(StartsWith("a.node, line 2: it has "), HasSubstr("break the file into lines")));
}

TEST_F(MeshTest, TetgenFilesThatAreMissingOrFoldersAreNamed) {
  put("a.node", good_nodes);
  const auto complaint = [&](const std::string& ele) {
    return sentence_of<InputError>([&] { read_tetgen_files(folder() / "a.node", folder() / ele); });
  };
  EXPECT_THAT(complaint("b.ele"), HasSubstr("b.ele: there is no such file: give the file of a mesh"));
  std::filesystem::create_directory(folder() / "c.ele");
  EXPECT_THAT(complaint("c.ele"), HasSubstr("c.ele: is not a regular file: give the file of a mesh"));
  put("d.ele", good_tetrahedra);
  expect_good(read_tetgen_files(folder() / "a.node", folder() / "d.ele"));
}

TEST(TetMesh, OfTwoTetrahedraIsCountedRight) {
  const TetMesh mesh = parse(good_nodes, good_tetrahedra);
  using Edge = std::array<std::uint32_t, 2>;
  EXPECT_THAT(edges_of(mesh), ElementsAre(Edge{0, 1}, Edge{0, 2}, Edge{0, 3}, Edge{1, 2}, Edge{1, 3},
                                          Edge{1, 4}, Edge{2, 3}, Edge{2, 4}, Edge{3, 4}));
  EXPECT_EQ(euler_characteristic(mesh), 1);
  EXPECT_DOUBLE_EQ(volume_of(mesh), 1.0 / 6 + 1.0 / 3);
}

TEST(TetMesh, TheSmallestDihedralAngleIsFoundAtWhicheverEdgeItIs) {
  // Legs of 1, 2 and 3 along the axes. Three angles are right; the large face, whose normal is (1, 1/2, 1/3)
  // of length 7/6, has those of cosines 6/7, 3/7 and 2/7 to the others. Either sense of the nodes has the
  // same angles.
  TetMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}}, {{0, 1, 2, 3}}};
  std::array<std::uint32_t, 4> order{0, 1, 2, 3};
  do {
    mesh.tetrahedra = {order};
    EXPECT_NEAR(smallest_dihedral_angle(mesh), 31.0027191, 1e-6);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(MeshDefect, OfAFlatTetrahedronIsByItsLongestEdgeCubed) {
  // Six times the volume is the height h; the longest edge is sqrt(2), so that 1e-10 of its cube
  // is 2.828e-10.
  const auto defect = [](double height, double size) {
    return find_defect({{{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, height * size}}, {{0, 1, 2, 3}}});
  };
  for (const double size : {0.01, 1.0, 30.0}) {
    EXPECT_FALSE(defect(2.84e-10, size)) << size;
    for (const double height : {2.81e-10, -2.81e-10}) {
      ASSERT_TRUE(defect(height, size)) << size;
      EXPECT_THAT(defect(height, size)->what, HasSubstr("it is flat"));
    }
    ASSERT_TRUE(defect(-2.84e-10, size)) << size;
    EXPECT_THAT(defect(-2.84e-10, size)->what, HasSubstr("in the same sense"));
  }
}

/// A body of Hong et al., Table 2: its published numbers, and the shape in its scene, whose parameters a
/// search found to give a mesh with exactly these.
class TableTwoBody : public MeshTest, public testing::WithParamInterface<const char*> {
 protected:
  TableTwoBody() {
    const auto bodies = published_bodies();
    published_ = *std::ranges::find(bodies, GetParam(), &PublishedBody::scene);
    const SceneSpec spec = find_scene(GetParam());
    shape_ = std::get<GeneratedShape>(std::get<BodiesSpec>(spec.content).list.at(0).shape);
  }
  TetMesh mesh() const { return shape_mesh(shape_); }

  PublishedBody published_;
  GeneratedShape shape_;
};

TEST_P(TableTwoBody, HasThePublishedNodesAndAThirdOfThePublishedSprings) {
  const ShapePoints points = points_of(shape_);
  const TetMesh mesh = this->mesh();
  EXPECT_EQ(mesh.nodes.size(), published_.nodes);
  EXPECT_EQ(3 * edges_of(mesh).size(), published_.springs);
  EXPECT_EQ(euler_characteristic(mesh), published_.object == "torus" ? 0 : 1);
  EXPECT_FALSE(find_defect(mesh));
  EXPECT_NEAR(volume_of(mesh), volume_of(points.surface), 1e-9 * volume_of(points.surface));

  EXPECT_EQ(point_count(shape_), published_.nodes);

  // The order of the nodes: surface points, then interior points.
  ASSERT_EQ(points.surface.points.size() + points.interior.size(), published_.nodes);
  EXPECT_TRUE(std::equal(points.surface.points.begin(), points.surface.points.end(), mesh.nodes.begin()));
  EXPECT_TRUE(std::equal(points.interior.rbegin(), points.interior.rend(), mesh.nodes.rbegin()));
}

TEST_P(TableTwoBody, HasNoVeryShortEdgesAndNoVeryFlatTetrahedra) {
  const TetMesh mesh = this->mesh();
  double shortest = 1;
  double sum = 0;
  const auto edges = edges_of(mesh);
  for (const auto& [a, b] : edges) {
    const double metres = length(mesh.nodes[a] - mesh.nodes[b]);
    shortest = std::min(shortest, metres);
    sum += metres;
  }
  const double mean = sum / static_cast<double>(edges.size());
  EXPECT_NEAR(mean, 0.02, 0.001);  // the same material in every body
  EXPECT_GT(shortest, 0.3 * mean);
  EXPECT_GT(smallest_dihedral_angle(mesh), 1.5);
}

TEST_P(TableTwoBody, HasNearlyTheVolumeOfItsShape) {
  struct Volume {
    double operator()(const BoxShape& box) const { return box.size.x * box.size.y * box.size.z; }
    double operator()(const SphereShape& sphere) const {
      return 4 * std::numbers::pi / 3 * sphere.radius_m * sphere.radius_m * sphere.radius_m;
    }
    double operator()(const TorusShape& torus) const {
      return 2 * std::numbers::pi * std::numbers::pi * torus.major_radius_m * torus.minor_radius_m *
             torus.minor_radius_m;
    }
  };
  const double volume = std::visit(Volume{}, shape_.solid);
  const double meshed = volume_of(points_of(shape_).surface);
  EXPECT_LE(meshed, volume * (1 + 1e-9));
  EXPECT_GT(meshed, 0.9 * volume);
}

INSTANTIATE_TEST_SUITE_P(HongEtAl, TableTwoBody,
                         testing::Values("box-small", "box-medium", "box-large", "sphere-small",
                                         "sphere-medium", "sphere-large", "torus-small", "torus-medium",
                                         "torus-large"),
                         ByName());

TEST(ShapeMesh, OfACoarseShapeHasAllItsPoints) {
  const GeneratedShape shape{SphereShape{0.09, 1}, {200, 1453, 0.1, 0}};
  EXPECT_EQ(shape_mesh(shape).nodes.size(), point_count(shape));
}

TEST(ShapeMesh, OfMorePointsThanTetGenMeshesIsRefusedBeforeItIsMade) {
  const auto complaint = [](const Shape& shape, const InteriorPoints& interior) {
    return sentence_of<InputError>([&] { shape_mesh({shape, interior}); });
  };
  EXPECT_THAT(complaint(BoxShape{{1, 1, 1}, {1000, 1000, 1000}}, {5}),
              StartsWith("its mesh would have 6000007 points or more, for which TetGen needs more than"));
  EXPECT_THAT(complaint(SphereShape{1, 1000}, {}), HasSubstr("10000002 points or more"));
  EXPECT_THAT(complaint(TorusShape{2, 1, 2000, 2001}, {}), HasSubstr("4002000 points or more"));
}

}  // namespace
}  // namespace mssim
