// Scenes of tetrahedral bodies: the committed ones are the paper's, and files of others are read or refused.

#include <map>

#include "application/bench/suites.h"
#include "mesh/meshing.h"
#include "mesh/tetgen.h"
#include "output/tables/suite_tables.h"
#include "output/tables/table.h"
#include "scene/builders.h"
#include "scene/fields/fields.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"
#include "tests/support/files_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

std::vector<SceneSpec> body_scenes() {
  std::vector<SceneSpec> scenes;
  for (const SceneSpec& spec : shipped_scenes())
    if (kind_of(spec).name == "bodies") scenes.push_back(spec);
  EXPECT_FALSE(scenes.empty());
  return scenes;
}

/// The nodes of one body of a system.
struct BodyNodes {
  std::size_t first, count;
};
std::vector<BodyNodes> bodies_in(const SceneSpec& spec) {
  std::vector<BodyNodes> bodies;
  std::size_t first = 0;
  for (const BodySpec& body : std::get<BodiesSpec>(spec.content).list) {
    bodies.push_back({first, least_counts(body.shape, spec.file.parent_path()).nodes});
    first += bodies.back().count;
  }
  return bodies;
}

TEST(BodyScenes, OfSeveralBodiesHaveExactlyThePublishedCounts) {
  std::set<std::tuple<std::uint64_t, std::uint64_t>> published, ours;
  const CsvTable table(source_file("results/published/hong2016_table3.csv"));
  for (std::size_t record = 0; record < table.size(); ++record)
    published.emplace(table.count(record, 2), table.count(record, 3));
  for (const SceneSpec& spec : body_scenes())
    if (std::get<BodiesSpec>(spec.content).list.size() > 1) {
      const SceneCounts counts = counts_of(spec);
      ours.emplace(counts.nodes, counts.springs_published.value());
      EXPECT_EQ(spec.name, "bodies" + std::to_string(counts.nodes));
    }
  EXPECT_EQ(published.size(), 6U);
  EXPECT_EQ(ours, published);
}

/// Bodies of Table 2, how many of each.
using BodyCounts = std::vector<std::uint64_t>;

/// Collects the ways to choose bodies from `kind` on that have these nodes and springs together, up to two.
void find_sums(const std::vector<PublishedBody>& bodies, std::size_t kind, std::uint64_t nodes,
               std::uint64_t springs, BodyCounts& chosen, std::vector<BodyCounts>& found) {
  if (kind == bodies.size()) {
    if (nodes == 0 && springs == 0) found.push_back(chosen);
    return;
  }
  const PublishedBody& body = bodies[kind];
  for (chosen[kind] = 0; found.size() < 2; ++chosen[kind]) {
    const std::uint64_t its_nodes = chosen[kind] * body.nodes, its_springs = chosen[kind] * body.springs;
    if (its_nodes > nodes || its_springs > springs) break;
    find_sums(bodies, kind + 1, nodes - its_nodes, springs - its_springs, chosen, found);
  }
  chosen[kind] = 0;
}

/// How many of each body of Table 2 a scene has.
BodyCounts bodies_of_scene(const SceneSpec& spec, const std::vector<PublishedBody>& bodies) {
  BodyCounts counts(bodies.size());
  for (const BodySpec& body : std::get<BodiesSpec>(spec.content).list) {
    const auto* of = std::get_if<ShapeOfScene>(&body.shape);
    const auto found =
        std::ranges::find(bodies, of != nullptr ? of->name : std::string(), &PublishedBody::scene);
    EXPECT_NE(found, bodies.end()) << spec.name;
    if (found != bodies.end()) ++counts[static_cast<std::size_t>(found - bodies.begin())];
  }
  return counts;
}

// The paper does not say which bodies its Table 3 has: they follow from these sums.
TEST(BodyScenes, AreTheOnlyBodiesOfTable2ThatSumUpToTable3) {
  const std::vector<PublishedBody> bodies = published_bodies();
  const std::vector<PaperScene> scenes = PublishedTable(published_table_kinds[1]).scenes();
  const std::vector<std::string> ours = scenes_of_suite("table3", true);
  ASSERT_EQ(scenes.size(), ours.size());
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    BodyCounts chosen(bodies.size());
    std::vector<BodyCounts> found;
    find_sums(bodies, 0, scenes[i].nodes, scenes[i].springs, chosen, found);
    const BodyCounts its = bodies_of_scene(find_scene(ours[i]), bodies);
    std::uint64_t nodes = 0, springs = 0;
    for (std::size_t kind = 0; kind < bodies.size(); ++kind) {
      nodes += its[kind] * bodies[kind].nodes;
      springs += its[kind] * bodies[kind].springs;
    }
    EXPECT_EQ(nodes, scenes[i].nodes) << ours[i];
    EXPECT_EQ(springs, scenes[i].springs) << ours[i];
    EXPECT_EQ(found, std::vector<BodyCounts>{its}) << ours[i];
  }
}

