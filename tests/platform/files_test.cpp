#include "platform/files.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "tests/support/files_fixture.h"
#include "tests/support/output_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

using testing::ThrowsMessage;

class AtomicFileTest : public TemporaryFolderTest {};

TEST_F(AtomicFileTest, ReplacesTheOldTextAndLeavesNothingElse) {
  const auto file = folder() / "rows.csv";
  write_file_atomically(file, "old, and longer than the new one\n");
  write_file_atomically(file, "new\n");
  EXPECT_EQ(read_file(file), "new\n");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder()), {}), 1);
}

TEST_F(AtomicFileTest, KeepsThePermissionsOfTheOldFile) {
  using std::filesystem::perms;
  const auto file = put("history.jsonl", "old"), fresh = folder() / "fresh";
  std::filesystem::permissions(file, perms::owner_read | perms::owner_write);
  write_file_atomically(file, "new");
  EXPECT_EQ(std::filesystem::status(file).permissions(), perms::owner_read | perms::owner_write);
  std::filesystem::permissions(file, perms::owner_read | perms::group_exec);
  write_file_atomically(file, "newer");
  EXPECT_EQ(std::filesystem::status(file).permissions(),
            perms::owner_read | perms::owner_write | perms::group_exec);
  write_file_atomically(fresh, "new");
  EXPECT_NE(std::filesystem::status(fresh).permissions() & perms::owner_write, perms::none);
}

TEST(XdgFolder, IsThatOfTheVariableOrInTheHomeFolder) {
  const KeptVariables kept{"HOME", "XDG_CONFIG_HOME"};
  ::setenv("HOME", "/home/jane", 1);
  ::setenv("XDG_CONFIG_HOME", "/etc/jane", 1);
  EXPECT_EQ(xdg_folder("XDG_CONFIG_HOME", ".config"), "/etc/jane");
  ::setenv("XDG_CONFIG_HOME", "relative", 1);
  EXPECT_EQ(xdg_folder("XDG_CONFIG_HOME", ".config"), "/home/jane/.config");
  ::setenv("HOME", "relative", 1);
  EXPECT_EQ(xdg_folder("XDG_CONFIG_HOME", ".config"), "");
}

TEST_F(AtomicFileTest, WritesIntoTheWorkingFolderToo) {
  EXPECT_EQ(exit_of_child([&] {
              std::filesystem::current_path(folder());
              write_file_atomically("rows.csv", "text");
              return 0;
            }),
            0);
  EXPECT_EQ(read_file(folder() / "rows.csv"), "text");
}

TEST_F(AtomicFileTest, NamesFileReasonAndRemedyWhenTheFolderIsMissing) {
  const auto file = folder() / "missing" / "rows.csv";
  EXPECT_THAT([&] { write_file_atomically(file, "text"); },
              ThrowsMessage<WriteError>(AllOf(HasSubstr("cannot write " + file.string()),
                                              HasSubstr("No such file or directory"),
                                              HasSubstr("create its folder"))));
}

TEST_F(AtomicFileTest, RefusesToReplaceFoldersAndDevices) {
  EXPECT_THAT([&] { write_file_atomically(folder(), "text"); },
              ThrowsMessage<WriteError>(HasSubstr("is a folder; choose another file name")));
  EXPECT_THAT([] { write_file_atomically("/dev/null", "text"); },
              ThrowsMessage<WriteError>(HasSubstr("not a regular file")));
}

TEST_F(AtomicFileTest, RefusesFoldersOfTheSystemButForSharedMemory) {
  for (const char* file : {"/dev/new", "/proc/new", "/sys/new", "/proc/self/fd/1", "/dev/fd/../new"})
    EXPECT_THAT([&] { require_replaceable(file); },
                ThrowsMessage<WriteError>(AllOf(HasSubstr(file), HasSubstr("choose another file name"))));
  EXPECT_THAT([] { target_of("/dev/stdout"); }, ThrowsMessage<WriteError>(HasSubstr("/dev/stdout")));
  EXPECT_THAT([] { target_of("-"); }, ThrowsMessage<UsageError>(HasSubstr("./-")));
  EXPECT_EQ(target_of("./-"), "./-");
  EXPECT_NO_THROW(require_replaceable("/dev/shm/new"));
  EXPECT_NO_THROW(require_replaceable("/devices"));
}

TEST_F(AtomicFileTest, WritesThroughNoLinkInThePlaceOfItsTemporary) {
  const auto victim = put("victim", "mine"), file = folder() / "rows.csv";
  std::filesystem::create_symlink(victim, temporary_of(file));
  EXPECT_THAT([&] { write_file_atomically(file, "text"); },
              ThrowsMessage<WriteError>(
                  AllOf(HasSubstr(temporary_of(file).string() + " is a link"), HasSubstr("remove it"))));
  std::filesystem::remove(temporary_of(file));
  std::filesystem::create_hard_link(victim, temporary_of(file));
  write_file_atomically(file, "text");
  EXPECT_EQ(read_file(file), "text");
  EXPECT_EQ(read_file(victim), "mine");
}

