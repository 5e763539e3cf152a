#include "commands/arguments/arguments.h"
#include "commands/arguments/program_parser.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// A program `draw`, whose command `shape` has an argument of each kind, and `pair` two positional ones.
class Prompt : public testing::Test {
 protected:
  Prompt() {
    const auto names = [this] {
      ++makings_;
      return std::vector<std::string>{"ball", "box", "cone"};
    };
    Arguments shape = parser_.add_command("shape", "Draw a shape", "Example:\n  draw shape cone");
    shape.add_list("NAME NAME|FILE,...", texts_, "Shapes").offers(names);
    shape.add_list("--names NAME|FILE,...", texts_, ".obj files, or C:\\names").offers(names);
    shape.add("--out FOLDER", text_, "Folder to write into");
    shape.add_choice("--format", number_, {{"png", 1}, {"svg", 2}}, "What to write");
    shape.add("--suite WORD", text_, "Suite", one_of("suite", {"small", "large"}));
    shape.add_flag("--fast", flag_, "Draw badly");
    shape.add_flag_with_text("--movie [FILE]", movie_, "Draw a movie");
    Arguments pair = parser_.add_command("pair", "Compare two", "");
    pair.add("OLD FOLDER", text_, "Before");
    pair.add("NEW WORD", other_text_, "After", one_of("name", {"now"}));
    parser_.end_help_with(
        "More is said elsewhere.\n\nExamples:\n  draw shape box\n\nExit codes: 0 success;\n1 failure.");
  }

  std::string completions(const std::vector<std::string>& words) const { return parser_.completions(words); }

  ProgramParser parser_{"draw", "draw 1.0: draws shapes", "draw 1.0"};
  Arguments help_ = parser_.add_command("help", "Explain", "");
  int makings_ = 0;

 private:
  std::vector<std::string> texts_;
  std::string text_, other_text_;
  int number_ = 0;
  bool flag_ = false;
  std::optional<std::string> movie_;
};

TEST_F(Prompt, CompletesCommands) {
  EXPECT_EQ(completions({""}), "words\t\nhelp\tExplain\nshape\tDraw a shape\npair\tCompare two\n");
  EXPECT_EQ(completions({}), completions({""}));
  EXPECT_EQ(completions({"sh"}), "words\t\nshape\tDraw a shape\n");
  EXPECT_EQ(completions({"--v"}),
            "words\t\n--version\tShow the version and the commit that it was built from\n");
  EXPECT_EQ(completions({"shapes", ""}), "words\t\n");
}

TEST_F(Prompt, CompletesOptions) {
  EXPECT_EQ(completions({"shape", "--f"}), "words\t\n--format\tWhat to write\n--fast\tDraw badly\n");
  EXPECT_EQ(completions({"shape", "--fast", "--o"}), "words\t\n--out\tFolder to write into\n");
  EXPECT_EQ(completions({"shape", "--movie", "--o"}), "words\t\n--out\tFolder to write into\n")
      << "a text that may be left out";
  EXPECT_EQ(makings_, 0) << "names are made without need";
}

TEST_F(Prompt, CompletesValues) {
  EXPECT_EQ(completions({"shape", "--format", ""}), "words\t\npng\nsvg\n");
  EXPECT_EQ(completions({"shape", "--suite", "l"}), "words\t\nlarge\n");
  EXPECT_EQ(completions({"shape", "--names", "b"}), "file\t\nball\nbox\n");
  EXPECT_EQ(completions({"shape", "--out", "b"}), "directory\t\n");
  EXPECT_EQ(completions({"shape", "--movie", "b"}), "file\t\n");
  EXPECT_EQ(completions({"shape", "--out", "there", "c"}), "file\t\ncone\n");
}

TEST_F(Prompt, CompletesWhatFollowsACommaOrAnEqualsSign) {
  EXPECT_EQ(completions({"shape", "--names", "cone,b"}), "file\tcone,\ncone,ball\ncone,box\n");
  EXPECT_EQ(completions({"shape", "--names=b"}), "file\t--names=\n--names=ball\n--names=box\n");
  EXPECT_EQ(completions({"shape", "--names=a,b,co"}), "file\t--names=a,b,\n--names=a,b,cone\n");
  EXPECT_EQ(completions({"shape", "--out=b"}), "directory\t--out=\n");
  EXPECT_EQ(completions({"shape", "--fast=b"}), "words\t\n") << "a flag";
  EXPECT_EQ(completions({"shape", "--slow=b"}), "words\t\n") << "no option";
}

TEST_F(Prompt, CompletesPositionalArgumentsInTheirOrder) {
  EXPECT_EQ(completions({"pair", ""}), "directory\t\n");
  EXPECT_EQ(completions({"pair", "old", ""}), "words\t\nnow\n");
  EXPECT_EQ(completions({"shape", "ball", "c"}), "file\t\ncone\n");
}

TEST_F(Prompt, IsExplainedByAManualPage) {
  const std::string page = help_.manual_page();
  EXPECT_THAT(page, HasSubstr(".SH NAME\ndraw \\- draws shapes\n"));
  EXPECT_THAT(page, HasSubstr(".SS draw shape\nDraw a shape\n.TP\n\\fINAME\\fR\nShapes\n"));
  EXPECT_THAT(page,
              HasSubstr(".TP\n\\fB\\-\\-names\\fR \\fINAME|FILE,...\\fR\n\\&.obj files, or C:\\enames\n"));
  EXPECT_THAT(page, HasSubstr(".TP\n\\fB\\-\\-fast\\fR\nDraw badly\n"));
  EXPECT_THAT(page, HasSubstr("Example:\n.nf\n\\fBdraw shape cone\\fR\n.fi\n"));
  EXPECT_THAT(page, HasSubstr(".PP\nMore is said elsewhere.\n.SH EXAMPLES\n.nf\n\\fBdraw shape box\\fR\n.fi\n"
                              ".SH EXIT CODES\n0 success;\n1 failure.\n"));
}

}  // namespace
}  // namespace mssim