TEST(LeastCounts, AreTheNodesOfAMeshBeforeItIsMadeAndNoMoreThanItsSprings) {
  for (const SceneSpec& spec : body_scenes()) {
    SceneCounts least;
    for (const BodySpec& body : std::get<BodiesSpec>(spec.content).list) {
      const SceneCounts counts = least_counts(body.shape, spec.file.parent_path());
      least.nodes += counts.nodes;
      least.springs_unique += counts.springs_unique;
    }
    const SceneCounts counts = counts_of(spec);
    EXPECT_EQ(least.nodes, counts.nodes) << spec.name;
    EXPECT_LE(least.springs_unique, counts.springs_unique) << spec.name;
    EXPECT_GT(4 * least.springs_unique, counts.springs_unique) << spec.name;
  }
}

TEST(BodyScenes, AreBuiltAsStatedAndCounted) {
  for (const SceneSpec& spec : body_scenes()) {
    const SceneCounts counts = counts_of(spec);
    EXPECT_EQ(counts.springs_published, 3 * counts.springs_unique) << spec.name;
    const auto stated = stated_counts(spec);
    ASSERT_TRUE(stated) << spec.name;
    EXPECT_EQ(stated->nodes, counts.nodes) << spec.name;
    EXPECT_EQ(stated->springs_unique, counts.springs_unique) << spec.name;
    const System system = build_system(spec);
    EXPECT_EQ(system.nodes(), counts.nodes) << spec.name;
    EXPECT_EQ(system.springs.size(), counts.springs_unique) << spec.name;
    EXPECT_EQ(system.node_mass.size(), counts.nodes) << spec.name;
    for (const Spring& spring : system.springs) {
      const Vec3d d = system.start.position[spring.second] - system.start.position[spring.first];
      ASSERT_NEAR(length(d), static_cast<double>(spring.rest_length), 1e-6) << spec.name;
    }
  }
}

TEST(BodyScenes, StartApartAboveTheFloorAndEachInAWayOfItsOwn) {
  for (const SceneSpec& spec : body_scenes()) {
    const System system = build_system(spec);
    const auto& list = std::get<BodiesSpec>(spec.content).list;
    const std::vector<BodyNodes> bodies = bodies_in(spec);
    std::vector<double> radius, drop;
    for (std::size_t i = 0; i < list.size(); ++i) {
      double farthest = 0, lowest = 1e9;
      for (std::size_t node = bodies[i].first; node < bodies[i].first + bodies[i].count; ++node) {
        farthest = std::max(farthest, length(system.start.position[node] - list[i].centre_m));
        lowest = std::min(lowest, system.start.position[node].y);
        EXPECT_GT(length(system.start.velocity[node]), 0) << spec.name << " node " << node;
      }
      radius.push_back(farthest);
      drop.push_back(lowest - spec.floor.height);
      EXPECT_GT(drop[i], 0.02) << spec.name << " body " << i;
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GT(length(list[i].centre_m - list[j].centre_m), radius[i] + radius[j] + 0.05)
            << spec.name << ": bodies " << i << " and " << j << " are near each other";
        EXPECT_GT(std::abs(drop[i] - drop[j]), 1e-3) << spec.name << ' ' << i << ' ' << j;
        EXPECT_GT(length(list[i].spin_rad_per_s - list[j].spin_rad_per_s), 0.1)
            << spec.name << ' ' << i << ' ' << j;
      }
    }
  }
}

/// A tetrahedron with legs of 3 cm in a folder of its own, and a scene of it.
class BodiesFile : public TemporaryFolderTest {
 protected:
  BodiesFile() {
    put("one.node", node_text({{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, 0, 3}}));
    put("one.ele", ele_text({{0, 1, 2, 3}}));
  }

  std::filesystem::path scene(const std::string& text) const { return put("scene.json", text); }
  static std::string error_of(const std::filesystem::path& file) {
    return sentence_of<SceneError>([&] { build_system(load_scene(file)); });
  }

