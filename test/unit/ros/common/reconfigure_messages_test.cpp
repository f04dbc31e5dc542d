#include "ros/common/reconfigure_messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "ros/controller/controller_parameters.h"
#include "ros/tracker/tracker_parameters.h"

namespace laparoscope_servo {
namespace {

using dynamic_reconfigure::Config;
using parameters::Value;

struct Settings {
  double gain = 0.5;
  int count = 3;
  bool robust = true;
  std::string mode = "slow";
  double limit = 1.0;
};

void describe(parameters::Table& table, Settings& s) {
  table.group("law", "", [&] {
    table.number("gain", s.gain, {0, 5}, "1/s", "of the law").whileRunning();
    table.number("count", s.count, {1, 9}, "images", "in a row").whileRunning();
    table.flag("robust", s.robust, "or not").whileRunning();
    table.choice("mode", s.mode, {"slow", "fast"}, "of it").whileRunning();
  });
  table.number("limit", s.limit, {0, 2}, "m/s", "of the motion");
}

template <class List, class T>
void add(List& list, const std::string& name, T value) {
  list.emplace_back();
  list.back().name = name;
  list.back().value = value;
}

class ReconfigureMessages : public testing::Test {
 protected:
  ReconfigureMessages() { describe(table_, settings_); }
  Settings settings_;
  parameters::Table table_;
};

TEST_F(ReconfigureMessages, TellOfWhatMayChangeOnly) {
  const auto description = describeForReconfigure(table_);
  ASSERT_EQ(description.groups.size(), 1u);
  ASSERT_EQ(description.groups[0].parameters.size(), 4u);
  EXPECT_EQ(description.groups[0].parameters[0].name, "law__gain");
  EXPECT_EQ(description.groups[0].parameters[0].type, "double");
  EXPECT_EQ(description.groups[0].parameters[0].description, "a number in [0, 5] 1/s: of the law");
  EXPECT_EQ(description.groups[0].parameters[1].type, "int");
  EXPECT_EQ(description.groups[0].parameters[2].type, "bool");
  EXPECT_EQ(description.groups[0].parameters[3].type, "str");
  EXPECT_EQ(description.min.doubles.at(0).value, 0.0);
  EXPECT_EQ(description.max.doubles.at(0).value, 5.0);
  EXPECT_EQ(description.max.ints.at(0).value, 9);
  EXPECT_EQ(description.dflt.doubles.at(0).value, 0.5);
  EXPECT_EQ(description.dflt.strs.at(0).value, "slow");
}

TEST_F(ReconfigureMessages, SetAllThatIsAskedFor) {
  Config wanted;
  add(wanted.doubles, "law__gain", 1.5);
  add(wanted.ints, "law/count", 4);
  add(wanted.bools, "law__robust", false);
  add(wanted.strs, "law__mode", "fast");
  EXPECT_TRUE(setFromReconfigure(table_, wanted).empty());
  EXPECT_EQ(settings_.gain, 1.5);
  EXPECT_EQ(settings_.count, 4);
  EXPECT_FALSE(settings_.robust);
  EXPECT_EQ(settings_.mode, "fast");
  EXPECT_EQ(valuesForReconfigure(table_).doubles.at(0).value, 1.5);
  EXPECT_TRUE(setFromReconfigure(table_, Config()).empty()) << "nothing asked, nothing refused";
}

TEST_F(ReconfigureMessages, RefuseAsAWholeAndNameEveryError) {
  Config wanted;
  add(wanted.ints, "law__count", 4);  // the only one that is right
  add(wanted.doubles, "law__gain", std::nan(""));
  add(wanted.doubles, "law__gian", 1.0);
  add(wanted.doubles, "limit", 1.5);
  add(wanted.doubles, "law__robust", 1.0);
  add(wanted.strs, "law__mode", "faster");
  add(wanted.strs, "law__mode", "fast");
  EXPECT_EQ(setFromReconfigure(table_, wanted),
            (std::vector<std::string>{"law/gain = nan, expected a number in [0, 5] 1/s",
                                      "law/gian is no parameter of this node; is law/gain meant?",
                                      "limit may not change while the node runs",
                                      "law/robust = 1 is a number, expected true or false",
                                      "law/mode = 'faster', expected one of: slow, fast", "law/mode is there twice"}));
  EXPECT_EQ(settings_.count, 3);
  EXPECT_EQ(settings_.gain, 0.5);
  EXPECT_EQ(settings_.mode, "slow");
}

TEST(ReconfigureName, IsACIdentifierThatLeadsBack) {
  EXPECT_EQ(reconfigureName("tracking/quality/min_zncc"), "tracking__quality__min_zncc");
  EXPECT_EQ(pathOfReconfigureName("tracking__quality__min_zncc"), "tracking/quality/min_zncc");
  EXPECT_EQ(pathOfReconfigureName("tracking/quality/min_zncc"), "tracking/quality/min_zncc");
}

// Of both nodes: what may change is a threshold or a gain, and no more.
template <class Config>
std::vector<std::string> changeableOf() {
  Config config;
  parameters::Table table;
  describe(table, config);
  std::vector<std::string> names;
  for (const auto& [name, value] : changeable(table)) {
    EXPECT_TRUE(std::regex_match(reconfigureName(name), std::regex("[A-Za-z_]\\w*"))) << name;
    EXPECT_EQ(pathOfReconfigureName(reconfigureName(name)), name);
    names.push_back(name);
  }
  return names;
}

TEST(Changeable, NeitherLimitsNorFramesNorOwners) {
  for (const std::vector<std::string>& names :
       {changeableOf<ControllerNodeConfig>(), changeableOf<TrackerParameters>()}) {
    EXPECT_GT(names.size(), 10u);
    for (const std::string& name : names) {
      EXPECT_FALSE(
          std::regex_search(name, std::regex("^(safety|limits|range|effect|dead_zone|insertion_point|horizon|"
                                             "predictor|frames|owners|master|stop_line|oscillation|input|image|"
                                             "robot_motion|roi|rect|frame_prefix|rate|views)")))
          << name;
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo
