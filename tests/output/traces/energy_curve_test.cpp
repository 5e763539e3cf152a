#include "output/traces/energy_curve.h"

#include <csignal>
#include <cstdlib>

#include "output/traces/h5md_trace.h"
#include "tests/support/files_fixture.h"
#include "tests/support/output_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

class EnergyCurveTest : public TemporaryFolderTest {
 protected:
  std::filesystem::path file() const { return folder() / "curve.csv"; }
};

TEST_F(EnergyCurveTest, StandsInTheFileBehindItsCommentWithTenDigits) {
  EnergyCurve curve(file(), "made by hand\n\ntwice");
  curve.append({0, {0, 1. / 3, 1e-20}});
  curve.append({0.1, {2, -5, 12345678901.}});
  curve.close();
  EXPECT_EQ(read_file(file()),
            "# made by hand\n"
            "#\n"
            "# twice\n"
            "time_s,kinetic_j,elastic_j,gravitational_j,total_j\n"
            "0,0,0.3333333333,1e-20,0.3333333333\n"
            "0.1,2,-5,1.23456789e+10,1.23456789e+10\n");
}

TEST_F(EnergyCurveTest, RefusesNumbersThatAreNotFiniteAndTimesThatStandStill) {
  {
    EnergyCurve curve(file(), "");
    EXPECT_THROW(curve.append({0, {std::numeric_limits<double>::infinity(), 0, 0}}), std::invalid_argument);
    curve.append({1, {}});
    EXPECT_THROW(curve.append({1, {}}), std::invalid_argument);
  }
  EXPECT_FALSE(std::filesystem::exists(file()));
  EXPECT_EQ(read_file(temporary_of(file())),
            "time_s,kinetic_j,elastic_j,gravitational_j,total_j\n1,0,0,0,0\n");
}

TEST_F(EnergyCurveTest, KeepsItsSamplesWhenTheProcessIsKilled) {
  const int status = status_in_child([&] {
    EnergyCurve curve(file(), "");
    curve.append({0, {}});
    return std::raise(SIGKILL);
  });
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(read_file(temporary_of(file())),
            "time_s,kinetic_j,elastic_j,gravitational_j,total_j\n0,0,0,0,0\n");
}

TEST_F(EnergyCurveTest, LeavesNothingWithoutSamples) {
  { const EnergyCurve curve(file(), "a comment"); }
  EXPECT_TRUE(std::filesystem::is_empty(folder()));
}

/// An oscillation against gravity; the largest change, that of the kinetic energy, is 2 J.
Energy swinging_energy(double time_s) {
  return {1 + std::sin(10 * time_s), 0.5 - 0.5 * std::sin(10 * time_s), 1e-3 * std::cos(10 * time_s)};
}

struct Verdict {
  int status;
  std::string out, err;
};

class CheckEnergy : public TemporaryFolderTest {
 protected:
  CheckEnergy() {
    EnergyCurve curve(curve_, "made by a test");
    for (int i = 0; i <= 1000; ++i) curve.append({0.001 * i, swinging_energy(0.001 * i)});
    curve.close();
  }

  /// A trace of 21 frames up to `end_s`; `change` may alter what is written.
  void write_trace(const std::function<void(int frame, double& time_s, Energy& energy)>& change,
                   double end_s = 1) const {
    const System system = small_cloth(2, 2);
    TraceHeader header;
    header.creator_version = "test";
    H5mdTrace trace(trace_, system, header);
    for (int frame = 0; frame <= 20; ++frame) {
      double time_s = end_s * frame / 20;
      Energy energy = swinging_energy(time_s);
      change(frame, time_s, energy);
      trace.write_frame(frame, time_s, system.start, energy);
    }
    trace.close();
  }
  void write_right_trace() const {
    write_trace([](int, double&, Energy&) {});
  }

  /// Runs the script with these arguments, in the environment that `before` sets.
  Verdict run(const std::string& arguments, const std::string& before = "") const {
    const auto out = folder() / "out", err = folder() / "err";
    const std::string command = "cd '" + folder().string() + "' && " + before + " '" +
                                source_file("scripts/check-energy").string() + "' " + arguments + " >'" +
                                out.string() + "' 2>'" + err.string() + "'";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out), read_file(err)};
  }
  Verdict check(const std::string& tolerance) const { return run("trace.h5 curve.csv " + tolerance); }

  /// Expects exit status 2 and one sentence on stderr with this in it.
  void expect_complaint(const std::string& arguments, const std::string& part) const {
    const Verdict verdict = run(arguments);
    EXPECT_EQ(verdict.status, 2) << arguments;
    EXPECT_EQ(verdict.out, "");
    EXPECT_THAT(verdict.err, AllOf(StartsWith("check-energy: "), HasSubstr(part)));
    EXPECT_EQ(std::ranges::count(verdict.err, '\n'), 1) << verdict.err;
  }

  const std::filesystem::path trace_ = folder() / "trace.h5", curve_ = folder() / "curve.csv";
};

TEST_F(CheckEnergy, AcceptsARightTraceInAnyLocale) {
  write_right_trace();
  const Verdict verdict = check("1e-4");
  EXPECT_EQ(verdict.status, 0) << verdict.out << verdict.err;
  EXPECT_THAT(verdict.out, AllOf(HasSubstr("within the tolerance"), HasSubstr("21 frames")));
  EXPECT_EQ(verdict.err, "");
  EXPECT_EQ(run("trace.h5 curve.csv 1e-4", "LC_ALL=de_DE.UTF-8").status, 0);
}

