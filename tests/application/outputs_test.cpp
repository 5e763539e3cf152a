// No file that a command writes is another one that it writes or reads.
#include "application/outputs.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "tests/support/temporary_folder.h"
#include "text/error.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

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
}

}  // namespace
}  // namespace mssim
