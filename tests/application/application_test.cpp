#include <csignal>

#include "application/console.h"
#include "application/outputs.h"
#include "tests/support/output_fixture.h"
#include "tests/support/testing.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

using testing::ThrowsMessage;

const Progress half{"cloth2500", 1, 2, "round 8/15: midpoint openmp", 0.5, 65.2};

TEST(ProgressText, HasABarWhereThereIsRoom) {
  EXPECT_EQ(progress_text(half, 87, false),
            "cloth2500 (1 of 2)  [######      ]  about 1:05 left  round 8/15: midpoint openmp");
  EXPECT_EQ(progress_text(half, 87, true),
            "cloth2500 (1 of 2)  [██████      ]  about 1:05 left  round 8/15: midpoint openmp");
}

TEST(ProgressText, HasAPercentageInANarrowTerminal) {
  EXPECT_EQ(progress_text(half, 78, true),
            "cloth2500 (1 of 2)  50 %  about 1:05 left  round 8/15: midpoint openmp");
}

TEST(ProgressText, NeverTakesTheLastColumn) {
  for (const int width : {1, 2, 10, 20, 40, 60, 80, 120}) {
    EXPECT_LT(width_of(progress_text(half, width, true)), static_cast<std::size_t>(std::max(width, 2)));
    EXPECT_LT(width_of(progress_text(half, width, false)), static_cast<std::size_t>(std::max(width, 2)));
  }
}

TEST(ProgressText, SaysNothingOfTimeWhileNobodyKnowsIt) {
  const Progress begun{"mine", 1, 1, "references", 0, {}};
  EXPECT_EQ(progress_text(begun, 40, true), "mine   0 %  references");
}

TEST(StopRequest, LetsASecondSignalOfAnotherKindEndTheProcess) {
  const auto signals = [](int second) {
    return status_in_child([second]() -> int {
      std::signal(SIGHUP, SIG_IGN);
      const StopRequest stop;
      std::raise(SIGINT);
      std::raise(second);
      ::_exit(stop.requested() ? 7 : 8);
    });
  };
  EXPECT_TRUE(WIFSIGNALED(signals(SIGTERM)));
  EXPECT_EQ(WTERMSIG(signals(SIGTERM)), SIGTERM);
  EXPECT_EQ(WEXITSTATUS(signals(SIGHUP)), 7) << "what was ignored stays ignored";
}

// No file that a command writes is another one that it writes or reads.

namespace fs = std::filesystem;

class OutputNames : public TemporaryFolderTest {
 protected:
  void expect_same(const fs::path& first, const fs::path& second) const {
    EXPECT_THAT(
        [&] {
          require_distinct({{"--trace", first}, {"--energy-curve", second}}, {});
        },
        ThrowsMessage<UsageError>(
            AllOf(HasSubstr("are the same file"), HasSubstr("give them different names"))))
        << first << " and " << second;
    EXPECT_THROW(require_distinct({{"--trace", first}}, {{"a file of the scene", second}}), UsageError);
  }
};

TEST_F(OutputNames, AreToldApartHoweverTheyAreWritten) {
  const fs::path file = folder() / "x.h5";
  fs::create_directory(folder() / "sub");
  fs::create_directory_symlink(folder(), folder() / "link");
  expect_same(file, file);
  expect_same(file, folder() / "." / "x.h5");
  expect_same(file, folder() / "sub" / ".." / "x.h5");
  expect_same(file, folder() / "link" / "x.h5");
  expect_same(file, fs::relative(file));
  fs::create_symlink("x.h5", folder() / "linked.csv");
  expect_same(file, folder() / "linked.csv");
  put("x.h5", "old");
  fs::create_hard_link(file, folder() / "hard.csv");
  expect_same(file, folder() / "hard.csv");
  EXPECT_NO_THROW(require_distinct({{"--trace", file}, {"--energy-curve", folder() / "sub" / "x.h5"}},
                                   {{"a file of the scene", folder() / "x.json"}}));
}

TEST_F(OutputNames, AreNotThoseOfFilesUnderWay) {
  const fs::path trace = folder() / "x.h5", curve = folder() / "x.h5.part";
  const auto refused = ThrowsMessage<UsageError>(HasSubstr("the temporary file of --trace"));
  EXPECT_THAT([&] { require_distinct({{"--trace", trace}, {"--energy-curve", curve}}, {}); }, refused);
  EXPECT_THAT([&] { require_distinct({{"--energy-curve", curve}, {"--trace", trace}}, {}); }, refused);
  EXPECT_THAT([&] { require_distinct({{"--trace", trace}}, {{"the scene", curve}}); }, refused);
}

}  // namespace
}  // namespace mssim
