#include "laparoscope_servo/parameters/row.h"

#include <gtest/gtest.h>

#include <cmath>

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::parameters {
namespace {

using Texts = std::vector<std::string>;
using Numbers = std::vector<double>;

enum class Colour { kRed, kGreen };

struct Config {
  bool flag = true;
  int count = 3;
  double share = 0.5;
  std::string word = "a";
  Colour colour = Colour::kGreen;
  Numbers list{1.0, 2.0};
  double three[3] = {1.0, 2.0, 3.0};
  Texts names{"x"};
};

class RowTest : public testing::Test {
 protected:
  Config config_;
  Table table_;
  Row& flag_ = table_.flag("flag", config_.flag, "");
  Row& count_ = table_.number("count", config_.count, {0, 5}, "images", "");
  Row& share_ = table_.number("share", config_.share, Range::above(0.0, 1.0), "", "");
  Row& word_ = table_.text("word", config_.word, "");
  Row& colour_ = table_.choice("colour", config_.colour, {"red", "green"}, "");
  Row& list_ = table_.numbers("list", config_.list, 0, {0, 10}, "m", "");
  Row& three_ = table_.numbers("three", config_.three, 3, Range::finite(), "", "");
  Row& names_ = table_.texts("names", config_.names, "");
};

TEST_F(RowTest, GetsWhatTheConfigurationHolds) {
  EXPECT_EQ(flag_.get(), Value(true));
  EXPECT_EQ(count_.get(), Value(3));
  EXPECT_EQ(share_.get(), Value(0.5));
  EXPECT_EQ(word_.get(), Value(std::string("a")));
  EXPECT_EQ(colour_.get(), Value(std::string("green")));
  EXPECT_EQ(list_.get(), Value(Numbers{1.0, 2.0}));
  EXPECT_EQ(three_.get(), Value(Numbers{1.0, 2.0, 3.0}));
  EXPECT_EQ(names_.get(), Value(Texts{"x"}));
}

TEST_F(RowTest, TakesWhatIsRight) {
  EXPECT_EQ(flag_.take(false), "");
  EXPECT_EQ(count_.take(5), "");
  EXPECT_EQ(share_.take(1), "") << "a whole number is a number";
  EXPECT_EQ(word_.take(std::string("b")), "");
  EXPECT_EQ(colour_.take(std::string("red")), "");
  EXPECT_EQ(list_.take(Numbers{}), "");
  EXPECT_EQ(three_.take(Numbers{4.0, 5.0, 6.0}), "");
  EXPECT_EQ(names_.take(Numbers{}), "") << "an empty list is one of anything";
  EXPECT_FALSE(config_.flag);
  EXPECT_EQ(config_.count, 5);
  EXPECT_EQ(config_.share, 1.0);
  EXPECT_EQ(config_.word, "b");
  EXPECT_EQ(config_.colour, Colour::kRed);
  EXPECT_TRUE(config_.list.empty());
  EXPECT_EQ(config_.three[2], 6.0);
  EXPECT_TRUE(config_.names.empty());
}

TEST_F(RowTest, RefusesAndKeepsWhatItHad) {
  EXPECT_EQ(flag_.take(1), " = 1 is an integer, expected true or false");
  EXPECT_EQ(count_.take(6), " = 6, expected an integer in [0, 5] images");
  EXPECT_EQ(count_.take(1.0), " = 1 is a number, expected an integer in [0, 5] images");
  EXPECT_EQ(share_.take(0.0), " = 0, expected a number in (0, 1]");
  EXPECT_EQ(share_.take(std::nan("")), " = nan, expected a number in (0, 1]");
  EXPECT_EQ(word_.take(5), " = 5 is an integer, expected a string");
  EXPECT_EQ(colour_.take(std::string("pink")), " = 'pink', expected one of: red, green");
  EXPECT_EQ(list_.take(Numbers{1.0, 11.0}), "[1] = 11, expected a list of numbers in [0, 10] m");
  EXPECT_EQ(three_.take(Numbers{1.0}), " has 1 elements, expected a list of 3 numbers");
  EXPECT_EQ(three_.take(Numbers{1.0, std::nan(""), 1.0}), "[1] = nan, expected a list of 3 numbers");
  EXPECT_EQ(names_.take(Numbers{1.0}), " is a list of numbers, expected a list of strings");
  EXPECT_EQ(config_.count, 3);
  EXPECT_EQ(config_.share, 0.5);
  EXPECT_EQ(config_.colour, Colour::kGreen);
  EXPECT_EQ(config_.three[0], 1.0);
}

TEST_F(RowTest, JudgesTexts) {
  const auto is_long = [](const std::string& text) { return text.size() > 2; };
  word_.accepting("a long word", is_long);
  names_.accepting("a long word", is_long);
  EXPECT_EQ(word_.take(std::string("no")), " = 'no', expected a long word");
  EXPECT_EQ(word_.take(std::string("yes")), "");
  EXPECT_EQ(names_.take(Texts{"yes", "no"}), "[1] = 'no', expected a list of strings, each a long word");
}

}  // namespace
}  // namespace laparoscope_servo::parameters
