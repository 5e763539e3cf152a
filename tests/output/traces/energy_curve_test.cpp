#include "output/traces/energy_curve.h"

#include <csignal>
#include <limits>
#include <stdexcept>

#include "tests/support/output_fixture.h"

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
  EXPECT_EQ(text_of(file()),
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
  EXPECT_EQ(text_of(temporary_of(file())), "time_s,kinetic_j,elastic_j,gravitational_j,total_j\n1,0,0,0,0\n");
}

TEST_F(EnergyCurveTest, KeepsItsSamplesWhenTheProcessIsKilled) {
  const int status = status_in_child([&] {
    EnergyCurve curve(file(), "");
    curve.append({0, {}});
    return std::raise(SIGKILL);
  });
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(text_of(temporary_of(file())), "time_s,kinetic_j,elastic_j,gravitational_j,total_j\n0,0,0,0,0\n");
}

TEST_F(EnergyCurveTest, LeavesNothingWithoutSamples) {
  { const EnergyCurve curve(file(), "a comment"); }
  EXPECT_TRUE(std::filesystem::is_empty(folder()));
}

}  // namespace
}  // namespace mssim
