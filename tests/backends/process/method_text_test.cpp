#include <gtest/gtest.h>

#include "backends/process/process_backend.h"
#include "integrators/all_integrators.h"

namespace mssim {
namespace {

TEST(MethodText, NamesStagesAndTerms) {
  EXPECT_EQ(method_text(*find_integrator("midpoint")),
            "integrator midpoint\n"
            "stage x v\n"
            "assign x_a 1 0 x 0.5 1 v\n"
            "assign v_a 1 0 v 0.5 1 a\n"
            "stage x_a v_a\n"
            "assign x_next 1 0 x 1 1 v_a\n"
            "assign v_next 1 0 v 1 1 a\n");
}

TEST(MethodText, WritesCoefficientsThatReadBack) {
  EXPECT_NE(
      method_text(*find_integrator("rk4-frozen")).find(" 0.16666666666666666 1 v 0.66666666666666663 1 "),
      std::string::npos);
}

}  // namespace
}  // namespace mssim
