#include "mesh/tetgen.h"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>

#include "platform/process.h"
#include "tests/support/mesh_fixture.h"
#include "tests/support/testing.h"
#include "text/error.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;
using testing::MatchesRegex;

TEST(ChildProcess, ReturnsHowItEndedAndWhatItWrote) {
  const auto shell = [](const std::string& script, unsigned cpu_seconds = 5) {
    return run({"/bin/sh", {"-c", script}, {"COLOUR=blue"}, "/", cpu_seconds});
  };
  ChildResult ended = shell("pwd; echo $COLOUR >&2; cat; exit 3");
  EXPECT_EQ(ended.exit_code, 3);
  EXPECT_EQ(ended.signal, 0);
  EXPECT_EQ(ended.output, "/\nblue\n");
  EXPECT_EQ(shell("kill -SEGV $$").signal, SIGSEGV);
  ended = shell("i=0; while [ $i -lt 20000 ]; do echo 0123456789; i=$((i+1)); done; echo end");
  EXPECT_EQ(ended.output.size(), 64U * 1024);
  EXPECT_THAT(ended.output, EndsWith("\nend\n"));
  EXPECT_EQ(shell("while :; do :; done", 1).signal, SIGXCPU);
}

TEST(ChildProcess, IsEndedWithAllThatItStartedWhenThisProcessIsToldToEnd) {
  for (const int signal : ending_signals) {
    const std::string script = "sleep 60 & kill -" + std::to_string(signal) + " $PPID; wait";
    const auto before = std::chrono::steady_clock::now();
    try {
      run({"/bin/sh", {"-c", script}, {}, "/", 5});
      ADD_FAILURE() << "the signal " << signal << " is lost";
    } catch (const Interrupted& interrupted) {
      EXPECT_EQ(interrupted.signal, signal);
    }
    EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(30));
  }
}

TEST(ChildProcess, LeavesIgnoredSignalsIgnored) {
  const auto before = std::signal(SIGHUP, SIG_IGN);
  EXPECT_EQ(run({"/bin/sh", {"-c", "kill -HUP $PPID; kill -HUP $$; exit 4"}, {}, "/", 5}).exit_code, 4);
  std::signal(SIGHUP, before);
}

TEST(ChildProcess, ThatCannotStartIsAnError) {
  EXPECT_THAT(
      [] {
        run({"/dev/null/program", {}, {}, "/", 1});
      },
      testing::ThrowsMessage<std::runtime_error>(HasSubstr("cannot run /dev/null/program")));
}

using TetgenTest = MeshTest;

TEST_F(TetgenTest, SaysWhichItIs) {
  const auto program = find_tetgen();
  ASSERT_TRUE(program) << "these tests need Debian's package tetgen";
  EXPECT_THAT(program->version, MatchesRegex("[0-9]+\\.[0-9.]+"));
  EXPECT_EQ(find_tetgen()->fnv1a_64, program->fnv1a_64);
  install_tetgen("exit 0\n");
  EXPECT_EQ(find_tetgen()->executable, folder() / "programs" / "tetgen");
  EXPECT_NE(find_tetgen()->fnv1a_64, program->fnv1a_64);
}

std::string complaint_about(const Surface& surface, const char* switches = keep_surface) {
  return sentence_of<InputError>([&] {
    validate_surface(surface, "surface");
    tetrahedralise(surface, {}, switches);
  });
}

TEST_F(TetgenTest, TrianglesThatCrossAreNamed) {
  EXPECT_THAT(complaint_about(both(unit_cube(), unit_cube({0.5, 0.5, 0.5}))),
              AllOf(HasSubstr("crosses or touches itself: the triangle ("),
                    HasSubstr(") meets the triangle (0.5, ")));
  EXPECT_THAT(complaint_about(both(unit_cube(), unit_cube({1, 0.25, 0}))),
              HasSubstr("crosses or touches itself"));
}