  /// The good scene with a body of another shape.
  std::string with_shape(const std::string& kind, const std::string& object) const {
    return with_change(with_change(good_, "\"tetgen\",", '"' + kind + "\","),
                       R"("tetgen": {"node_file": "one.node", "ele_file": "one.ele", "unit_m": 0.01})",
                       '"' + kind + "\": " + object);
  }

  const std::string good_ = R"({
  "kind": "bodies", "description": "one tetrahedron", "dt_s": 1e-4, "gravity_m_per_s2": 9.81,
  "viscous_damping_per_s": 0, "floor": {"height_m": 0, "restitution": 0.5, "friction": 0.4},
  "bodies": {
    "density_kg_per_m3": 1000,
    "springs": {"stiffness_n_per_m": 100, "damping_n_s_per_m": 0.1},
    "list": [{
      "shape": "tetgen",
      "tetgen": {"node_file": "one.node", "ele_file": "one.ele", "unit_m": 0.01},
      "centre_m": [1, 2, 3],
      "turn": {"axis": [0, 0, 0.5], "angle_deg": 90},
      "velocity_m_per_s": [0.5, 0, 0],
      "spin_rad_per_s": [0, 2, 0],
      "swell_per_s": 3
    }]
  }
})";
};

TEST_F(BodiesFile, BuildsABodyThatIsTurnedFliesSpinsAndSwells) {
  const SceneSpec spec = load_scene(scene(good_));
  const System system = build_system(spec);
  ASSERT_EQ(system.nodes(), 4U);
  EXPECT_EQ(system.springs.size(), 6U);
  ASSERT_TRUE(std::holds_alternative<TetrahedralMesh>(system.topology));
  EXPECT_EQ(std::get<TetrahedralMesh>(system.topology).tetrahedra.size(), 1U);
  // The centre of the four is at 0.75 cm in each direction; node 1 lies at (2.25, -0.75, -0.75) cm from it,
  // and a quarter turn about z makes (0.75, 2.25, -0.75) cm of that.
  const Vec3d r{0.0075, 0.0225, -0.0075};
  const Vec3d x = system.start.position[1] - Vec3d{1, 2, 3};
  EXPECT_NEAR(length(x - r), 0, 1e-6);
  // v = (0.5, 0, 0) + (0, 2, 0) x r + 3 r
  const Vec3d v{0.5 + 2 * r.z + 3 * r.x, 3 * r.y, -2 * r.x + 3 * r.z};
  EXPECT_NEAR(length(system.start.velocity[1] - v), 0, 1e-6);
  for (const double mass : system.node_mass) EXPECT_NEAR(mass, 1000 * 27e-6 / 6 / 4, 1e-12);
  std::multiset<float> lengths;
  for (const Spring& spring : system.springs) lengths.insert(spring.rest_length);
  EXPECT_EQ(lengths.count(0.03F), 3U);
  EXPECT_NEAR(*lengths.rbegin(), 0.03 * std::sqrt(2), 1e-8);
  EXPECT_FALSE(stated_counts(spec));
  EXPECT_EQ(counts_of(spec).springs_published, 18U);
}

TEST_F(BodiesFile, MayStateItsSizeWhichIsComparedNotBelieved) {
  const std::string stated =
      with_change(good_, R"("unit_m": 0.01)", R"("unit_m": 0.01, "expected": {"nodes": 5, "springs": 7})");
  const SceneSpec spec = load_scene(scene(stated));
  ASSERT_TRUE(stated_counts(spec));
  EXPECT_EQ(stated_counts(spec)->springs_unique, 7U);
  EXPECT_EQ(counts_of(spec).springs_unique, 6U);
}

