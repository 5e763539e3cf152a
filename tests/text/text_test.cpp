#include "text/text.h"

#include <nlohmann/json.hpp>

#include "tests/support/testing.h"

namespace mssim {
namespace {

TEST(Columns, CountCharactersOfUtf8) {
  EXPECT_EQ(width_of(""), 0U);
  EXPECT_EQ(width_of("1.00× ▏✓"), 8U);
  EXPECT_EQ(width_of("あ日😀"), 6U);
}

TEST(Columns, ClipBetweenCharacters) {
  EXPECT_EQ(clipped("a×b", 2), "a×");
  EXPECT_EQ(clipped("a×b", 1), "a");
  EXPECT_EQ(clipped("a×b", 0), "");
  EXPECT_EQ(clipped("a×b", 3), "a×b");
  EXPECT_EQ(clipped("a×b", 4), "a×b");
}

TEST(FirstCharacter, IsAWholeOneOrOneByteOfNone) {
  const auto first = [](std::string_view text) {
    const auto [code, bytes] = first_character(text);
    return std::pair<std::uint32_t, std::size_t>(code, bytes);
  };
  EXPECT_EQ(first("ab"), std::pair(0x61U, std::size_t{1}));
  EXPECT_EQ(first("\u00e9b"), std::pair(0xe9U, std::size_t{2}));
  EXPECT_EQ(first("\u2026"), std::pair(0x2026U, std::size_t{3}));
  EXPECT_EQ(first("\U0001f600"), std::pair(0x1f600U, std::size_t{4}));
  for (const char* none : {"\xff", "\x80", "\xe2\x80", "\xed\xa0\x80"})
    EXPECT_EQ(first(none), std::pair(0xfffdU, std::size_t{1}));
}

TEST(TakeTo, TakesAllWhereTheEndIsMissing) {
  std::string_view text = "a\n\nb";
  EXPECT_EQ(take_to(text, "\n\n"), "a");
  EXPECT_EQ(take_to(text, "\n\n"), "b");
  EXPECT_EQ(take_to(text, "\n\n"), "");
}

TEST(Columns, WrapBetweenWords) {
  EXPECT_EQ(wrapped("one two three four", 9, ""), "one two\nthree\nfour");
  EXPECT_EQ(wrapped("one two three four", 9, "  "), "one two\n  three\n  four");
  EXPECT_EQ(wrapped("antidisestablishment is long", 10, ""), "antidisestablishment\nis long");
  EXPECT_EQ(wrapped("× × ×", 3, ""), "× ×\n×");
  EXPECT_EQ(wrapped("one line", 8, ""), "one line");
  EXPECT_EQ(wrapped("", 8, ""), "");
}

TEST(Bar, HasEighthsWithUtf8) {
  EXPECT_EQ(bar(1, 2, true), "██");
  EXPECT_EQ(bar(0.5, 2, true), "█");
  EXPECT_EQ(bar(9.0 / 16, 2, true), "█▏");
  EXPECT_EQ(bar(15.0 / 16, 2, true), "█▉");
}

TEST(Bar, HasWholeSignsWithoutUtf8) {
  EXPECT_EQ(bar(1, 4, false), "####");
  EXPECT_EQ(bar(0.6, 4, false), "##");
}

TEST(Bar, ShowsWhatIsAboveZeroAndNoMoreThanAll) {
  EXPECT_EQ(bar(1e-6, 10, true), "▏");
  EXPECT_EQ(bar(1e-6, 10, false), "#");
  EXPECT_EQ(bar(0, 10, true), "");
  EXPECT_EQ(bar(1.5, 2, false), "##");
}

TEST(Counted, HasAPluralButForOne) {
  EXPECT_EQ(pluralize(0, "row"), "0 rows");
  EXPECT_EQ(pluralize(1, "thread"), "1 thread");
  EXPECT_EQ(pluralize(2, "logical CPU"), "2 logical CPUs");
}

TEST(FixedDecimal, HasTheDigitsAskedFor) {
  EXPECT_EQ(fixed_decimal(0.1, 3), "0.100");
  EXPECT_EQ(fixed_decimal(-2.45678, 2), "-2.46");
  EXPECT_EQ(fixed_decimal(1e9, 0), "1000000000");
  EXPECT_EQ(fixed_decimal(3e-5, 6), "0.000030");
  EXPECT_EQ(fixed_decimal(-std::numeric_limits<double>::max(), 2).size(), 313u);
}

TEST(ThreeDigits, AreSignificantOnes) {
  EXPECT_EQ(three_digits(1.23456), "1.23");
  EXPECT_EQ(three_digits(0.0123456), "0.0123");
  EXPECT_EQ(three_digits(123456), "123456");
  EXPECT_EQ(three_digits(0), "0.00");
  EXPECT_EQ(three_digits(-0.0123456), "-0.0123");
  // Rounding carries into one more digit.
  EXPECT_EQ(three_digits(0.9996), "1.00");
  EXPECT_EQ(three_digits(99.96), "100");
}

TEST(TwoDigits, HaveAnExponentWhereTheNumberIsSmallOrLarge) {
  EXPECT_EQ(two_digits(2.14e-7), "2.1e-07");
  EXPECT_EQ(two_digits(0.000999), "0.001");
  EXPECT_EQ(two_digits(-60), "-60");
  EXPECT_EQ(two_digits(120), "1.2e+02");
  EXPECT_EQ(two_digits(0), "0");
}

TEST(Hash, EqualsThePublishedTestVectors) {
  // From the FNV draft's appendix.
  EXPECT_EQ(fnv1a_64(""), 0xcbf29ce484222325U);
  EXPECT_EQ(fnv1a_64("a"), 0xaf63dc4c8601ec8cU);
  EXPECT_EQ(fnv1a_64("foobar"), 0x85944171f73967e8U);
}

TEST(Hash, IsWrittenWithAllItsDigits) { EXPECT_EQ(to_hex(0x0123456789abcdefU), "0123456789abcdef"); }

TEST(NoteTest, JoinsSentencesAndLeavesOutEmptyOnes) {
  std::string note;
  append_sentence(note, "");
  EXPECT_EQ(note, "");
  append_sentence(note, "one");
  append_sentence(note, "");
  EXPECT_EQ(note, "one");
  append_sentence(note, "another");
  EXPECT_EQ(note, "one; another");
}

TEST(NumberIn, ReadsTheWholeTextWithOrWithoutASign) {
  EXPECT_EQ(number_in<int>("12"), 12);
  EXPECT_EQ(number_in<int>("+12"), 12);
  EXPECT_EQ(number_in<int>("-12"), -12);
  EXPECT_EQ(number_in<double>("1e-3"), 1e-3);
  EXPECT_EQ(number_in<double>("+0.5"), 0.5);
}

TEST(NumberIn, RefusesWhatIsNoNumberOrNotOnlyOne) {
  for (const char* text : {"", "+", "-", "+-1", "--1", "1 ", " 1", "1x", "x", "0x10", "1,5"}) {
    EXPECT_EQ(number_in<int>(text), std::nullopt) << text;
    EXPECT_EQ(number_in<double>(text), std::nullopt) << text;
  }
}

TEST(NumberIn, RefusesWhatDoesNotFit) {
  EXPECT_EQ(number_in<std::int64_t>("9223372036854775807"), INT64_MAX);
  EXPECT_EQ(number_in<std::int64_t>("9223372036854775808"), std::nullopt);
  EXPECT_EQ(number_in<int>("2147483648"), std::nullopt);
  EXPECT_EQ(number_in<int>("1.0"), std::nullopt);
  EXPECT_EQ(number_in<double>("1e400"), std::nullopt);
}

TEST(NumbersIn, AreThoseBetweenCommasOrNone) {
  EXPECT_EQ(numbers_in<int>("4"), std::vector{4});
  EXPECT_EQ(numbers_in<int>("4,1,2"), (std::vector{4, 1, 2}));
  for (const char* text : {"", ",", "1,,2", "1,", ",1", "1,x"})
    EXPECT_TRUE(numbers_in<int>(text).empty()) << text;
}

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

TEST(Lists, AreMappedSearchedAndHoldAValueOnce) {
  std::vector<OtherName> names{{"a", "A"}, {"b", "B"}};
  EXPECT_EQ(mapped<std::string>(names, &OtherName::meant), (std::vector<std::string>{"A", "B"}));
  EXPECT_EQ(found_in(names, "b", &OtherName::typed), &names[1]);
  EXPECT_EQ(found_in(names, "B", &OtherName::typed), nullptr);
  std::vector<int> numbers{1};
  for (const int number : {1, 2, 2}) add_once(numbers, number);
  EXPECT_EQ(numbers, (std::vector<int>{1, 2}));
}

}  // namespace
}  // namespace mssim
