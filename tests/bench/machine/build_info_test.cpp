#include "bench/machine/build_info.h"

#include <gtest/gtest.h>

#include <string>

namespace mssim {
namespace {

TEST(BuildInfo, NamesTheCommitInFullOrSaysThatItIsUnknown) {
  const std::string_view commit = build_info().commit;
  if (commit == "unknown") {
    EXPECT_FALSE(build_info().dirty) << "without a commit there is nothing to differ from";
  } else {
    EXPECT_EQ(commit.size(), 40U);
    EXPECT_EQ(commit.find_first_not_of("0123456789abcdef"), std::string_view::npos) << commit;
  }
}

TEST(BuildInfo, TellsTheFlagsAndTheBuildTypeThatItWasCompiledWith) {
  std::string flags(build_info().flags);
  flags.insert(0, 1, ' ').push_back(' ');
#ifdef __OPTIMIZE__
  EXPECT_EQ(flags.find(" -O0 "), std::string::npos) << flags;
  EXPECT_NE(flags.find(" -O"), std::string::npos) << flags;
#else
  for (const char* level : {" -O1 ", " -O2 ", " -O3 "})
    EXPECT_EQ(flags.find(level), std::string::npos) << flags;
#endif
#ifdef NDEBUG
  EXPECT_NE(flags.find(" -DNDEBUG "), std::string::npos) << flags;
#else
  EXPECT_EQ(flags.find(" -DNDEBUG "), std::string::npos) << flags;
#endif
  EXPECT_NE(flags.find(" -fopenmp"), std::string::npos) << flags;
  EXPECT_NE(flags.find(" -ffp-contract=off "), std::string::npos) << flags;
  EXPECT_EQ(flags.find("$<"), std::string::npos) << "an expression that CMake left unevaluated: " << flags;
  EXPECT_FALSE(build_info().build_type.empty());
}

TEST(BuildInfo, TellsTheCompilerThatItWasCompiledWith) {
  const std::string compiler(build_info().compiler);
#if defined(__clang__)
  const std::string version = __clang_version__;  // Debian's ends with a blank
  EXPECT_EQ(compiler, "Clang " + version.substr(0, version.find(' ')));
#elif defined(__GNUC__)
  EXPECT_EQ(compiler, "GNU " + std::to_string(__GNUC__) + "." + std::to_string(__GNUC_MINOR__) + "." +
                          std::to_string(__GNUC_PATCHLEVEL__));
#endif
}

}  // namespace
}  // namespace mssim
