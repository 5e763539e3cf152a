#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "output/tables/table.h"
#include "scene/builders.h"
#include "scene/fields/fields.h"
#include "scene/scene_file.h"
#include "scene/scene_kinds.h"
#include "scene/spec/scene_spec.h"
#include "tests/support/address_space.h"
#include "tests/support/files_fixture.h"
#include "tests/support/systems.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

using nlohmann::json;

using Size = std::pair<std::uint64_t, std::uint64_t>;  // nodes, published springs

std::set<Size> published_sizes() {
  std::set<Size> sizes;
  const CsvTable table(source_file("results/published/hong2016_table1.csv"));
  for (std::size_t record = 0; record < table.size(); ++record)
    sizes.emplace(table.count(record, 2), table.count(record, 3));
  return sizes;
}

std::vector<SceneSpec> cloth_scenes() {
  std::vector<SceneSpec> scenes;
  for (const SceneSpec& spec : shipped_scenes())
    if (kind_of(spec).name == "cloth") scenes.push_back(spec);
  EXPECT_FALSE(scenes.empty());
  return scenes;
}

/// Those that are not another one, so many times as wide (cloth10k-x4).
std::vector<SceneSpec> cloths_of_their_own() {
  std::vector<SceneSpec> scenes = cloth_scenes();
  std::erase_if(scenes, [](const SceneSpec& spec) { return spec.name.find("-x") != std::string::npos; });
  return scenes;
}

/// Those that a test may build: the others take gigabytes, and differ in rows and columns alone.
std::vector<SceneSpec> cloth_scenes_to_build() {
  constexpr std::uint64_t most_nodes = 1'000'000;
  std::vector<SceneSpec> scenes = cloth_scenes();
  std::erase_if(scenes, [](const SceneSpec& spec) { return counts_of(spec).nodes > most_nodes; });
  return scenes;
}

TEST(ClothScenes, HaveExactlyTheNodesAndSpringsOfTheSixPublishedOnesAndThreeAreLarger) {
  std::set<Size> ours, larger;
  for (const SceneSpec& spec : cloths_of_their_own()) {
    const SceneCounts counts = counts_of(spec);
    EXPECT_EQ(counts.springs_published, 2 * counts.springs_unique);
    (counts.nodes < 1'000'000 ? ours : larger).emplace(counts.nodes, counts.springs_published.value());
  }
  EXPECT_EQ(ours.size(), 6U);
  EXPECT_EQ(ours, published_sizes());
  EXPECT_EQ(larger,
            (std::set<Size>{{1'000'000, 11'980'004}, {4'000'000, 47'960'004}, {16'000'000, 191'920'004}}));
}

/// The fields of a cloth's file but what it says of its size.
json without_size(const SceneSpec& spec) {
  json fields = json::parse(spec.source);
  fields.erase("description");
  fields.at("cloth").erase("rows");
  fields.at("cloth").erase("columns");
  return fields;
}

TEST(ClothScenes, ThatAreLargerThanTheLargestPublishedOneDifferFromItInRowsAndColumnsAlone) {
  const SceneSpec published = find_scene("cloth350k");
  for (const SceneSpec& spec : cloths_of_their_own())
    if (counts_of(spec).nodes > counts_of(published).nodes) {
      EXPECT_EQ(without_size(spec), without_size(published)) << spec.name;
    }
}

TEST(ClothScenes, ThatAreSoManyTimesAsWideDifferInColumnsAlone) {
  int wide = 0;
  for (const SceneSpec& spec : cloth_scenes()) {
    const std::size_t mark = spec.name.find("-x");
    if (mark == std::string::npos) continue;
    ++wide;
    const SceneSpec base = find_scene(spec.name.substr(0, mark));
    const auto times = static_cast<std::uint32_t>(std::stoul(spec.name.substr(mark + 2)));
    const ClothSpec &cloth = std::get<ClothSpec>(spec.content), &narrow = std::get<ClothSpec>(base.content);
    EXPECT_EQ(cloth.rows, narrow.rows) << spec.name;
    EXPECT_EQ(cloth.columns, times * narrow.columns) << spec.name;
    EXPECT_EQ(without_size(spec), without_size(base)) << spec.name;
  }
  EXPECT_GT(wide, 0);
}

TEST(ClothScenes, AreBuiltAsCountedAndStartInMotionAndStrainedByAFewPercentAtMost) {
  for (const SceneSpec& spec : cloth_scenes_to_build()) {
    const std::string& name = spec.name;
    const System system = build_system(spec);
    EXPECT_EQ(system.nodes(), counts_of(spec).nodes) << name;
    EXPECT_EQ(system.springs.size(), counts_of(spec).springs_unique) << name;
    std::set<std::uint32_t> pins(system.pins.begin(), system.pins.end());
    EXPECT_GT(pins.size(), 1U) << name;
    double slowest = 1;
    for (std::uint32_t node = 0; node < system.nodes(); ++node) {
      const Vec3d& v = system.start.velocity[node];
      if (pins.contains(node))
        EXPECT_EQ(v, Vec3d{}) << name << ' ' << node;
      else
        slowest = std::min(slowest, std::sqrt(dot(v, v)));
    }
    EXPECT_GT(slowest, 1e-3) << name;
    std::array<double, 3> largest{};
    for (const Spring& spring : system.springs) {
      const Vec3d d = system.start.position[spring.second] - system.start.position[spring.first];
      largest[spring.kind] = std::max(
          largest[spring.kind], std::abs(std::sqrt(dot(d, d)) / static_cast<double>(spring.rest_length) - 1));
    }
    for (const double strain : largest) {
      EXPECT_GT(strain, 0.005) << name;
      EXPECT_LT(strain, 0.03) << name;
    }
  }
}

