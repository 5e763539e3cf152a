#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "output/traces/energy_curve.h"

namespace mssim {
namespace {

std::string problem_of(const std::string& name) { return trace_name_problem(name).value_or("none"); }

TEST(TraceName, IsGoodWhereItEndsInH5AndIsPrintable) {
  for (const std::string name :
       {"t.h5", "out/fall.h5", "/a:b/t.h5", "the 'trace' & more.h5", "t.x.h5", "\xC3\xA4.h5"})
    EXPECT_EQ(problem_of(name), "none") << name;
}

TEST(TraceName, EndsInH5) {
  EXPECT_EQ(problem_of("out/t.txt"), "\"t.txt\" is not a name of the form NAME.h5: give t.h5");
  EXPECT_EQ(problem_of("t"), "\"t\" is not a name of the form NAME.h5: give t.h5");
  EXPECT_EQ(problem_of(".h5"), "\".h5\" is not a name of the form NAME.h5: give .h5.h5");
  EXPECT_EQ(problem_of("out/"), "\"\" is not a name of the form NAME.h5: give a file in that folder");
}

TEST(TraceName, HasNothingThatReadersOfTheXdmfFileMisread) {
  for (const std::string name : {"a:b.h5", "a|b.h5", "a\\b.h5"})
    EXPECT_THAT(problem_of(name),
                testing::HasSubstr("readers of the XDMF file misread: give a name without"));
  for (const std::string name : {"a\nb.h5", "a\x1b.h5", "caf\xe9.h5"})
    EXPECT_THAT(problem_of(name), testing::HasSubstr("has characters that are not printable"));
  for (const std::string name : {" t.h5", "t .h5"})
    EXPECT_THAT(problem_of(name), testing::HasSubstr("begins or ends with a blank"));
}

}  // namespace
}  // namespace mssim