TEST_F(AtomicFileTest, ReplacesALinkUnlessItsTargetIsAskedFor) {
  const auto victim = put("there/victim", "mine"), file = folder() / "rows.csv", second = folder() / "second";
  std::filesystem::create_symlink("there/victim", file);
  std::filesystem::create_symlink(file, second);
  EXPECT_EQ(target_of("rows.csv"), "rows.csv");
  EXPECT_TRUE(std::filesystem::equivalent(target_of(second), victim));
  write_file_atomically(target_of(second), "text");
  EXPECT_EQ(read_file(victim), "text");
  EXPECT_TRUE(std::filesystem::is_symlink(file));
  write_file_atomically(file, "new");
  EXPECT_EQ(read_file(victim), "text");
  EXPECT_FALSE(std::filesystem::is_symlink(file));
  std::filesystem::create_symlink("b", folder() / "a");
  std::filesystem::create_symlink("a", folder() / "b");
  EXPECT_THAT([&] { target_of(folder() / "a"); }, ThrowsMessage<WriteError>(HasSubstr("circle")));
}

TEST_F(AtomicFileTest, KeepsTheOldTextAndRemovesItsTemporaryWhenWritingFails) {
  const auto file = folder() / "rows.csv";
  write_file_atomically(file, "old\n");
  expect_in_child([&] {
    limit_file_size(1000);
    EXPECT_THAT([&] { write_file_atomically(file, std::string(5000, 'x')); },
                ThrowsMessage<WriteError>(HasSubstr("File too large")));
  });
  EXPECT_EQ(read_file(file), "old\n");
  EXPECT_FALSE(std::filesystem::exists(temporary_of(file)));
}

TEST(WriteFailure, NamesTheLimitThatWasReached) {
  EXPECT_THAT(write_failure("a", "creating it", EMFILE), HasSubstr("ulimit -n"));
  EXPECT_THAT(write_failure("a", "creating it", EFBIG), HasSubstr("ulimit -f"));
}

TEST_F(AtomicFileTest, HasOneWriterAtATime) {
  const auto file = folder() / "rows.csv";
  const auto writes_too = [&] { write_file_atomically(file, "second"); };
  {
    AtomicFile first(file);
    first.append("first");
    const auto refused =
        ThrowsMessage<WriteError>(HasSubstr("another mssim is writing " + file.string() + "; wait until"));
    EXPECT_THAT(writes_too, refused);
    expect_in_child([&] { EXPECT_THAT(writes_too, refused); });
    EXPECT_EQ(read_file(temporary_of(file)), "first") << "who is refused has changed nothing";
    first.move_into_place();
    writes_too();
  }
  EXPECT_EQ(read_file(file), "second");
  EXPECT_FALSE(std::filesystem::exists(temporary_of(file)));
}

TEST_F(AtomicFileTest, IsKeptOrRemovedWhenItsWriterGivesUp) {
  const auto file = folder() / "rows.csv";
  {
    AtomicFile given_up(file);
    given_up.append("lost");
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder()));
  {
    AtomicFile kept(file);
    kept.append("kept");
    kept.keep();
  }
  EXPECT_EQ(read_file(temporary_of(file)), "kept");
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(TemporaryFolders, ThatCannotBeMadeAreAnErrorOfFiles) {
  try {
    const TemporaryFolder made("/dev/null/nowhere");
    FAIL() << "made " << made.path();
  } catch (const WriteError& error) {
    EXPECT_EQ(error.exit_code, exit_file_error);
    EXPECT_THAT(error.what(), AllOf(HasSubstr("/dev/null/nowhere"), HasSubstr("set TMPDIR")));
  }
}

class WholeFile : public TemporaryFolderTest {
 protected:
  static std::string refusal_of(const std::filesystem::path& file, std::size_t most_bytes = 1 << 20) {
    try {
      read_file(file, most_bytes);
    } catch (const ReadError& error) {
      return error.sentence(file, "REMEDY");
    }
    return "nothing";
  }
};

TEST_F(WholeFile, IsReadByteByByte) {
  std::string bytes(200'000, 'x');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i % 251);
  EXPECT_EQ(read_file(put("bytes", bytes)), bytes);
  EXPECT_EQ(read_file(put("empty", "")), "");
  EXPECT_EQ(read_file(put("just", "12345"), 5), "12345");
}

TEST_F(WholeFile, OfProcIsReadThoughItsStatedLengthIsZero) {
  ASSERT_EQ(std::filesystem::file_size("/proc/self/status"), 0U);
  EXPECT_THAT(read_file("/proc/self/status"), StartsWith("Name:"));
  const std::size_t bytes = read_file("/proc/version").size();
  EXPECT_EQ(read_file("/proc/version", bytes).size(), bytes);
  EXPECT_THAT(refusal_of("/proc/version", bytes - 1), HasSubstr("is longer than"));
}

TEST_F(WholeFile, IsRefusedWithTheReason) {
  const std::string name = (folder() / "file").string();
  EXPECT_EQ(refusal_of(name), name + ": there is no such file: REMEDY");
  EXPECT_EQ(refusal_of(folder()), folder().string() + ": is not a regular file: REMEDY");
  ASSERT_EQ(::mkfifo(name.c_str(), 0600), 0);
  EXPECT_EQ(refusal_of(name), name + ": is not a regular file: REMEDY");  // rather than to wait for a writer
  const auto long_file = put("long", std::string(2049, ' '));
  EXPECT_EQ(refusal_of(long_file, 2048), long_file.string() + ": is longer than 2 KiB: REMEDY");
  EXPECT_EQ(refusal_of("/proc/self/mem"),
            "/proc/self/mem: cannot be read (Input/output error): check the file and its disk");
  std::filesystem::permissions(folder(), std::filesystem::perms{0755});
  std::filesystem::permissions(long_file, std::filesystem::perms::none);
  expect_in_child([&] {
    ASSERT_TRUE(become_nobody());
    EXPECT_THAT(refusal_of(long_file),
                HasSubstr(": cannot be opened (Permission denied): check its permissions"));
  });
}

}  // namespace
}  // namespace mssim
