#include "mesh/surface_file.h"

#include <bit>

#include "geometry/geometry.h"
#include "mesh/meshing.h"
#include "tests/support/mesh_fixture.h"
#include "tests/support/obj_text.h"
#include "tests/support/testing.h"
#include "text/text.h"

namespace mssim {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

const std::string obj_points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
const std::string obj_tetrahedron = obj_points + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

Surface obj(std::string_view text) { return parse_obj("a.obj", text); }

TEST(ObjFile, PointsAndTrianglesAreRead) {
  const Surface surface = obj(obj_tetrahedron);
  EXPECT_EQ(surface.points.size(), 4U);
  EXPECT_NEAR(volume_of(surface), 1.0 / 6, 1e-15);
  EXPECT_EQ(sentence_of<InputError>([&] { validate_surface(surface, "a.obj"); }), "");
}

TEST(ObjFile, AllFormsOfCornersAndLinesAreRead) {
  const Surface surface = obj(
      "# cube side\r\nmtllib a.mtl\r\no a\r\nv 0 0 0 1.0\r\nv 1 0 0 .5 .5 .5\r\nvt 0 0\r\nvn 0 0 1\r\nv 1 1 "
      "0\r\n"
      "g g1\r\nusemtl m\r\ns off\r\nv 0 1 0\r\nf 1/1/1 2//1 3/1 -1 # quad\r\nf -4//-1 -3/-1/-1 5\r\nv 2 2 2");
  EXPECT_THAT(surface.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 1, 4}));
  EXPECT_EQ(surface.points[4], (Vec3d{2, 2, 2}));
}

TEST(ObjFile, LinesGoOnAfterABackslash) {
  const Surface plain = obj(obj_tetrahedron);
  const Surface surface =
      obj("# C:\\\nv 0 0\\\n0\nv 1 \\ \r\n 0 0\nv 0 1 0\nv 0 0 1\ng a \\\nf 1 2\nf "
          "1\\\r3\\\r\n2\nf 1 2 4 \\\n\nf 2 3 4\nf \\\n1 4 \\ # c\n3\n");
  EXPECT_EQ(surface.points, plain.points);
  EXPECT_EQ(surface.triangles, plain.triangles);
}

TEST(ObjFile, LinesMayEndInCrAlone) {
  std::string text = obj_tetrahedron;
  std::ranges::replace(text, '\n', '\r');
  EXPECT_EQ(obj(text).triangles, obj(obj_tetrahedron).triangles);
}

using Outline = std::vector<std::array<double, 2>>;

/// The file of one polygon, in a plane that is askew to all axes.
Surface polygon(const Outline& outline, std::size_t first) {
  std::string text, face = "f";
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto [x, y] = outline[(first + i) % outline.size()];
    const Vec3d p = 1.0 / 3 * (x * Vec3d{1, 2, 2} + y * Vec3d{2, 1, -2}) + Vec3d{5, -7, 3};
    text += "v " + decimal(p.x) + ' ' + decimal(p.y) + ' ' + decimal(p.z) + '\n';
    face += ' ' + std::to_string(i + 1);
  }
  return obj(text + face + '\n');
}

