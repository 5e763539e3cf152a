#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include <csignal>

#include "platform/files.h"
#include "tests/support/trace_fixture.h"

namespace mssim {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::Eq;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST_F(Trace, KeepsAllFramesWhenTheProcessIsKilled) {
  const int status = status_in_child([&] {
    H5mdTrace trace(file(), system_, header());
    for (int frame = 0; frame < 70; ++frame) write_frame(trace, system_, frame);
    return std::raise(SIGKILL);
  });
  ASSERT_TRUE(WIFSIGNALED(status));
  expect_frames(part(), system_, 70);
  EXPECT_FALSE(std::filesystem::exists(file()));
}

enum Outcome { complete = 10, failed_properly, wrong };

/// Writes a trace of 20 frames where there may be too little room for it.
int write_in_little_room(const std::filesystem::path& file, const System& system, const std::string& reason) {
  std::string message;
  int frame = 0;
  try {
    H5mdTrace trace(file, system, header());
    for (; frame < 20; ++frame) write_frame(trace, system, frame);
    trace.close();
  } catch (const WriteError& error) {
    message = error.what();
  }
  const auto part = temporary_of(file);
  if (message.empty()) {
    expect_frames(file, system, 20);
    EXPECT_FALSE(std::filesystem::exists(part));
    return testing::Test::HasFailure() ? wrong : complete;
  }
  EXPECT_THAT(message, AllOf(HasSubstr("cannot write " + file.string()), HasSubstr(reason)));
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_EQ(std::filesystem::exists(part), frame > 0);
  if (frame > 0) {
    EXPECT_THAT(message, HasSubstr("keeps the frames written before: " + std::to_string(frame)));
    expect_frames(part, system, frame);
  }
  return testing::Test::HasFailure() ? wrong : failed_properly;
}

TEST_F(Trace, KeepsAllFramesWhereverTheLimitOnFileSizesStrikes) {
  Outcome last = failed_properly;
  for (rlim_t bytes = 1000; bytes < 240000; bytes += 7000) {
    const int outcome = exit_of_child([&] {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{bytes, bytes};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      return write_in_little_room(folder() / std::to_string(bytes), system_, "File too large");
    });
    EXPECT_THAT(outcome, AnyOf(Eq(last), Eq(complete))) << "with " << bytes << " bytes";
    last = outcome == complete ? complete : last;
  }
  EXPECT_EQ(last, complete) << "the largest limit should be no limit";
}

TEST_F(Trace, KeepsAllFramesOnAFullDisk) {
  constexpr int no_mounts_here = 77;
  for (const char* size : {"size=16k", "size=100k", "size=120k", "size=140k", "size=4m"}) {
    const int outcome = exit_of_child([&] {
      if (::unshare(::geteuid() == 0 ? CLONE_NEWNS : CLONE_NEWNS | CLONE_NEWUSER) != 0) return no_mounts_here;
      if (::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
          ::mount("tmpfs", folder().c_str(), "tmpfs", 0, size) != 0)
        return no_mounts_here;
      return write_in_little_room(file(), system_, "No space left on device");
    });
    if (outcome == no_mounts_here) GTEST_SKIP() << "this system lets the test mount no small disk";
    EXPECT_EQ(outcome, std::string(size) == "size=4m" ? complete : failed_properly) << size;
  }
}

TEST_F(Trace, HasOneWriterAtATime) {
  H5mdTrace trace(file(), system_, header());
  write_frame(trace, system_, 0);
  const auto begin = [&] { H5mdTrace(file(), system_, header()); };
  const auto refused = ThrowsMessage<WriteError>(HasSubstr("another mssim is writing " + file().string()));
  EXPECT_THAT(begin, refused);
  EXPECT_EQ(exit_of_child([&] {
              EXPECT_THAT(begin, refused);
              return testing::Test::HasFailure() ? 1 : 0;
            }),
            0);
  write_frame(trace, system_, 1);
  trace.close();
  expect_frames(file(), system_, 2);
}

TEST_F(Trace, CannotBeginInAFolderThatIsMissingOrMayNotBeWritten) {
  const auto begin = [&](const std::filesystem::path& path) { H5mdTrace(path, system_, header()); };
  EXPECT_THAT([&] { begin(folder() / "missing" / "run.h5"); },
              ThrowsMessage<WriteError>(
                  AllOf(HasSubstr("No such file or directory"), HasSubstr("create its folder"))));
  std::filesystem::create_directory(file());
  EXPECT_THAT([&] { begin(file()); }, ThrowsMessage<WriteError>(HasSubstr("is a folder")));
  EXPECT_EQ(exit_of_child([&] {
              std::filesystem::permissions(folder(), std::filesystem::perms{0555});
              constexpr uid_t nobody = 65534;
              if (::geteuid() == 0 && ::seteuid(nobody) != 0) return 2;
              EXPECT_THAT([&] { begin(folder() / "other.h5"); },
                          ThrowsMessage<WriteError>(AllOf(HasSubstr("Permission denied"),
                                                          HasSubstr("a folder that you may write to"))));
              return testing::Test::HasFailure() ? 1 : 0;
            }),
            0);
}

TEST_F(Trace, LeavesATemporaryFileOnlyWhenItIsGivenUpWithFrames) {
  { const H5mdTrace trace(file(), system_, header()); }
  EXPECT_TRUE(std::filesystem::is_empty(folder()));
  {
    H5mdTrace trace(file(), system_, header());
    write_frame(trace, system_, 0);
  }
  EXPECT_FALSE(std::filesystem::exists(file()));
  expect_frames(part(), system_, 1);
}

TEST_F(Trace, RefusesANameThatItsXdmfWouldTake) {
  EXPECT_THAT([&] { H5mdTrace(folder() / "run.xdmf", system_, header()); },
              ThrowsMessage<WriteError>(HasSubstr("choose a name that ends in .h5")));
  EXPECT_TRUE(std::filesystem::is_empty(folder()));
}

}  // namespace
}  // namespace mssim