TEST_F(BodiesFile, NamesTheBodyWhoseMeshHasAnotherSizeThanIsStated) {
  put("one.node", node_text({{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, 0, 3}, {3, 3, 3}}));
  put("one.ele", ele_text({{0, 1, 2, 3}, {1, 2, 3, 4}}));
  const std::size_t begin = good_.find("{\n      \"shape\""), end = good_.find("]\n  }\n}");
  const std::string body = good_.substr(begin, end - begin);
  const auto note_of_bodies_stating = [&](const std::vector<std::string>& sizes) {
    std::string bodies;
    for (const std::string& size : sizes)
      bodies +=
          (bodies.empty() ? "" : ", ") + with_change(body, R"("unit_m": 0.01)", R"("unit_m": 0.01)" + size);
    return build_scene(load_scene(scene(with_change(good_, body, bodies)))).note;
  };
  const std::string right = R"(, "expected": {"nodes": 5, "springs": 9})",
                    less = R"(, "expected": {"nodes": 4, "springs": 8})",
                    more = R"(, "expected": {"nodes": 6, "springs": 10})";
  EXPECT_EQ(note_of_bodies_stating({right, ""}), "");
  const auto tells_of = [](const char* place, const char* stated) {
    return AllOf(HasSubstr(place), HasSubstr("5 nodes and 9 springs"), HasSubstr(stated));
  };
  EXPECT_THAT(note_of_bodies_stating({less, ""}), tells_of("/bodies/list/0 ", "4 and 8"));
  EXPECT_THAT(note_of_bodies_stating({"", right, more}), tells_of("/bodies/list/2 ", "6 and 10"));
  // Their sums are right.
  EXPECT_THAT(note_of_bodies_stating({less, more}),
              AllOf(tells_of("/bodies/list/0 ", "4 and 8"), HasSubstr("2 bodies")));
}

TEST_F(BodiesFile, TakesTheShapeOfAnotherScene) {
  const auto other = scene(with_shape("scene", R"({"name": "box-small"})"));
  EXPECT_EQ(counts_of(load_scene(other)).nodes, counts_of(find_scene("box-small")).nodes);
}

