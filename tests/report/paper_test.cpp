#include "tests/support/report_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// The text of one of the files of a paper about this folder.
std::string text_in(const ReportFolder& folder, const std::string& name) {
  ReportInput input = of_papers();
  input.folders.push_back(folder);
  for (const FolderFile& file : paper_files(input))
    if (file.name == name) return file.text;
  ADD_FAILURE() << "there is no " << name;
  return {};
}

class PaperTest : public testing::Test {
 protected:
  PaperTest() { folder.name = "results/run"; }
  std::string methods() const { return text_in(folder, "methods.tex"); }

  ReportFolder folder = folder_of(serial_and_openmp_rows(), made_up_provenance());
};

TEST_F(PaperTest, SaysWhatAComparisonAllowsAtMost) {
  // Of verification.h: energy_tolerance, and largest_tolerance of positions and energies.
  EXPECT_THAT(methods(), AllOf(HasSubstr("\\qty{1}{\\percent} of the kinetic"), HasSubstr("four times"),
                               HasSubstr("up to \\num{0.1} mean rest lengths and \\qty{10}{\\percent}"),
                               HasSubstr("samples were compared, too, without these upper limits")));
  for (ResultRow& row : folder.rows) row.backend = "javascript";
  EXPECT_THAT(methods(),
              AllOf(HasSubstr("\\qty{1}{\\percent} of the kinetic"), Not(HasSubstr("\\qty{10}{\\percent}"))))
      << "the page has no second reference";
}

TEST_F(PaperTest, SaysOnlyOfCheckedSamplesThatTheyWereCompared) {
  folder.rows[1].note = unchecked_samples;
  EXPECT_THAT(methods(), HasSubstr("samples were compared, too (except those of 1 row)"));
  folder.rows[0].note = unchecked_samples;
  EXPECT_THAT(methods(), AllOf(Not(HasSubstr("samples were compared")), HasSubstr("Before the first round"),
                               HasSubstr("the samples of 2 rows are not checked yet")));
}

TEST_F(PaperTest, DescribesNoWarmUpOfRowsThatAnEarlierProcessVerified) {
  for (ResultRow& row : folder.rows) row.warm_up_trials = 0;
  EXPECT_THAT(methods(), HasSubstr("Before the first round")) << "older versions wrote no trials";
  for (ResultRow& row : folder.rows) row.note = "verified by an earlier process";
  EXPECT_THAT(methods(), AllOf(Not(HasSubstr("Before the first round")),
                               Not(HasSubstr("samples were compared")), HasSubstr("Each of 3 rounds took")));
}

TEST_F(PaperTest, CountsOneRound) {
  for (ResultRow& row : folder.rows) {
    row.rounds = 1;
    row.samples_ms.resize(1);
    row.sample_steps.resize(1);
  }
  EXPECT_THAT(methods(), HasSubstr("\nOne round took one sample of every combination"));
  EXPECT_THAT(text_in(folder, "times.tex"), AllOf(HasSubstr(" 1 round.}"), Not(HasSubstr("1 rounds"))));
}

TEST_F(PaperTest, NamesWhatItsCommandsNeedBesidesMssim) {
  const auto artifact = [&] { return text_in(folder, "artifact.tex"); };
  EXPECT_THAT(artifact(), Not(HasSubstr("not part of mssim")));
  folder.provenance->scenes = {{"mine", 0xabc}, {"cloth2500", 0xdef}};
  folder.provenance->command_line = {"mssim", "bench", "--scene",
                                     "cloth2500,./mine.json,./not-cloth2500.json"};
  folder.provenance->backend_programs = {{.name = "own", .files = {{"./own.py", 0x123}, {"python3", 0x789}}},
                                         {.name = "mpi", .files = {{"libexec/mssim/mssim-mpi", 0x456}}}};
  EXPECT_THAT(
      artifact(),
      AllOf(HasSubstr("not part of mssim"), HasSubstr("\\texttt{mine} (\\texttt{0000000000000abc})"),
            HasSubstr("\\texttt{./own.py} of the backend \\texttt{own}"), Not(HasSubstr("0000000000000def")),
            Not(HasSubstr("mssim-mpi")), Not(HasSubstr("python3"))));
}

TEST_F(PaperTest, HasTheNotesOfPrograms) {
  folder.provenance->backend_programs = {{.name = folder.rows.back().backend}};
  EXPECT_THAT(text_in(folder, "times.tex"), Not(HasSubstr("Notes of the programs")));
  for (ResultRow& row : folder.rows) row.note = "double precision";
  EXPECT_THAT(text_in(folder, "times.tex"),
              AllOf(HasSubstr("Notes of the programs"),
                    HasSubstr("\\texttt{" + folder.rows.back().backend + "}: double precision")));
}

TEST_F(PaperTest, KeepsABacktickInItsPlace) {
  for (ResultRow& row : folder.rows) {
    row.scene = "a`b'c";
    row.scene_as_shipped = false;
  }
  folder.name = "results/d`e";
  folder.provenance->command_line = {"mssim", "bench", "--scene", "=cmd|x`$_%&#.json"};
  EXPECT_THAT(methods(), HasSubstr("Neither paper has \\texttt{a\\textasciigrave{}b\\textquotesingle{}c}."));
  EXPECT_THAT(text_in(folder, "mssim.tex"),
              HasSubstr("\\section{Methods: \\texttt{results/d\\textasciigrave{}e}}"));
  EXPECT_THAT(
      text_in(folder, "artifact.tex"),
      HasSubstr("\\texttt{scripts/mssim bench -{}-{}scene "
                "\\textquotesingle{}=cmd|x\\textasciigrave{}\\$\\_\\%\\&\\#.json\\textquotesingle{}}"));
}

}  // namespace
}  // namespace mssim
