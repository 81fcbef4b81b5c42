// SPDX-License-Identifier: BSD-3-Clause
// Text of files in messages.
#include <csom/io/TextParser.h>
#include <gtest/gtest.h>

namespace csom::detail {
namespace {

TEST(TextParser, PrintableTextSteersNoTerminal) {
  EXPECT_EQ(printable("a b"), "a b");
  EXPECT_EQ(printable("Stra\xc3\x9f"
                      "e \xe2\x80\xa6"),
            "Stra\xc3\x9f"
            "e \xe2\x80\xa6");
  EXPECT_EQ(printable("\x1b[2J\r\n\t\x7f"), "?[2J????");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J"),
            "?2J")
      << "the other way to write ESC [";
  EXPECT_EQ(printable("\xc2\xb5m"), "\xc2\xb5m");
}

TEST(TextParser, QuotedWordsAreShort) {
  EXPECT_EQ(detail::quoted("a\nb"), "'a?b'");
  EXPECT_EQ(detail::quoted(std::string(61, 'x')), "'" + std::string(60, 'x') + "…'");
}

TEST(TextParser, B8_PrintableTextTurnsNothingRoundAndHidesNothing) {
  EXPECT_EQ(printable("a\xe2\x80\xae"
                      "b"),
            "a?b")
      << "right to left from here on";
  EXPECT_EQ(printable("a\xe2\x80\x8b"
                      "b"),
            "a?b")
      << "a space of no width";
  EXPECT_EQ(printable("\xff\xc0\xafx\xe2\x80"), "???x??") << "no UTF-8";
}

TEST(TextParser, QuotedWordsEndBetweenCharacters) {
  const std::string start(59, 'x');
  EXPECT_EQ(detail::quoted(start + "\xc3\xa9" + "yy"), "'" + start + "…'");
}

TEST(TextParser, LowerCaseLeavesAllButLettersOfAsciiAsItIs) {
  EXPECT_EQ(lowerCase("AbZ_09[\xc3\x84"), "abz_09[\xc3\x84");
}

TEST(TextParser, JoinsWords) {
  EXPECT_EQ(joined({}), "");
  EXPECT_EQ(joined({"a"}), "a");
  EXPECT_EQ(joined({"a", "b"}), "a, b");
}

}  // namespace
}  // namespace csom::detail