TEST_F(TetgenTest, APartInsideAnotherIsRefused) {
  Surface inner = unit_cube();
  for (Vec3d& point : inner.points) point = 0.5 * point + Vec3d{0.25, 0.25, 0.25};
  EXPECT_THAT(complaint_about(both(unit_cube(), inner)), HasSubstr("a closed part lies inside another one"));
  for (auto& triangle : inner.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_THAT(complaint_about(both(unit_cube(), inner)), HasSubstr("a closed part lies inside another one"));
}

TEST_F(TetgenTest, TrianglesThatAreAlmostInOnePlaneAreJoinedAndNoInnerPart) {
  constexpr const char* of_files = "-pq";  // as for a surface in a file
  Surface cube = unit_cube();
  *std::ranges::find(cube.points, Vec3d{1, 1, 1}) += Vec3d{3e-4, 1e-3, -5e-4};
  const double filled = volume_of(tetrahedralise(cube, {}, of_files));
  EXPECT_GT(std::abs(filled - volume_of(cube)), 1e-6);
  EXPECT_NEAR(filled, volume_of(cube), 1e-3);
  // Of a thin plate, they are much.
  for (Vec3d& point : cube.points) point.y *= 0.01;
  std::ranges::max_element(cube.points, {}, &Vec3d::y)->y += 7e-4;
  EXPECT_THAT(complaint_about(cube, of_files),
              AllOf(HasSubstr("m^3 but TetGen filled 0.0"), HasSubstr("almost in one plane"),
                    HasSubstr("thicker"), Not(HasSubstr("inner part"))));
}

TEST_F(TetgenTest, PartsBesideEachOtherAreFilled) {
  EXPECT_NEAR(volume_of(tetrahedralise(both(unit_cube(), unit_cube({1.5, 0, 0})), {}, keep_surface)), 2,
              1e-12);
}

TEST_F(TetgenTest, ACrashAFailureAndNoMeshAreErrors) {
  install_tetgen("kill -SEGV $$\n");
  EXPECT_THAT(complaint_about(unit_cube()), HasSubstr("ended with signal 11"));
  install_tetgen("kill -KILL $$\n");
  EXPECT_THAT(complaint_about(unit_cube()),
              HasSubstr("stopped by signal 9, as the system does when memory runs out; give "));
  install_tetgen("echo out of luck >&2; exit 1\n");
  EXPECT_THAT(complaint_about(unit_cube()),
              HasSubstr("ended with exit code 1 after writing \"out of luck\""));
  install_tetgen("exit 0\n");
  EXPECT_THAT(complaint_about(unit_cube()),
              AllOf(HasSubstr("ended without writing a mesh"),
                    HasSubstr("make sure that " + (folder() / "programs").string())));
  install_tetgen("echo 1 3 0 0 >body.1.node; echo 1 4 0 >body.1.ele\n");
  EXPECT_THAT(complaint_about(unit_cube()),
              HasSubstr("TetGen's .node file, line 1: the file ends before node 1 of 1"));
  EXPECT_FALSE(fs::exists(cache()));
}

TEST_F(TetgenTest, LeavesNothingInTheFolderOfTemporaryFiles) {
  const fs::path temporary = folder() / "temporary";
  fs::create_directory(temporary);
  ::setenv("TMPDIR", temporary.c_str(), 1);
  tetrahedralise(unit_cube(), {}, keep_surface);
  EXPECT_TRUE(fs::is_empty(temporary));
}

TEST_F(TetgenTest, NoFolderForTemporaryFilesIsAnErrorThatNamesIt) {
  ::setenv("TMPDIR", "/dev/null/nowhere", 1);
  EXPECT_THAT([] { tetrahedralise(unit_cube(), {}, keep_surface); },
              testing::ThrowsMessage<std::runtime_error>(HasSubstr("/dev/null/nowhere")));
}

class MeshCacheTest : public MeshTest {
 protected:
  TetMesh mesh() const { return shape_mesh({BoxShape{{1, 1, 1}, {3, 3, 3}}, {20, 1, 0.1, 0.6}}); }
  /// The only entry of the cache.
  fs::path entry() const {
    const std::vector<fs::path> files(fs::directory_iterator(cache()), fs::directory_iterator{});
    EXPECT_EQ(files.size(), 1U);
    return files.at(0);
  }
  static void expect_same(const TetMesh& a, const TetMesh& b) {
    EXPECT_EQ(a.nodes, b.nodes);
    EXPECT_EQ(a.tetrahedra, b.tetrahedra);
  }
};

TEST_F(MeshCacheTest, HoldsWhatTetgenMade) {
  const TetMesh made = mesh();
  const fs::file_time_type written = fs::last_write_time(entry());
  expect_same(mesh(), made);
  EXPECT_EQ(fs::last_write_time(entry()), written);
}

TEST_F(MeshCacheTest, TellsInputsAndSwitchesApart) {
  const Surface cube = unit_cube();
  const auto count = [&] { return std::distance(fs::directory_iterator(cache()), fs::directory_iterator{}); };
  tetrahedralise(cube, {}, keep_surface);
  tetrahedralise(cube, {}, "-p");
  EXPECT_EQ(count(), 2);
  tetrahedralise(cube, {{0.5, 0.5, 0.25}}, keep_surface);
  tetrahedralise(unit_cube({1, 0, 0}), {}, keep_surface);
  EXPECT_EQ(count(), 4);
}

TEST_F(MeshCacheTest, ServesMachinesWithoutTetgen) {
  const TetMesh made = mesh();
  ::setenv("PATH", "", 1);
  expect_same(mesh(), made);
}

TEST_F(MeshCacheTest, AnotherTetgenMakesItsOwnMesh) {
  const TetMesh made = mesh();
  // The real one behind another program: same mesh, another entry.
  install_tetgen("exec '" + find_tetgen()->executable.string() + "' \"$@\"\n");
  expect_same(mesh(), made);
  EXPECT_EQ(std::distance(fs::directory_iterator(cache()), fs::directory_iterator{}), 2);
}

TEST_F(MeshCacheTest, WithoutEntryAndTetgenTheRemedyIsNamed) {
  for (const char* path : {"", "/dev/null/nowhere", "/"}) {
    ::setenv("PATH", path, 1);
    EXPECT_THAT([&] { mesh(); },
                testing::ThrowsMessage<MissingProgram>(HasSubstr("install Debian's package tetgen")));
  }
  ::unsetenv("PATH");
  EXPECT_THROW(mesh(), MissingProgram);
}

TEST_F(MeshCacheTest, ADamagedEntryIsMadeAnew) {
  const TetMesh made = mesh();
  const fs::path file = entry();
  const std::string whole = read_file(file);
  std::string changed = whole;
  changed[whole.size() / 2] = changed[whole.size() / 2] == '1' ? '2' : '1';
  for (const std::string& damaged :
       {std::string(), whole.substr(0, whole.size() / 2), changed, whole + "0",
        std::string("mssim mesh 1 99999999999999999999 0\n"), std::string("nonsense")}) {
    put(file, damaged);
    expect_same(mesh(), made);
    EXPECT_EQ(read_file(file), whole);
  }
  put(file, changed);
  ::setenv("PATH", "", 1);
  EXPECT_THROW(mesh(), MissingProgram);
}

TEST_F(MeshCacheTest, AFolderThatCannotBeWrittenIsNoFailure) {
  put("cache", "a file where the folder should be");
  EXPECT_EQ(mesh().nodes.size(), 56U + 20);
  ::unsetenv("XDG_CACHE_HOME");
  ::unsetenv("HOME");
  EXPECT_EQ(mesh().nodes.size(), 56U + 20);
}

TEST_F(MeshCacheTest, LiesInTheHomeFolderByDefault) {
  ::setenv("XDG_CACHE_HOME", "relative/paths/do/not/count", 1);
  ::setenv("HOME", folder().c_str(), 1);
  mesh();
  EXPECT_FALSE(fs::is_empty(folder() / ".cache" / "mssim" / "meshes"));
}

TEST_F(MeshCacheTest, SeveralAtOnceGetTheSameMesh) {
  const TetMesh made = mesh();
  fs::remove_all(cache());
  std::vector<pid_t> processes;  // not threads: a process runs one other program at a time
  for (int i = 0; i < 4; ++i) {
    processes.push_back(::fork());
    if (processes.back() == 0) {
      expect_same(mesh(), made);
      ::_exit(HasFailure() ? 1 : 0);
    }
  }
  for (const pid_t process : processes) {
    int status = -1;
    ASSERT_EQ(::waitpid(process, &status, 0), process);
    EXPECT_EQ(status, 0);
  }
  expect_same(mesh(), made);
  entry();  // the only file: no temporary ones are left
}

}  // namespace
}  // namespace mssim
