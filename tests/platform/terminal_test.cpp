#include <gtest/gtest.h>

#include "platform/machine.h"

namespace mssim {
namespace {

constexpr StreamFacts usual{.is_terminal = true, .columns = 120, .term = "xterm", .lang = "en_GB.UTF-8"};

TEST(Terminal, ShowsColoursAndKnowsItsWidth) {
  const Terminal terminal = terminal_with(usual);
  EXPECT_EQ(terminal.width, 120);
  EXPECT_TRUE(terminal.rewrites && terminal.colours && terminal.utf8);
}

TEST(Terminal, HasEightyColumnsWhereItDoesNotSay) {
  StreamFacts facts = usual;
  facts.columns = 0;
  EXPECT_EQ(terminal_with(facts).width, 80);
}

TEST(Terminal, IsNoneInAPipeWhateverTheEnvironmentSays) {
  StreamFacts facts = usual;
  facts.is_terminal = false;
  const Terminal terminal = terminal_with(facts);
  EXPECT_FALSE(terminal.width || terminal.rewrites || terminal.colours);
  EXPECT_TRUE(terminal.utf8);
}

TEST(Terminal, HasNoColoursWithAnyValueOfNoColor) {
  StreamFacts facts = usual;
  for (const char* value : {"1", "0", "no"}) {
    facts.no_color = value;
    EXPECT_FALSE(terminal_with(facts).colours) << value;
    EXPECT_TRUE(terminal_with(facts).rewrites) << value;
  }
}

TEST(Terminal, GetsNoEscapeSequencesWhereItIsDumbOrUnknown) {
  StreamFacts facts = usual;
  for (const char* term : {"dumb", ""}) {
    facts.term = term;
    EXPECT_FALSE(terminal_with(facts).rewrites || terminal_with(facts).colours) << term;
    EXPECT_EQ(terminal_with(facts).width, 120);
  }
}

TEST(Terminal, TakesTheLocaleOfTheFirstVariableThatIsSet) {
  EXPECT_TRUE(terminal_with({.lang = "C.utf8"}).utf8);
  EXPECT_FALSE(terminal_with({.lang = "de_DE.ISO-8859-1"}).utf8);
  EXPECT_FALSE(terminal_with({.lc_ctype = "C", .lang = "C.UTF-8"}).utf8);
  EXPECT_FALSE(terminal_with({.lc_all = "C", .lc_ctype = "C.UTF-8", .lang = "C.UTF-8"}).utf8);
  EXPECT_TRUE(terminal_with({.lc_all = "C.UTF-8", .lc_ctype = "C"}).utf8);
  EXPECT_FALSE(terminal_with({}).utf8);
}

}  // namespace
}  // namespace mssim