TEST(ObjFile, ConcavePolygonsAreCutInTheirPlane) {
  Outline comb{{6, 2}, {0, 2}};  // its teeth point down
  for (double x = 0; x < 6; x += 2) comb.insert(comb.end(), {{x, 0}, {x + 1, 0}, {x + 1, 1}, {x + 2, 1}});
  Outline spiral{{0, 0}, {5, 0}, {5, 5}, {1, 5}, {1, 2}, {3, 2},
                 {3, 3}, {2, 3}, {2, 4}, {4, 4}, {4, 1}, {0, 1}};
  struct Case {
    Outline outline;
    double area;
  };
  for (const auto& [outline, area] :
       {Case{{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 3}, Case{{{0, 0}, {2, 1}, {4, 0}, {2, 4}}, 6},
        Case{{{0, 0}, {1, 0}, {1, 2}, {2, 2}, {2, 0}, {3, 0}, {3, 3}, {0, 3}}, 7}, Case{comb, 9},
        Case{spiral, 15},
        // A square with a corner on a side, and one with a hole that a cut leads to.
        Case{{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}, 4},
        Case{{{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}}, 8}})
    for (std::size_t first = 0; first < outline.size(); ++first) {
      const Surface surface = polygon(outline, first);
      ASSERT_EQ(surface.triangles.size(), outline.size() - 2);
      double sum = 0;
      for (const auto& [a, b, c] : surface.triangles) {
        const Vec3d normal =
            0.5 * cross(surface.points[b] - surface.points[a], surface.points[c] - surface.points[a]);
        EXPECT_LT(dot(normal, {2, -2, 1}), 0) << "all look to where the polygon does";
        sum += length(normal);
      }
      EXPECT_NEAR(sum, area, 1e-12 * area) << outline.size() << " corners from " << first;
    }
}

TEST(ObjFile, QuadranglesThatAreBentOrHaveACornerTwiceAreCut) {
  // Seen along its normal its edges cross, and they pass each other.
  EXPECT_THAT(obj("v 0 0 0\nv 1 1 0\nv 1 0 1\nv 0 1 1.1\nf 1 2 3 4\n").triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
  EXPECT_THAT(obj(obj_points + "v 1 0 0\nf 1 2 5 3\nf 4 2 3 4\n").triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{3, 1, 2}));
}

TEST(ObjFile, LinesThatAreNoGeometryAreLeftOut) {
  const Surface plain = obj(obj_tetrahedron);
  const Surface surface =
      obj("# a scan\nmtllib a.mtl\no body\ncstype bezier\ncurv2 1 2 \\\n3 4\ntrace_obj a\nTexture 1 2\n" +
          obj_points +
          "vt 0 0 0\nvn nan nan nan\nvp 1\ng a b\ns 1\nusemtl skin\nlod 2\n"
          "p 1\nl 1 2 \xe9\nf 1 3 2\nf 1 2 4\ncall more.obj\nf 2 3 4\nf 1 4 3\nend\n");
  EXPECT_EQ(surface.points, plain.points);
  EXPECT_EQ(surface.triangles, plain.triangles);
}

TEST(ObjFile, AByteOrderMarkIsLeftOut) {
  const std::string mark = "\xef\xbb\xbf";
  EXPECT_EQ(obj(mark + obj_tetrahedron).triangles.size(), 4U);
  EXPECT_THAT(sentence_of<InputError>([&] { obj(mark + "v 0 0 o\n"); }),
              StartsWith("a.obj, line 1: z is \"o\""));
  EXPECT_THAT(sentence_of<InputError>([&] { obj(obj_points + "f 1 2 " + mark + "3\n"); }),
              HasSubstr("cannot be read"))
      << "elsewhere it is no mark";
}

TEST(ObjFile, PointsAtOnePlaceBecomeOne) {
  const Surface surface = obj(obj_points + "v -0 0 0\nf 5 3 2\nf 1 2 4\n");
  EXPECT_THAT(surface.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
}

struct BrokenText {
  const char* text;
  const char* begin;
  const char* about;
};

const BrokenText broken_obj_files[]{
    {"", "a.obj, line ", "without an f line"},
    {"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "a.obj, line 3: ", "without an f line"},
    {"v 0 0 0\nv 1 0\n", "a.obj, line 2: ", "z is missing"},
    {"v 0 0 zero\n", "a.obj, line 1: ", "z is \"zero\""},
    {"v 0 0 inf\n", "a.obj, line 1: ", "z is \"inf\""},
    // It had an infinite volume.
    {"v 0 0 1e150\n", "a.obj, line 1: ", "give a number from -1e9 to 1e9"},
    {"v 0 0 0\nf 1 1\n", "a.obj, line 2: ", "the face has 2 corners"},
    {"v 0 0 0\nf\n", "a.obj, line 2: ", "the face has 0 corners"},
    {"v 0 0 0\nf 1 1 2\n", "a.obj, line 2: ", "vertex 2 of 1"},
    {"v 0 0 0\nf 1 1 0\n", "a.obj, line 2: ", "\"0\" of a face names no vertex"},
    {"v 0 0 0\nf 1 1 -2\n", "a.obj, line 2: ", "\"-2\" of a face names no vertex"},
    {"v 0 0 0\nf 1 1 1/2/3/4\n", "a.obj, line 2: ", "\"1/2/3/4\""},
    {"v 0 0 0\nf 1 1 1/\n", "a.obj, line 2: ", "\"1/\""},
    {"v 0 0 0\nf 1 1 1//\n", "a.obj, line 2: ", "\"1//\""},
    {"v 0 0 0\nf 1 1 x\n", "a.obj, line 2: ", "\"x\" of a face cannot be read"},
    {"v 0 0 0\nf 1 1 99999999999999999999\n", "a.obj, line 2: ", "cannot be read"},
    {"v 0 0 0\r\nf 1 1\\\r\n1\rf 1 1 2\n", "a.obj, line 4: ", "vertex 2 of 1"},
    {"v 0 0 0\nf 1 \\\n1 \\\n2\n", "a.obj, line 2: ", "vertex 2 of 1"},
    {"v 0 0 0\nf 1 1 \\", "a.obj, line 2: ", "the face has 2 corners"},
    {"v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3 4\n",
     "a.obj, line 6: ", "4 corners crosses itself; cut it into triangles"},
    {"v 0 3 0\nv 2 -3 0\nv -3 1 0\nv 3 1 0\nv -2 -3 0\nf 1 2 3 4 5\n",
     "a.obj, line 6: ", "5 corners crosses itself"},
    // Once round its first corner and further.
    {"v 0 0 0\nv 1 0 0\nv 0.34 1.05 0\nv -0.97 0.71 0\nv -1.05 -0.76 0\nv 0.43 "
     "-1.33 0\nv 1.5 0 0\nv 0.49 1.52 0\nf 1 2 3 4 5 6 7 8\n",
     "a.obj, line 9: ", "8 corners crosses itself"},
    {"PK\x03\x04\n", "a.obj, line 1: ", "without an f line; give an OBJ file"},
    // Bytes that are not UTF-8 went into the message where char has no sign (arm64).
    {"v 0 0 \xff\n", "a.obj, line 1: ", "z is \"\xef\xbf\xbd\""}};

TEST(ObjFile, ThatIsBrokenIsRefusedWithPlaceAndValue) {
  for (const auto& [text, begin, about] : broken_obj_files)
    EXPECT_THAT(sentence_of<InputError>([text = text] { obj(text); }),
                AllOf(StartsWith(begin), HasSubstr(about), Not(HasSubstr("\n"))));
}

/// An ASCII STL file of the tetrahedron above.
std::string ascii_stl() {
  const Surface surface = obj(obj_tetrahedron);
  std::string text = "solid a tetrahedron\n";
  for (const Triangle& triangle : surface.triangles) {
    text += " facet normal nan 0 0\n  outer loop\n";
    for (const std::uint32_t point : triangle) {
      const Vec3d& p = surface.points[point];
      text +=
          "   vertex " + std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' + std::to_string(p.z) + '\n';
    }
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid a\n";
}

void append_little_endian(std::string& bytes, std::uint32_t number) {
  for (int i = 0; i < 4; ++i, number >>= 8) bytes += static_cast<char>(number & 255);
}

/// A binary one; its first bytes mislead, as those of real files do.
std::string binary_stl(float first_x = 0) {
  const Surface surface = obj(obj_tetrahedron);
  std::string bytes = "solid but binary";
  bytes.resize(80, ' ');
  append_little_endian(bytes, static_cast<std::uint32_t>(surface.triangles.size()));
  for (const Triangle& triangle : surface.triangles) {
    bytes.append(12, '\0');
    for (const std::uint32_t point : triangle) {
      const Vec3d& p = surface.points[point];
      for (const double x : {p.x, p.y, p.z})
        append_little_endian(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(x)));
    }
    bytes.append(2, '\0');
  }
  bytes.replace(96, 4, "");
  std::string x;
  append_little_endian(x, std::bit_cast<std::uint32_t>(first_x));
  return bytes.insert(96, x);
}

TEST(StlFile, AsciiAndBinaryGiveTheSameSurface) {
  for (const std::string& content : {ascii_stl(), binary_stl()}) {
    const Surface surface = parse_stl("a.stl", content);
    EXPECT_EQ(surface.points.size(), 4U);
    EXPECT_NEAR(volume_of(surface), 1.0 / 6, 1e-15);
    EXPECT_EQ(sentence_of<InputError>([&] { validate_surface(surface, "a.stl"); }), "");
  }
}

TEST(StlFile, KeywordsMayBeInCapitalsOrApartAndLinesEndInAnyWay) {
  const auto replace_all = [](std::string& text, const std::string& old, const std::string& next) {
    for (std::size_t at = 0; (at = text.find(old, at)) != std::string::npos; at += next.size())
      text.replace(at, old.size(), next);
  };
  for (const char* end : {"\r\n", "\r", "\n"}) {
    std::string text = ascii_stl();
    replace_all(text, "end", "end ");  // endfacet and others
    replace_all(text, "\n", end);
    std::ranges::transform(text, text.begin(), [](char c) { return static_cast<char>(std::toupper(c)); });
    EXPECT_EQ(parse_stl("a.stl", text).triangles.size(), 4U);
  }
}

TEST(StlFile, AByteOrderMarkIsLeftOut) {
  EXPECT_EQ(parse_stl("a.stl", "\xef\xbb\xbf" + ascii_stl()).triangles.size(), 4U);
}

TEST(StlFile, CutOffAnywhereIsRefused) {
  for (const std::string& content : {ascii_stl(), binary_stl()})
    for (std::size_t bytes = 0; bytes + sizeof "endsolid a" < content.size(); bytes += 7)
      EXPECT_THAT(sentence_of<InputError>([&] { parse_stl("a.stl", content.substr(0, bytes)); }),
                  StartsWith("a.stl"))
          << bytes << " bytes";
}

TEST(StlFile, BrokenBinaryNamesTheByte) {
  const auto complaint = [](const std::string& content) {
    return sentence_of<InputError>([&] { parse_stl("a.stl", content); });
  };
  EXPECT_THAT(complaint(binary_stl(NAN)), StartsWith("a.stl, byte 96: a corner is at (nan, 0, 0)"));
  EXPECT_THAT(complaint(binary_stl(-2e9F)), HasSubstr("for each axis give a number from -1e9 to 1e9"));
  EXPECT_THAT(complaint(binary_stl().substr(0, 280)),
              StartsWith("a.stl, byte 80: the file announces 4 triangles in 284 bytes, and has 280"));
  EXPECT_EQ(parse_stl("a.stl", binary_stl() + "\r\n").triangles.size(), 4U);
  EXPECT_THAT(complaint(binary_stl() + std::string(50, '\0')),
              StartsWith("a.stl, byte 80: the file announces 4 triangles in 284 bytes, and 50 bytes follow"));
  std::string absurd = binary_stl();
  absurd.replace(80, 4, "\xff\xff\xff\xff");
  EXPECT_THAT(complaint(absurd), HasSubstr("announces 4294967295 triangles"));
  EXPECT_THAT(complaint(binary_stl().substr(0, 80) + std::string(4, '\0')), HasSubstr("has no triangles"));
  EXPECT_THAT(complaint(std::string(10, '\0')), HasSubstr("has 10 bytes"));
  EXPECT_THAT(complaint(""), HasSubstr("is empty"));
}

const BrokenText broken_stl_files[]{
    {"hello\n", "a.stl, line 1: ", "\"hello\" where \"solid\" is expected"},
    {"solid a\nend of it\n", "a.stl, line 2: ", "\"end\" where \"endsolid\" is expected"},
    {"solid a\nendsolid a\n", "a.stl, line 2: ", "no facets"},
    {"solid a\nfacet\nouter\n", "a.stl, line 3: ", "where \"outer loop\" is expected"},
    {"solid a\nfacet\nouter loop\nvertex 0 0\n", "a.stl, line 4: ", "z is missing"},
    {"solid a\nfacet\nouter loop\nvertex 0 0 o\n", "a.stl, line 4: ", "z is \"o\""},
    {"solid a\nfacet\nouter loop\nvertex 0 0 0\nendloop\n",
     "a.stl, line 5: ", "where \"vertex\" is expected"}};

TEST(StlFile, ThatIsBrokenIsRefusedWithPlaceAndValue) {
  for (const auto& [text, begin, about] : broken_stl_files)
    EXPECT_THAT(sentence_of<InputError>([text = text] { parse_stl("a.stl", text); }),
                AllOf(StartsWith(begin), HasSubstr(about)));
}

using SurfaceFile = MeshTest;

TEST_F(SurfaceFile, IsReadByItsExtension) {
  put("a.OBJ", obj_tetrahedron);
  put("a.stl", binary_stl());
  put("a.ply", "");
  EXPECT_EQ(read_surface(folder() / "a.OBJ").surface.triangles.size(), 4U);
  EXPECT_EQ(read_surface(folder() / "a.stl").surface.triangles.size(), 4U);
  EXPECT_THAT(sentence_of<InputError>([&] { read_surface(folder() / "a.ply"); }),
              HasSubstr("ends in neither .obj nor .stl"));
  EXPECT_THAT(sentence_of<InputError>([&] { read_surface(folder() / "b.obj"); }),
              HasSubstr("b.obj: there is no such file"));
}

TEST_F(SurfaceFile, IsMeshedInItsUnitAndNotTooCoarsely) {
  put("a.obj", obj_tetrahedron);
  const TetMesh coarse = surface_mesh({folder() / "a.obj", 0.001, 0});
  EXPECT_NEAR(volume_of(coarse), 1e-9 / 6, 1e-18);
  const TetMesh fine = surface_mesh({folder() / "a.obj", 0.001, 2e-12});
  for (const auto& [a, b, c, d] : fine.tetrahedra)
    EXPECT_LE(six_volumes(fine.nodes[a], fine.nodes[b], fine.nodes[c], fine.nodes[d]), 6 * 2e-12);
  EXPECT_NEAR(volume_of(fine), 1e-9 / 6, 1e-18);
}

TEST_F(SurfaceFile, OfASheetThatIsTooThinToBeMeshedIsRefused) {
  const auto sheet = [&](double thickness) {
    Surface box = unit_cube();
    for (Vec3d& p : box.points) p.y *= thickness;
    return put("sheet.obj", obj_text(box));
  };
  EXPECT_THAT(sentence_of<InputError>([&] { surface_mesh({sheet(0.0001)}); }),
              AllOf(HasSubstr("sheet.obj: it is 0.0001 m thick at (0."), HasSubstr("at most 4000000"),
                    HasSubstr("thicker")));
  // What is foreseen of the other is what comes.
  EXPECT_NEAR(static_cast<double>(surface_mesh({sheet(0.03)}).nodes.size()), 0.5 * 2 / (0.03 * 0.03), 200);
}

TEST_F(SurfaceFile, OfAThickBodyFarFromTheOriginIsMeshed) {
  const auto file = put("far.obj", obj_text(unit_cube({9e8, -9e8, 9e8})));
  EXPECT_EQ(surface_mesh({file}).nodes.size(), 8U);
}

TEST_F(SurfaceFile, ThatEnclosesNoBodyIsNamed) {
  put("open.obj", obj_points + "f 1 3 2\nf 1 2 4\nf 2 3 4\n");
  EXPECT_THAT(sentence_of<InputError>([&] { surface_mesh({folder() / "open.obj"}); }),
              HasSubstr("open.obj: the edge from "));
  put("a.obj", obj_tetrahedron);
  EXPECT_THAT(sentence_of<InputError>([&] {
                surface_mesh({folder() / "a.obj", 1, 1e-12});
              }),
              HasSubstr("more than ten million"));
}

}  // namespace
}  // namespace mssim
