#include "backends/described/backend_description.h"

#include "scene/fields/fields.h"
#include "tests/support/files_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

class BackendDescriptionTest : public TemporaryFolderTest {
 protected:
  BackendProgram parse(const std::string& text) const {
    return parse_description(folder() / "mine.json", text);
  }
  std::string refusal(const std::string& text) const {
    return sentence_of<SceneError>([&] { parse(text); });
  }
};

TEST_F(BackendDescriptionTest, NeedsACommandAlone) {
  const BackendProgram program = parse(R"({"command": ["sh", "-c", "exit"]})");
  EXPECT_EQ(program.name, "mine");
  EXPECT_EQ(program.program.filename(), "sh");
  EXPECT_TRUE(program.program.is_absolute());
  EXPECT_THAT(program.command, ElementsAre("sh", "-c", "exit"));
  EXPECT_EQ(program.folder, folder());
  EXPECT_EQ(program.missing, "");
  EXPECT_TRUE(program.steps_cloths && program.steps_bodies);
  EXPECT_THAT(program.integrators, IsEmpty());
  EXPECT_EQ(program.time_limit_s, 120);
  EXPECT_FALSE(program.in_ranks);
  EXPECT_FALSE(program.has_windows);
}

TEST_F(BackendDescriptionTest, HasWindowsInRanksAlone) {
  EXPECT_THROW(parse(R"({"command": ["sh"], "states": "windows"})"), SceneError);
}

TEST_F(BackendDescriptionTest, TakesEveryField) {
  const BackendProgram program =
      parse(R"({"$schema": "s.json", "command": ["sh"], "description": "a shell", "scenes": ["bodies"],
      "integrators": ["rk4", "semi-euler"], "environment": {"A": "1", "B": ""}, "time_limit_s": 2.5, "processes": "ranks",
      "states": "windows", "install": "nothing to install"})");
  EXPECT_EQ(program.description, "a shell");
  EXPECT_FALSE(program.steps_cloths);
  EXPECT_TRUE(program.steps_bodies);
  EXPECT_THAT(program.integrators, ElementsAre("rk4", "semi-euler"));
  EXPECT_THAT(program.environment, ElementsAre("A=1", "B="));
  EXPECT_EQ(program.time_limit_s, 2.5);
  EXPECT_TRUE(program.in_ranks);
  EXPECT_TRUE(program.has_windows);
  EXPECT_EQ(program.missing, "");
}

TEST_F(BackendDescriptionTest, FindsAPathFromItsOwnFolder) {
  const fs::path file = put("bin/step", "#!/bin/sh\n");
  EXPECT_THAT(parse(R"({"command": ["./bin/step"]})").missing, HasSubstr("is not executable; chmod +x it"));
  fs::permissions(file, fs::perms::owner_all);
  const BackendProgram program = parse(R"({"command": ["./bin/step"]})");
  EXPECT_EQ(program.missing, "");
  EXPECT_TRUE(fs::equivalent(program.program, file));
}

TEST_F(BackendDescriptionTest, SaysWhatIsMissing) {
  EXPECT_EQ(parse(R"({"command": ["no-such-program"]})").missing,
            "there is no program no-such-program in PATH");
  EXPECT_THAT(parse(R"({"command": ["./no-such-file"]})").missing,
              HasSubstr("there is no file ./no-such-file next to "));
  EXPECT_EQ(parse(R"({"command": ["no-such-program"], "install": "install it"})").missing,
            "there is no program no-such-program in PATH; install it");
  const std::string long_advice(180, 'x');
  EXPECT_TRUE(parse(R"({"command": ["no-such-program"], "install": ")" + long_advice + "\"}")
                  .missing.ends_with("; " + long_advice));
}

TEST_F(BackendDescriptionTest, RefusesWhatItDoesNotKnow) {
  EXPECT_THAT(refusal(R"({"comand": ["sh"]})"), HasSubstr("mine.json: /comand is not a known key"));
  EXPECT_THAT(refusal(R"({"description": "x"})"), HasSubstr("/command is missing: add it as a list"));
  EXPECT_THAT(refusal(R"({"command": []})"), HasSubstr("/command has 0 elements: give a list"));
  EXPECT_THAT(refusal(R"({"command": [""]})"), HasSubstr("/command/0 is empty"));
  EXPECT_THAT(refusal(R"({"command": ["sh", 3]})"), HasSubstr("/command/1 is 3: give one line of text"));
  EXPECT_THAT(refusal(R"({"command": ["sh"], "scenes": ["jeans"]})"),
              HasSubstr("/scenes/0 is the text \"jeans\": give the text cloth or bodies"));
  EXPECT_THAT(refusal(R"({"command": ["sh"], "integrators": ["euler"]})"),
              HasSubstr("/integrators/0 is the text \"euler\": give the text semi-euler"));
  EXPECT_THAT(refusal(R"({"command": ["sh"], "time_limit_s": 0})"), HasSubstr("/time_limit_s is 0: give"));
  EXPECT_THAT(refusal(R"({"command": ["sh"], "environment": {"A=B": "1"}})"),
              HasSubstr("/environment has the name \"A=B\""));
  for (const char* control : {"\\u0000", "\\n", "\\u001b"})
    EXPECT_THAT(refusal(fmt::format(R"({{"command": ["sh"], "environment": {{"A{}B": "1"}}}})", control)),
                HasSubstr("/environment has the name \"A\\"));
  EXPECT_THAT(refusal(R"({"command": ["sh"], "environment": {"A": 1}})"), HasSubstr("/environment/A is 1"));
  EXPECT_THAT(refusal(""), HasSubstr("is empty: give the description of a backend"));
}

TEST_F(BackendDescriptionTest, MayHaveLongWordsAndVariables) {
  const auto with = [](std::size_t length) {
    const std::string text(length, 'x');
    return fmt::format(R"({{"command": ["sh", "{0}"], "environment": {{"PATHS": "{0}"}}}})", text);
  };
  EXPECT_EQ(parse(with(4096)).environment.front().size(), 4096 + std::string("PATHS=").size());
  EXPECT_THAT(refusal(with(4097)), HasSubstr("give one line of text of at most 4096 characters"));
  EXPECT_THAT(refusal(R"({"command": ["sh"], "description": ")" + std::string(201, 'x') + "\"}"),
              HasSubstr("at most 200 characters"));
}

TEST_F(BackendDescriptionTest, ReadsFiles) {
  EXPECT_EQ(read_description(put("shell.json", R"({"command": ["sh"]})")).name, "shell");
  EXPECT_THROW(read_description(folder() / "none.json"), SceneError);
  EXPECT_THROW(read_description(put("large.json", std::string(largest_description_bytes + 1, ' '))),
               SceneError);
}

}  // namespace
}  // namespace mssim