TEST_F(BodiesFile, FillsASurfaceWithTetrahedra) {
  put("cube.obj",
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const System system = build_system(load_scene(scene(
      with_shape("surface", R"({"file": "cube.obj", "unit_m": 0.1, "largest_tetrahedron_m3": 2e-6})"))));
  const auto& tetrahedra = std::get<TetrahedralMesh>(system.topology).tetrahedra;
  EXPECT_GE(tetrahedra.size(), 500U);
  EXPECT_NEAR(volume_of({system.start.position, tetrahedra}), 1e-3, 1e-7);
}

struct BadBodies {
  const char *old_part, *new_part, *place, *problem;
};

const BadBodies bad_bodies[]{
    {"\"tetgen\",", "\"tetrahedron\",", "/bodies/list/0/shape",
     "is the text \"tetrahedron\": give the text box"},
    {"\"tetgen\",", "\"box\",", "/bodies/list/0/tetgen", "is not a known key"},
    {"\"tetgen\": {", "\"box\": {", "/bodies/list/0/box", "is not a known key"},
    {"\"shape\": \"tetgen\",", "", "/bodies/list/0/shape", "is missing"},
    {"[1, 2, 3]", "[1, 2]", "/bodies/list/0/centre_m", "is a list: give a list of three numbers"},
    {"[1, 2, 3]", "[1, \"2\", 3]", "/bodies/list/0/centre_m/1", "is the text \"2\": give a number"},
    {"[1, 2, 3]", "[1, 2e7, 3]", "/bodies/list/0/centre_m/1", "is 20000000.0"},
    {"[1, 2, 3]", "[1, 0.005, 3]", "/bodies/list/0/centre_m/1", "not above the floor at 0: raise it"},
    {"[1, 2, 3]", "[-1e6, 2, 3]", "/bodies/list/0/centre_m", "start at the same place in single precision"},
    {"\"unit_m\": 0.01", "\"unit_m\": 1e-12", "/bodies/list/0",
     "has a spring of 3e-12 m: springs are from 1e-07 to 1000000 m long"},
    {"[0, 0, 0.5]", "[0, 0, 0]", "/bodies/list/0/turn/axis", "has no direction"},
    {"[{\n", "[{}, {\n", "/bodies/list/0/shape", "is missing"},
    {"[{\n", "[5, {\n", "/bodies/list/0", "is 5: give an object"},
    {"\"swell_per_s\": 3", "\"swel_per_s\": 3", "/bodies/list/0/swel_per_s", "did you mean \"swell_per_s\"?"},
    {"\"one.node\"", "\"two.node\"", "/bodies/list/0", "two.node"},
    // The name of a file may hold what a terminal would obey.
    {"\"one.node\"", "\"two\\u007f\\u009b31m.node\"", "/bodies/list/0",
     "two\\u007f\\u009b31m.node: there is no such file"},
    {"\"one.ele\"", "\"one.node\"", "/bodies/list/0", "one.node"},
    {"\"density_kg_per_m3\": 1000", "\"density_kg_per_m3\": 0", "/bodies/density_kg_per_m3", "is 0"}};

TEST_F(BodiesFile, ThatIsBrokenIsRefusedInOneSentenceWithItsPlace) {
  for (const auto& [old_part, new_part, place, problem] : bad_bodies) {
    const std::filesystem::path file = scene(with_change(good_, old_part, new_part));
    EXPECT_THAT(error_of(file),
                AllOf(HasSubstr(file.string()), HasSubstr(place), HasSubstr(problem), Not(HasSubstr("\n"))))
        << new_part;
  }
}

TEST_F(BodiesFile, OfAShapeOutOfRangeIsRefused) {
  struct BadShape {
    const char *kind, *good, *bad, *problem;
  };
  const std::string interior = R"("interior": {"points": 10, "seed": 1, "jitter": 0.1, "margin": 0.5}})";
  const std::map<std::string, std::string> objects{
      {"box", R"({"size_m": [1, 1, 1], "cells_x": 2, "cells_y": 2, "cells_z": 2, )" + interior},
      {"sphere", R"({"radius_m": 1, "frequency": 2, )" + interior},
      {"torus",
       R"({"major_radius_m": 2, "minor_radius_m": 1, "cells_around": 4, "cells_across": 3, )" + interior},
      {"surface", R"({"file": "a.obj", "unit_m": 1, "largest_tetrahedron_m3": 0})"}};
  for (const auto& [kind, good, bad, problem] : std::to_array<BadShape>({
           {"box", "\"cells_y\": 2", "\"cells_y\": 0", "box/cells_y is 0: give an integer from 1 to 1000"},
           {"box", "\"points\": 10", "\"points\": 2000000",
            "points is 2000000: give an integer from 0 to 1000000"},
           {"box", "\"jitter\": 0.1", "\"jitter\": 0.6", "jitter is 0.6: give a number from 0 to 0.5"},
           {"box", "\"margin\": 0.5", "\"margin\": -1", "margin is -1: give a number from 0 to 1"},
           {"sphere", "\"frequency\": 2", "\"frequency\": 0",
            "frequency is 0: give an integer from 1 to 1000"},
           {"torus", "\"cells_across\": 3", "\"cells_across\": 2",
            "cells_across is 2: give an integer from 3"},
           {"torus", "\"cells_around\": 4", "\"cells_around\": 3",
            "cells_around is 3: give an integer from 4"},
           {"torus", "\"cells_around\": 4", "\"cells_around\": 5", "are 5, an odd number"},
           {"surface", "\"unit_m\": 1", "\"unit_m\": 0", "unit_m is 0: give a number above 0"},
           {"surface", "_m3\": 0", "_m3\": -1", "largest_tetrahedron_m3 is -1: give a number from 0"},
       }))
    EXPECT_THAT(error_of(scene(with_shape(kind, with_change(objects.at(kind), good, bad)))),
                HasSubstr(problem));
}

TEST_F(BodiesFile, MayTurnAboutAnAxisOfAnyLength) {
  const System usual = build_system(load_scene(scene(good_)));
  const System shorter = build_system(load_scene(scene(with_change(good_, "[0, 0, 0.5]", "[0, 0, 1e-300]"))));
  EXPECT_EQ(shorter.start.position, usual.start.position);
}

TEST_F(BodiesFile, WithoutAListIsRefused) {
  const std::size_t begin = good_.find("[{"), end = good_.find("}]");
  std::string text = good_;
  text.replace(begin, end + 2 - begin, "[]");
  EXPECT_THAT(error_of(scene(text)),
              AllOf(HasSubstr("/bodies/list has 0 elements: give a list"), HasSubstr("1 to 10000")));
  text = good_;
  text.replace(begin, end + 2 - begin, "7");
  EXPECT_THAT(error_of(scene(text)), HasSubstr("/bodies/list is 7: give a list"));
}

TEST_F(BodiesFile, CannotTakeTheShapeOfAnythingElse) {
  const auto with_name = [&](const std::string& name) {
    return scene(with_shape("scene", R"({"name": ")" + name + "\"}"));
  };
  EXPECT_THAT(error_of(with_name("cloth2500")), HasSubstr("cloth2500\" has no bodies"));
  EXPECT_THAT(error_of(with_name("bodies4737")), HasSubstr("takes its shape from another scene"));
  EXPECT_THAT(error_of(with_name("box-smal")),
              AllOf(HasSubstr("/bodies/list/0 has no mesh"), HasSubstr("did you mean box-small?")));
}

}  // namespace
}  // namespace mssim
