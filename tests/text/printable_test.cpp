#include "text/printable.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace mssim {
namespace {

TEST(Escaped, LeavesValidUtf8AsItIs) {
  for (const std::string text : {"", "cloth2500", "a b,c\"\\", "\xC3\xA4\xE2\x82\xAC\xF0\x9F\xA7\xB5"})
    EXPECT_EQ(escaped(text), text);
}

TEST(Escaped, WritesControlCharactersByteByByte) {
  EXPECT_EQ(escaped("a\nb\x1b\x7f"), "a\\x0ab\\x1b\\x7f");
  EXPECT_EQ(escaped("\xC2\x9B"), "\\xc2\\x9b");  // U+009B begins a terminal's command
}

TEST(Escaped, WritesWhatIsNoUtf8ByteByByte) {
  EXPECT_EQ(escaped("caf\xe9!"), "caf\\xe9!");
  EXPECT_EQ(escaped("\xC0\x80"), "\\xc0\\x80");                    // longer than needed
  EXPECT_EQ(escaped("\xED\xA0\x80"), "\\xed\\xa0\\x80");           // a surrogate
  EXPECT_EQ(escaped("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond Unicode
  EXPECT_EQ(escaped("\xE2\x82"), "\\xe2\\x82");                    // cut short
}

TEST(Escaped, IsWhatJsonTakes) {
  std::string every;
  for (int byte = 1; byte < 256; ++byte) every += static_cast<char>(byte);
  EXPECT_NO_THROW(nlohmann::json(escaped(every)).dump());
  EXPECT_EQ(escaped(escaped(every)), escaped(every));
}

}  // namespace
}  // namespace mssim
