#include "output/energy_curve.h"

#include <array>
#include <limits>
#include <stdexcept>

#include "output_fixture.h"

namespace mssim {
namespace {

class EnergyCurve : public TemporaryFolderTest {};

TEST_F(EnergyCurve, StandsInTheFileBehindItsCommentWithTenDigits) {
  const std::array<EnergySample, 2> samples{{{0, {0, 1. / 3, 1e-20}}, {0.1, {2, -5, 12345678901.}}}};
  write_energy_curve(folder() / "curve.csv", samples, "made by hand\n\ntwice");
  EXPECT_EQ(text_of(folder() / "curve.csv"),
            "# made by hand\n"
            "#\n"
            "# twice\n"
            "time_s,kinetic_j,elastic_j,gravitational_j,total_j\n"
            "0,0,0.3333333333,1e-20,0.3333333333\n"
            "0.1,2,-5,1.23456789e+10,1.23456789e+10\n");
}

TEST_F(EnergyCurve, IsNotWrittenWithNumbersThatAreNotFiniteOrTimesThatStandStill) {
  const auto file = folder() / "curve.csv";
  const std::array<EnergySample, 1> infinite{{{0, {std::numeric_limits<double>::infinity(), 0, 0}}}};
  const std::array<EnergySample, 2> still{{{1, {}}, {1, {}}}};
  EXPECT_THROW(write_energy_curve(file, infinite, ""), std::invalid_argument);
  EXPECT_THROW(write_energy_curve(file, still, ""), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace mssim
