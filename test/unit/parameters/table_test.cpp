#include "laparoscope_servo/parameters/table.h"

#include <gtest/gtest.h>

#include <cmath>

namespace laparoscope_servo::parameters {
namespace {

struct Joint {
  int number = 0;
  double angle = 0.0;
};

struct Config {
  double low = 0.1;
  double high = 0.4;
  double middle = 0.2;
  int count = 2;
  Joint joints[2] = {{1, 0.5}, {2, 0.6}};
};

void describe(Table& table, Config& c) {
  table.number("count", c.count, {0, 9}, "", "");
  table.group("bounds", "of what is measured", [&] {
    table.number("low", c.low, {0, 1}, "s", "");
    table.number("high", c.high, {0, 1}, "s", "").atLeast("low");
    table.group("inner", "", [&] { table.number("middle", c.middle, {0, 1}, "s", "").whileRunning(); });
  });
  table.numbers("angles", &c.joints[0].angle, 2, {0, 1}, "rad", "", sizeof(Joint));
}

TEST(Table, NamesRowsByTheirGroups) {
  Config config;
  Table table;
  describe(table, config);
  EXPECT_EQ(table.names(),
            (std::set<std::string>{"angles", "bounds/high", "bounds/inner/middle", "bounds/low", "count"}));
  EXPECT_EQ(table.meaningOfGroup("bounds"), "of what is measured");
  EXPECT_EQ(table.meaningOfGroup("bounds/inner"), "");
  ASSERT_NE(table.find("bounds/inner/middle"), nullptr);
  EXPECT_TRUE(table.find("bounds/inner/middle")->while_running);
  EXPECT_FALSE(table.find("bounds/low")->while_running);
  EXPECT_EQ(table.find("middle"), nullptr);
}

TEST(Table, ReadsAFieldOfSeveralStructsAsAList) {
  Config config;
  Table table;
  describe(table, config);
  EXPECT_EQ(table.find("angles")->get(), Value(std::vector<double>{0.5, 0.6}));
  EXPECT_EQ(table.find("angles")->take(std::vector<double>{0.7, 0.8}), "");
  EXPECT_EQ(config.joints[0].angle, 0.7);
  EXPECT_EQ(config.joints[1].angle, 0.8);
  EXPECT_EQ(config.joints[1].number, 2);
}

TEST(Table, NamesEveryErrorOfAConfiguration) {
  Config config;
  EXPECT_TRUE(errorsOf(config).empty());
  config.count = 10;
  config.middle = std::nan("");
  config.joints[1].angle = 1.5;
  EXPECT_EQ(errorsOf(config),
            (std::vector<std::string>{"count = 10, expected an integer in [0, 9]",
                                      "bounds/inner/middle = nan, expected a number in [0, 1] s",
                                      "angles[1] = 1.5, expected a list of 2 numbers in [0, 1] rad"}));
}

TEST(Table, ComparesParametersOfAGroup) {
  Config config;
  config.high = config.low;
  EXPECT_TRUE(errorsOf(config).empty());
  config.high = 0.05;
  EXPECT_EQ(errorsOf(config), std::vector<std::string>{"bounds/high = 0.05, expected at least low = 0.1"});
  config.low = 2.0;
  EXPECT_EQ(errorsOf(config), std::vector<std::string>{"bounds/low = 2, expected a number in [0, 1] s"})
      << "nothing is compared with what is wrong itself";
}

TEST(Table, KnowsFourWaysToCompare) {
  double value = 1.0;
  double other = 1.0;
  const auto errors = [&](Row& (Row::*relate)(const std::string&)) {
    Table table;
    table.number("other", other, Range::finite(), "", "");
    (table.number("value", value, Range::finite(), "", "").*relate)("other");
    return table.errors().size();
  };
  EXPECT_EQ(errors(&Row::atLeast) + errors(&Row::atMost), 0u);
  EXPECT_EQ(errors(&Row::above) + errors(&Row::below), 2u);
  value = 2.0;
  EXPECT_EQ(errors(&Row::atLeast) + errors(&Row::above), 0u);
  EXPECT_EQ(errors(&Row::atMost) + errors(&Row::below), 2u);
}

}  // namespace
}  // namespace laparoscope_servo::parameters
