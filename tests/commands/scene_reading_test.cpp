#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "commands/command.h"
#include "garment/scene/garment_body.h"
#include "mesh/tetgen.h"
#include "scene/scene_file.h"
#include "tests/support/obj_text.h"
#include "tests/support/open_count.h"
#include "tests/support/scene_files.h"
#include "tests/support/temporary_folder.h"
#include "text/error.h"

namespace mssim {
namespace {

int run_with(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "mssim");
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  return run_program(static_cast<int>(arguments.size()), pointers.data());
}

class SceneReadingTest : public TemporaryFolderTest {
 protected:
  /// How often these arguments, which must end well, have the file of `scene`, which stands behind them,
  /// opened.
  int openings(const std::vector<std::string>& arguments, const std::string& scene = "cloth2500") const {
    const std::filesystem::path file = put("mine.json", text_of(source_file("scenes/" + scene + ".json")));
    return openings_of(file, arguments, file);
  }

  /// The same of a file that `scene` names.
  static int openings_of(const std::filesystem::path& file, std::vector<std::string> arguments,
                         const std::filesystem::path& scene) {
    OpenCount count(file);
    arguments.push_back(scene.string());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = run_with(std::move(arguments));
    const std::string said = testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr();
    EXPECT_EQ(code, exit_ok) << said;
    return count.value();
  }
};

TEST_F(SceneReadingTest, IsDoneOnceByABench) {
  const std::string out = (folder() / "out").string();
  EXPECT_EQ(openings({"bench", "--backend", "serial", "--integrator", "semi-euler", "--rounds", "1",
                      "--threads", "1", "--trace", "--out", out, "--scene"}),
            1);
  EXPECT_EQ(openings({"bench", "--backend", "serial", "--integrator", "semi-euler", "--rounds", "1",
                      "--threads", "1", "--verified", out, "--scene"}),
            1);
}

TEST_F(SceneReadingTest, IsDoneOnceByADryRun) {
  EXPECT_EQ(openings({"bench", "--dry-run", "--time-budget", "1000", "--scene"}), 1);
}

TEST_F(SceneReadingTest, IsDoneOnceByARun) {
  EXPECT_EQ(openings({"run", "--backend", "serial", "--duration", "0.001", "--fps", "1000", "--trace",
                      (folder() / "trace.h5").string(), "--scene"}),
            1);
}

TEST_F(SceneReadingTest, IsDoneOnceByACheck) {
  EXPECT_EQ(openings({"check"}), 1);
  EXPECT_EQ(openings({"check"}, "jeans1k"), 1);
}

/// Commands, each of which builds the scene that stands behind it.
std::vector<std::vector<std::string>> commands(const std::filesystem::path& folder) {
  return {{"bench", "--backend", "openmp", "--integrator", "semi-euler", "--rounds", "1", "--threads", "1",
           "--scene"},
          {"bench", "--dry-run", "--scene"},
          {"run", "--backend", "openmp", "--fps", "1", "--trace", (folder / "trace.h5").string(), "--scene"},
          {"check"}};
}

/// Two bodies of one shape in files, which another scene has.
class NamedFilesReadingTest : public SceneReadingTest {
 protected:
  NamedFilesReadingTest() {
    put("one.node", node_text({{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, 0, 3}}));
    put("one.ele", ele_text({{0, 1, 2, 3}}));
    put("shape.json",
        bodies("tetgen", R"({"node_file": "one.node", "ele_file": "one.ele", "unit_m": 0.01})"));
  }
  static std::string bodies(const std::string& shape, const std::string& section) {
    const auto body = [&](const char* centre) {
      return R"({"shape": ")" + shape + R"(", ")" + shape + R"(": )" + section + R"(, "centre_m": )" +
             centre + R"(, "velocity_m_per_s": [0, 0, 0], "spin_rad_per_s": [0, 2, 0], "swell_per_s": 3})";
    };
    return R"({"kind": "bodies", "description": "tetrahedra", "dt_s": 1e-4, "gravity_m_per_s2": 9.81,
      "viscous_damping_per_s": 0, "floor": {"height_m": 0, "restitution": 0.5, "friction": 0.4},
      "bodies": {"density_kg_per_m3": 1000, "springs": {"stiffness_n_per_m": 100, "damping_n_s_per_m": 0.1},
      "list": [)" +
           body("[1, 2, 3]") + ", " + body("[2, 3, 4]") + "]}}";
  }
};

TEST_F(NamedFilesReadingTest, IsDoneOnceOfAMesh) {
  for (const char* name : {"one.node", "one.ele"})
    for (const std::vector<std::string>& command : commands(folder()))
      EXPECT_EQ(openings_of(folder() / name, command, folder() / "shape.json"), 1)
          << name << " by " << command.front();
}

TEST_F(NamedFilesReadingTest, IsDoneOnceOfASceneWhoseShapeIsTaken) {
  const std::filesystem::path mine = put("mine.json", bodies("scene", R"({"name": "./shape.json"})"));
  for (const char* name : {"shape.json", "one.node"})
    for (const std::vector<std::string>& command : commands(folder()))
      EXPECT_EQ(openings_of(folder() / name, command, mine), 1) << name << " by " << command.front();
}

TEST_F(NamedFilesReadingTest, IsDoneOnceOfABody) {
  auto scene = nlohmann::json::parse(text_of(source_file("scenes/jeans1k.json")));
  auto& garment = scene["garment"];
  garment.erase("mannequin");
  garment["body"] = "surface_file";
  garment["surface_file"] = {{"file", "body.obj"}, {"unit_m", 1}};
  const std::filesystem::path body = put("body.obj", obj_text(measured_body(find_scene("jeans1k")).surface));
  const std::filesystem::path mine = put("mine.json", scene.dump());
  for (const std::vector<std::string>& command : commands(folder()))
    EXPECT_EQ(openings_of(body, command, mine), 1) << command.front();
}

}  // namespace
}  // namespace mssim