TEST_F(CheckEnergy, NamesTimeEnergyAndValueOfOneWrongNumber) {
  write_trace([](int frame, double&, Energy& energy) {
    if (frame == 7) energy.elastic += 0.02;  // an error of 0.01 of the 2 J, in the total too
  });
  const Verdict verdict = check("9.9e-3");
  EXPECT_EQ(verdict.status, 1);
  EXPECT_THAT(verdict.out, AllOf(HasSubstr("largest error 0.01, beyond the tolerance 0.0099"),
                                 HasSubstr("energy at 0.35 s: ")));
  EXPECT_EQ(std::ranges::count(verdict.out, '\n'), 1);
  EXPECT_EQ(check("1.01e-2").status, 0);
}

TEST_F(CheckEnergy, JudgesEachOfTheThreeEnergiesEvenWhereTheTotalIsRight) {
  for (const auto member : {&Energy::kinetic, &Energy::elastic, &Energy::gravitational}) {
    write_trace([&](int frame, double&, Energy& energy) {
      if (frame != 20) return;
      energy.*member += 0.1;
      (member == &Energy::kinetic ? energy.elastic : energy.kinetic) -= 0.1;
    });
    EXPECT_EQ(check("1e-2").status, 1);
  }
}

TEST_F(CheckEnergy, RejectsATraceThatRunsLate) {
  write_trace([](int frame, double& time_s, Energy&) { time_s = 0.9 * time_s + 0.002 * (frame > 0); });
  EXPECT_EQ(check("1e-3").status, 1);
}

TEST_F(CheckEnergy, ReadsCurvesWithExponentsAndWindowsLineEnds) {
  write_right_trace();
  put("line.csv",
      "# two rows\r\ntime_s,kinetic_j,elastic_j,gravitational_j,total_j\r\n"
      "0E0,+1.e+02,-1e-3,.5,0\r\n1e0,-1.0E2,1e-3,5e-1,0\r\n");
  const Verdict verdict = run("trace.h5 line.csv 1");
  EXPECT_EQ(verdict.status, 0) << verdict.err;
  EXPECT_THAT(verdict.out, HasSubstr("J where the curve has -100 J"));
}

TEST_F(CheckEnergy, TakesFileNamesThatLookLikeOtherThings) {
  write_right_trace();
  std::filesystem::rename(trace_, folder() / "a \\n=b.h5");
  std::filesystem::rename(curve_, folder() / "c \\n=d.csv");
  EXPECT_EQ(run("'a \\n=b.h5' 'c \\n=d.csv' 1e-4").status, 0);
}

TEST_F(CheckEnergy, ComplainsAboutUsageAndTolerance) {
  write_right_trace();
  expect_complaint("", "usage");
  expect_complaint("trace.h5 curve.csv", "usage");
  for (const std::string tolerance : {"0", "-1", "nan", "inf", "1e999", "''", "1e-3x", "1,5"})
    expect_complaint("trace.h5 curve.csv " + tolerance, "must be a positive number");
}

TEST_F(CheckEnergy, ComplainsAboutFilesThatAreMissingEmptyOrOfAnotherKind) {
  write_right_trace();
  put("empty", "");
  expect_complaint("nothing.h5 curve.csv 1", "nothing.h5 is not a file");
  expect_complaint("trace.h5 . 1", ". is not a file");
  expect_complaint("trace.h5 empty 1", "empty is empty");
  expect_complaint("curve.csv curve.csv 1", "curve.csv holds no readable");
  expect_complaint("trace.h5 trace.xdmf 1", "trace.xdmf has");
}

TEST_F(CheckEnergy, ComplainsAboutTracesWithoutFramesWithNanOrBeyondTheCurve) {
  const System system = small_cloth(2, 2);
  H5mdTrace(trace_, system, {}).close();
  expect_complaint("trace.h5 curve.csv 1", "has no frames");
  for (const double wrong :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    write_trace([&](int frame, double&, Energy& energy) {
      if (frame == 3) energy.kinetic = wrong;
    });
    expect_complaint("trace.h5 curve.csv 1", "in frame 3, not a finite number");
  }
  write_trace([](int, double&, Energy&) {}, 1.01);
  expect_complaint("trace.h5 curve.csv 1", "has a frame at 1.01 s, but curve.csv goes from 0 to 1 s");
}

TEST_F(CheckEnergy, ComplainsAboutCurvesThatCannotBeUsed) {
  write_right_trace();
  const std::string head = "time_s,kinetic_j,elastic_j,gravitational_j,total_j\n";
  const std::array<std::pair<std::string, std::string>, 8> cases{{
      {"# only a comment\n", "has no header"},
      {"0,1,2,3,6\n1,1,2,3,6\n", "where the header"},
      {head + "0,1,2,3,6\n", "fewer than two rows"},
      {head + "0,1,2,3,6\n1,1,2,3\n", "has 4 values instead of 5 in line 3"},
      {head + "0,1,2,3,6\n1,nan,2,3,6\n", "\"nan\" in line 3"},
      {head + "0,1,2,3,6\n1,,2,3,6\n", "\"\" in line 3"},
      {head + "0,1,2,3,6\n0,2,2,3,7\n", "not later than the one before"},
      {head + "0,1,2,3,6\n1,1,2,3,6\n", "never changes"},
  }};
  for (const auto& [text, complaint] : cases) {
    put("bad.csv", text);
    expect_complaint("trace.h5 bad.csv 1", complaint);
  }
}

TEST_F(CheckEnergy, ExitsWith3WhenAProgramIsMissing) {
  write_right_trace();
  std::filesystem::create_directory(folder() / "bin");
  std::filesystem::create_symlink("/bin/sh", folder() / "bin" / "sh");
  const Verdict verdict = run("trace.h5 curve.csv 1", "PATH='" + (folder() / "bin").string() + "'");
  EXPECT_EQ(verdict.status, 3);
  EXPECT_THAT(verdict.err, HasSubstr("h5dump is missing"));
}

}  // namespace
}  // namespace mssim
