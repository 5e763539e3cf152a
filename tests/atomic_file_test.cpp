#include "output/atomic_file.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>

#include "output/write_error.h"
#include "output_fixture.h"

namespace mssim {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

class AtomicFile : public TemporaryFolderTest {};

TEST_F(AtomicFile, ReplacesTheOldTextAndLeavesNothingElse) {
  const auto file = folder() / "rows.csv";
  write_file_atomically(file, "old, and longer than the new one\n");
  write_file_atomically(file, "new\n");
  EXPECT_EQ(text_of(file), "new\n");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder()), {}), 1);
}

TEST_F(AtomicFile, WritesIntoTheWorkingFolderToo) {
  EXPECT_EQ(exit_of_child([&] {
              std::filesystem::current_path(folder());
              write_file_atomically("rows.csv", "text");
              return 0;
            }),
            0);
  EXPECT_EQ(text_of(folder() / "rows.csv"), "text");
}

TEST_F(AtomicFile, NamesFileReasonAndRemedyWhenTheFolderIsMissing) {
  const auto file = folder() / "missing" / "rows.csv";
  EXPECT_THAT([&] { write_file_atomically(file, "text"); },
              ThrowsMessage<WriteError>(AllOf(HasSubstr("cannot write " + file.string()),
                                              HasSubstr("No such file or directory"),
                                              HasSubstr("create its folder"))));
}

TEST_F(AtomicFile, RefusesToReplaceFoldersAndDevices) {
  EXPECT_THAT([&] { write_file_atomically(folder(), "text"); },
              ThrowsMessage<WriteError>(HasSubstr("is a folder; choose another file name")));
  EXPECT_THAT([] { write_file_atomically("/dev/null", "text"); },
              ThrowsMessage<WriteError>(HasSubstr("not a regular file")));
}

TEST_F(AtomicFile, KeepsTheOldTextAndRemovesItsTemporaryWhenWritingFails) {
  const auto file = folder() / "rows.csv";
  write_file_atomically(file, "old\n");
  EXPECT_EQ(exit_of_child([&] {
              std::signal(SIGXFSZ, SIG_IGN);
              const rlimit limit{1000, 1000};
              ::setrlimit(RLIMIT_FSIZE, &limit);
              EXPECT_THAT([&] { write_file_atomically(file, std::string(5000, 'x')); },
                          ThrowsMessage<WriteError>(HasSubstr("File too large")));
              return testing::Test::HasFailure() ? 1 : 0;
            }),
            0);
  EXPECT_EQ(text_of(file), "old\n");
  EXPECT_FALSE(std::filesystem::exists(temporary_of(file)));
}

}  // namespace
}  // namespace mssim
