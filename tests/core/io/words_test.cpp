#include "core/io/words.h"

#include <gtest/gtest.h>

#include <limits>

namespace lamella {
namespace {

TEST(Words, SplitsAtWhiteSpaceAndSkipsComments) {
  Words words("  one\ttwo # three\n\r\nfour#five");
  EXPECT_EQ(words.peek(), "one");
  EXPECT_EQ(words.next(), "one");
  EXPECT_EQ(words.next(), "two");
  EXPECT_EQ(words.line(), 1u);
  EXPECT_EQ(words.next(), "four#five");
  EXPECT_EQ(words.line(), 3u);
  EXPECT_EQ(words.next(), "");
  EXPECT_DOUBLE_EQ(words.fraction(), 1);
}

TEST(Words, ReadsWholeNumbersOnly) {
  Words words("+1.5 -2e3 7 1x 3.5 1e-400 +");
  double d = 0;
  std::int64_t i = 0;
  EXPECT_TRUE(words.read(d));
  EXPECT_EQ(d, 1.5);
  EXPECT_TRUE(words.read(d));
  EXPECT_EQ(d, -2000);
  EXPECT_TRUE(words.read(i));
  EXPECT_EQ(i, 7);
  EXPECT_FALSE(words.read(d));
  EXPECT_EQ(words.last(), "1x");
  EXPECT_FALSE(words.read(i));
  EXPECT_TRUE(words.read(d));
  EXPECT_EQ(d, 0);  // below the smallest double
  EXPECT_FALSE(words.read(d));
  EXPECT_FALSE(words.read(d));
}

TEST(TextBuilder, WritesDigitsThatReadBackToTheSameValue) {
  for (const double value : {1 / 3.0, 1e-300, -0.1, std::numeric_limits<double>::max()}) {
    TextBuilder out;
    out << "x " << value << '\n' << 42;
    Words words(out.text());
    EXPECT_EQ(words.next(), "x");
    double back = 0;
    EXPECT_TRUE(words.read(back));
    EXPECT_EQ(back, value);
    EXPECT_EQ(words.next(), "42");
  }
}

}  // namespace
}  // namespace lamella
