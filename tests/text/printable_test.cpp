#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "text/text.h"

namespace mssim {
namespace {

TEST(Printable, LeavesTextAsItIsAndEscapesControlCharactersAsJsonDoes) {
  const std::string plain = "a \"b\" \\ \xC3\xA4\xE2\x82\xAC\xF0\x9F\xA7\xB5";
  EXPECT_EQ(printable(plain), plain);
  EXPECT_EQ(printable(std::string("\b\t\n\f\r\x1b\0", 7)), "\\b\\t\\n\\f\\r\\u001b\\u0000");
  EXPECT_EQ(printable("\x7F|\xC2\x80|\xC2\x9F|\xC2\xA0"), "\\u007f|\\u0080|\\u009f|\xC2\xA0");
}

TEST(Printable, ReplacesWhatIsNoUtf8) {
  const std::string mark = "\xEF\xBF\xBD";  // U+FFFD
  EXPECT_EQ(printable("caf\xE9!"), "caf" + mark + '!');
  EXPECT_EQ(printable("\xC0\x80"), mark + mark);
  EXPECT_EQ(printable("\xED\xA0\x80"), mark + mark + mark);
}

TEST(Printable, CutsLongTextBetweenCharacters) {
  EXPECT_EQ(printable("abcdef", 6), "abcdef");
  EXPECT_EQ(printable("abcdef", 5), "abcde...");
  EXPECT_EQ(printable("ab\xE2\x82\xAC!", 4), "ab...");
}

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
