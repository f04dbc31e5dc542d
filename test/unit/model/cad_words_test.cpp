#include "model/cad_words.h"

#include <gtest/gtest.h>

#include <functional>
#include <sstream>
#include <string>

#include "laparoscope_servo/model/cad_model.h"
#include "support/error_text.h"

namespace laparoscope_servo::model {
namespace {

CadWords wordsOf(const std::string& text) {
  std::istringstream stream(text);
  return {stream, "tool.cao"};
}

std::string refusal(const std::string& text, const std::function<void(CadWords&)>& read) {
  CadWords words = wordsOf(text);
  return test_support::errorText<CadFileError>([&] { read(words); });
}

TEST(CadWords, comeInTheirOrderWithoutComments) {
  CadWords words = wordsOf("V1 # a version\n\n 3 0.25  -1e-3\n# nothing\nend");
  EXPECT_EQ(words.peek(), "V1");
  EXPECT_EQ(words.next("a version"), "V1");
  EXPECT_EQ(words.integer(0, 3, "a count"), 3);
  EXPECT_EQ(words.number("a length"), 0.25);
  EXPECT_EQ(words.number("a length"), -1e-3);
  EXPECT_EQ(words.next("the end"), "end");
  EXPECT_EQ(words.peek(), "");
}

TEST(CadWords, aNumberHasToBeAFiniteNumberAndNothingElse) {
  const auto number = [](CadWords& words) { words.number("a length"); };
  EXPECT_EQ(refusal("1.5", number), "");
  for (const std::string text : {"nan", "-nan", "inf", "-inf", "1e999", "1.5m", "x"}) {
    EXPECT_EQ(refusal("\n" + text, number), "tool.cao, line 2: " + text + ", expected a length");
  }
}

TEST(CadWords, aWholeNumberHasToBeOneWithinItsRange) {
  const auto integer = [](CadWords& words) { words.integer(1, 9, "a count"); };
  EXPECT_EQ(refusal("9", integer), "");
  for (const std::string text : {"0", "10", "2.5", "nan", "99999999999999999999", "-99999999999999999999", "3x"}) {
    EXPECT_EQ(refusal(text, integer), "tool.cao, line 1: " + text + ", expected a count, a whole number from 1 to 9");
  }
}

TEST(CadWords, whatIsNoTextIsShownInShort) {
  EXPECT_EQ(refusal("\x7f\x01" + std::string(5000, 'x'), [](CadWords& words) { words.number("a length"); }),
            "tool.cao, line 1: ??" + std::string(58, 'x') + "..., expected a length");
}

TEST(CadWords, aFileThatEndsNamesItsLastLine) {
  EXPECT_EQ(refusal("1\n2\n",
                    [](CadWords& words) {
                      for (int k = 0; k < 3; ++k) words.number("a length");
                    }),
            "tool.cao, line 2: the file ends, expected a length");
}

}  // namespace
}  // namespace laparoscope_servo::model
