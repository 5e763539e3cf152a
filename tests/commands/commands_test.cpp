#include <nlohmann/json.hpp>

#include "commands/arguments/arguments.h"
#include "commands/command.h"
#include "commands/options.h"
#include "garment/scene/garment_scene.h"
#include "mesh/tetgen.h"
#include "scene/scene_file.h"
#include "tests/support/files_fixture.h"
#include "tests/support/obj_text.h"
#include "tests/support/open_count.h"
#include "tests/support/testing.h"
#include "text/error.h"

namespace mssim {
namespace {

using Frames = std::vector<std::size_t>;

TEST(ListedFrames, AreNumbersRangesAndTheLast) {
  EXPECT_EQ(listed_frames({"0", "3-5", "last"}, 10), (Frames{0, 3, 4, 5, 9}));
  EXPECT_EQ(listed_frames({"8-last"}, 10), (Frames{8, 9}));
  EXPECT_EQ(listed_frames({"7-7"}, 10), Frames{7});
  EXPECT_EQ(listed_frames({"all"}, 3), (Frames{0, 1, 2}));
}

TEST(ListedFrames, AreRefusedWhereTheyAreNone) {
  for (const char* word :
       {"10", "0-10", "-1", "x", "", "1-", "5-3", "1.5", "1-2-3", "last-0", "all-1", "99999999999999999999"})
    EXPECT_THROW(listed_frames({word}, 10), UsageError) << word;
  EXPECT_THAT(sentence_of<UsageError>([] { listed_frames({"5-3"}, 10); }),
              AllOf(HasSubstr("--frames"), HasSubstr("\"5-3\""), HasSubstr("smaller number first")));
}

TEST(FrameAt, IsTheNearest) {
  const std::vector<double> times{0, 0.1, 0.2};
  EXPECT_EQ(frame_at(0, times), 0U);
  EXPECT_EQ(frame_at(0.14, times), 1U);
  EXPECT_EQ(frame_at(0.3, times), 2U);
  EXPECT_THROW(frame_at(0.31, times), UsageError);
  EXPECT_EQ(frame_at(0, {0.0}), 0U);
  EXPECT_THROW(frame_at(1, {0.0}), UsageError);
}

TEST(ChosenFrames, AreAllUnlessAnOptionIsGiven) {
  const std::vector<double> times{0, 0.1, 0.2};
  EXPECT_EQ(chosen_frames({}, times), (Frames{0, 1, 2}));
  EXPECT_EQ(chosen_frames({{"last", "0"}, {}}, times), (Frames{2, 0}));
  EXPECT_EQ(chosen_frames({{}, 0.11}, times), Frames{1});
}

TEST(SpreadOver, GoesFromTheFirstToTheLast) {
  Frames frames;
  for (std::size_t i = 0; i < 31; ++i) frames.push_back(10 + i);
  EXPECT_EQ(spread_over(frames, 6), (Frames{10, 16, 22, 28, 34, 40}));
  EXPECT_EQ(spread_over(frames, 2), (Frames{10, 40}));
  EXPECT_EQ(spread_over(frames, 1), Frames{40});
  // A third and two thirds of 5 are 1.7 and 3.3.
  EXPECT_EQ(spread_over({0, 1, 2, 3, 4, 5}, 4), (Frames{0, 2, 3, 5}));
  EXPECT_EQ(spread_over(frames, 100), frames);
  const Frames chosen = spread_over(frames, 30);
  for (std::size_t i = 1; i < chosen.size(); ++i) EXPECT_LT(chosen[i - 1], chosen[i]);
}

TEST(TwoNumbers, AreWholeAndNotTooLarge) {
  EXPECT_EQ(two_numbers("640x480", 2048), (std::pair<std::uint32_t, std::uint32_t>{640, 480}));
  for (const char* text : {"", "x", "640", "640x", "x480", "0x1", "1x0", "-1x1", "2049x1", "1x2049", "1.5x2",
                           "1x2x3", "1X2", " 1x2"})
    EXPECT_FALSE(two_numbers(text, 2048)) << text;
}

TEST(ScenesIn, AreSeparatedByCommas) {
  EXPECT_THAT(names_and_files_in("cloth2500"), ElementsAre("cloth2500"));
  EXPECT_THAT(names_and_files_in("cloth2500,x.json,torus-small"),
              ElementsAre("cloth2500", "x.json", "torus-small"));
  EXPECT_THAT(names_and_files_in("cloth2500,,torus-small,"), ElementsAre("cloth2500", "torus-small"));
  EXPECT_THAT(names_and_files_in(""), IsEmpty());
  EXPECT_THAT(names_and_files_in(","), IsEmpty());
}

class ScenesInFolder : public TemporaryFolderTest {};

TEST_F(ScenesInFolder, AreNotCutWithinThePathOfAFile) {
  const std::string comma = put("a,b.json", "{}").string();
  const std::string plain = put("c.json", "{}").string();
  EXPECT_THAT(names_and_files_in(comma), ElementsAre(comma));
  EXPECT_THAT(names_and_files_in("cloth2500," + comma + "," + plain), ElementsAre("cloth2500", comma, plain));
  EXPECT_THAT(names_and_files_in(plain + "," + comma), ElementsAre(plain, comma));
  EXPECT_THAT(names_and_files_in(comma + "x"), ElementsAre((folder() / "a").string(), "b.jsonx"));
}

std::string refusal(const ValueRule& rule, std::string text) { return rule(text); }

TEST(ValueRule, PositiveNumberIsFiniteAndAboveZero) {
  const ValueRule rule = positive_number();
  EXPECT_EQ(refusal(rule, "1e-9"), "");
  for (const std::string text : {"0", "-1", "inf", "nan", "1s", ""})
    EXPECT_EQ(refusal(rule, text), '"' + text + "\" is not a positive number");
}

TEST(ValueRule, RangesIncludeTheirEnds) {
  const ValueRule number = number_between(1, 86400);
  EXPECT_EQ(refusal(number, "1"), "");
  EXPECT_EQ(refusal(number, "86400"), "");
  EXPECT_EQ(refusal(number, "0.999"), "\"0.999\" is not a number from 1 to 86400");
  EXPECT_EQ(refusal(number, "86400.1"), "\"86400.1\" is not a number from 1 to 86400");
  const ValueRule whole = whole_number(1, 4096);
  EXPECT_EQ(refusal(whole, "1"), "");
  EXPECT_EQ(refusal(whole, "4096"), "");
  for (const std::string text : {"0", "4097", "1.5", "0x10", "99999999999999999999"})
    EXPECT_EQ(refusal(whole, text), '"' + text + "\" is not a whole number from 1 to 4096");
}

TEST(ValueRule, AWordBecomesItsOwnSpelling) {
  const ValueRule rule = one_of("format", {"table", "csv"});
  std::string text = "TaBLe";
  EXPECT_EQ(rule(text), "");
  EXPECT_EQ(text, "table");
  EXPECT_EQ(refusal(rule, "tabel"),
            "unknown format \"tabel\" (did you mean table?): known are table and csv");
}

TEST(ValueRule, WhatItQuotesIsPrintable) {
  EXPECT_EQ(refusal(positive_number(), "\x1b[2J"), "\"\\u001b[2J\" is not a positive number");
}

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
    const std::filesystem::path file = put("mine.json", read_file(source_file("scenes/" + scene + ".json")));
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

/// Commands, each of which builds the scene that stands behind it.
std::vector<std::vector<std::string>> commands(const std::filesystem::path& folder) {
  return {{"bench", "--backend", "openmp", "--integrator", "semi-euler", "--rounds", "1", "--threads", "1",
           "--scene"},
          {"bench", "--dry-run", "--scene"},
          {"run", "--backend", "openmp", "--fps", "1", "--trace", (folder / "trace.h5").string(), "--scene"},
          {"check"}};
}

TEST_F(SceneReadingTest, IsDoneOnce) {
  for (const std::vector<std::string>& command : commands(folder()))
    EXPECT_EQ(openings(command), 1) << command.front();
  EXPECT_EQ(openings({"check"}, "jeans1k"), 1);
  for (const char* option : {"--out", "--verified"})
    EXPECT_EQ(openings({"bench", "--backend", "serial", "--integrator", "semi-euler", "--rounds", "1",
                        "--threads", "1", option, (folder() / "out").string(), "--scene"}),
              1);
  EXPECT_EQ(openings({"bench", "--backend", "serial", "--integrator", "semi-euler", "--rounds", "1",
                      "--threads", "1", "--trace", "--out", (folder() / "traced").string(), "--scene"}),
            1);
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
  auto scene = nlohmann::json::parse(read_file(source_file("scenes/jeans1k.json")));
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