TEST(BuildCloth, PlacesTheNodesRowByRowUnderTheCeiling) {
  SceneSpec spec = cloth_spec(3, 5);
  std::get<ClothSpec>(spec.content).ripple = {0, 0.1, 0};
  const System system = build_cloth(spec);
  ASSERT_EQ(system.nodes(), 15U);
  EXPECT_EQ(system.start.position[0], (Vec3d{0, 1, 0}));
  EXPECT_EQ(system.start.position[4], (Vec3d{4 * 0.01, 1, 0}));
  EXPECT_EQ(system.start.position[2 * 5 + 1], (Vec3d{0.01, 1, 2 * 0.01}));
  for (const Vec3d& v : system.start.velocity) EXPECT_EQ(v, Vec3d{});
  for (const Spring& spring : system.springs) {
    const Vec3d d = system.start.position[spring.second] - system.start.position[spring.first];
    EXPECT_NEAR(std::sqrt(dot(d, d)), spring.rest_length, 1e-9);
  }
}

TEST(BuildCloth, StartsAsAStandingWaveThatIsHalfAsHighInThePlane) {
  SceneSpec spec = cloth_spec(3, 5, 1, {});
  std::get<ClothSpec>(spec.content).ripple = {0.004, 0.1, 3};
  // A tenth of the wavelength a node, 0.2 pi: at row 2 and column 1 the phases are 0.2 pi along x and 0.4 pi
  // along z further.
  constexpr double x = 0.2 * std::numbers::pi, z = 0.4 * std::numbers::pi;
  const System system = build_cloth(spec);
  const auto sines = [](double of_x, double of_z) { return std::sin(x + of_x) * std::sin(z + of_z); };
  const Vec3d moved = system.start.position[2 * 5 + 1] - Vec3d{0.01, 1, 0.02},
              v = system.start.velocity[2 * 5 + 1];
  EXPECT_NEAR(moved.x, 0.002 * sines(0.2, 0.9), 1e-12);
  EXPECT_NEAR(moved.y, 0.004 * sines(1.2, 1.9), 1e-12);
  EXPECT_NEAR(moved.z, 0.002 * sines(2.2, 2.9), 1e-12);
  EXPECT_NEAR(v.x, 3 * sines(0.4, 1.3), 1e-12);
  EXPECT_NEAR(v.y, 3 * sines(1.5, 2.5), 1e-12);
  EXPECT_NEAR(v.z, 3 * sines(2.6, 0.3), 1e-12);
}

TEST(BuildCloth, TakesOverThePhysics) {
  const SceneSpec spec = cloth_spec(4, 4);
  const System system = build_cloth(spec);
  for (const double mass : system.node_mass) EXPECT_DOUBLE_EQ(mass, 2e-5);
  EXPECT_EQ(system.gravity, spec.gravity_m_per_s2);
  EXPECT_EQ(system.viscous_damping, spec.viscous_damping_per_s);
  EXPECT_EQ(system.floor.friction, spec.floor.friction);
  ASSERT_EQ(system.materials.size(), 3U);
  EXPECT_EQ(system.materials[shear].stiffness, 60);
  EXPECT_EQ(system.materials[bending].damping, 0.0004);
}

TEST(BuildCloth, PinsEverySoManyColumnsAndTheLastOfOneRow) {
  const System system = build_cloth(cloth_spec(3, 12, 1, ClothPins{1, 5}));
  EXPECT_THAT(system.pins, ElementsAre(12, 17, 22, 23));
  for (const std::uint32_t pin : system.pins)
    EXPECT_EQ(system.start.position[pin], (Vec3d{(pin - 12) * 0.01, 1, 0.01}));
  EXPECT_THAT(build_cloth(cloth_spec(3, 12, 1, {})).pins, IsEmpty());
}

std::string refusal(const SceneSpec& spec) {
  return sentence_of<SceneError>([&] { build_system(spec); });
}

TEST(BuildCloth, RefusesAClothGreaterThanTheMemoryWithBothNumbers) {
  SceneSpec spec = cloth_spec(65'000, 65'000);
  spec.file = "huge.json";
  // 4.225e9 nodes of 288 bytes and 25.35e9 springs of 16 bytes
  EXPECT_THAT(refusal(spec),
              testing::MatchesRegex(
                  "huge.json: /cloth has 4225000000 nodes and 25349350002 springs and needs at least "
                  "1622.* GB of memory, but .* GB are available: make the scene smaller"));
}

TEST(BuildCloth, ObeysTheAddressSpaceLimit) {
  const SceneSpec spec = cloth_spec(1000, 1000);  // 384 MB
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  std::string error;
  {
    const AddressSpaceLimit limit(pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) +
                                  (std::uint64_t{200} << 20));
    if (!limit.holds()) GTEST_SKIP() << "this system limits no address space";
    error = refusal(spec);
  }
  EXPECT_THAT(error,
              testing::MatchesRegex(".*needs at least 0.38 GB of memory, but 0.2[01] GB are available.*"));
  EXPECT_EQ(refusal(spec), "");
}

}  // namespace
}  // namespace mssim
