#include "screen/parameter_link.h"

#include <gtest/gtest.h>

#include <QtTest>

#include "ros/common/reconfigure_messages.h"
#include "screen/minute_limits.h"
#include "screen/parameter_panel.h"

namespace laparoscope_servo::screen {
namespace {

using dynamic_reconfigure::Config;
using dynamic_reconfigure::ConfigDescription;

class ParameterLinkTest : public testing::Test {
 protected:
  void SetUp() override {
    dynamic_reconfigure::Group group;
    for (const auto& [name, type] :
         {std::pair{"tracking__quality__min_zncc", "double"}, {"search__features", "bool"}, {"unknown", "double"}}) {
      dynamic_reconfigure::ParamDescription parameter;
      parameter.name = name;
      parameter.type = type;
      parameter.description = std::string("<b>0 to 1</b>: of ") + name;
      group.parameters.push_back(parameter);
    }
    description_.groups.push_back(group);
    appendTo(description_.min.doubles, "tracking__quality__min_zncc", 0.0);
    appendTo(description_.max.doubles, "tracking__quality__min_zncc", 1.0);
    appendTo(values_.doubles, "tracking__quality__min_zncc", 0.5);
    appendTo(values_.bools, "search__features", true);
  }
  ConfigDescription description_;
  Config values_;
};

TEST_F(ParameterLinkTest, ShowsTheNodesTableWithItsValues) {
  const auto rows = rowsOf("tracker", description_, values_);
  ASSERT_EQ(rows.size(), 2u) << "one without a value is left out";
  EXPECT_EQ(rows[0].value, "0.5");
  EXPECT_EQ(rows[0].high, 1.0);
  EXPECT_EQ(rows[1].value, "true");
}

TEST_F(ParameterLinkTest, AsksOnlyForWhatIsAValue) {
  const auto rows = rowsOf("tracker", description_, values_);
  const auto request = requestOf(rows[0], " 0.25 ");
  ASSERT_TRUE(request);
  ASSERT_EQ(request->doubles.size(), 1u) << "and for nothing else";
  EXPECT_EQ(request->doubles[0].value, 0.25);
  for (const char* text : {"", "much", "0,5", "1.0 px"}) EXPECT_FALSE(requestOf(rows[0], text)) << text;
  EXPECT_TRUE(requestOf(rows[1], "false"));
  EXPECT_FALSE(requestOf(rows[1], "0.5"));
}

TEST_F(ParameterLinkTest, ThePanelKeepsWhatIsTypedWhenValuesChange) {
  std::vector<std::string> set;
  ParameterPanel panel([&](const LiveParameter& p, const std::string& text) { set.push_back(p.name + "=" + text); },
                       nullptr);
  Facts facts;
  facts.parameters = std::make_shared<std::vector<LiveParameter>>(rowsOf("tracker", description_, values_));
  panel.show(facts);
  auto* table = panel.findChild<QTableWidget*>("parameters");
  auto* value = panel.findChild<QLineEdit*>("value");
  ASSERT_EQ(table->rowCount(), 2);
  EXPECT_EQ(table->item(0, 0)->text(), "tracker/tracking/quality/min_zncc");
  table->selectRow(0);
  EXPECT_EQ(value->text(), "0.5");
  EXPECT_EQ(panel.findChild<QLabel*>("meaning")->textFormat(), Qt::PlainText);
  value->setText("0.7");
  values_.doubles[0].value = 0.6;
  facts.parameters = std::make_shared<std::vector<LiveParameter>>(rowsOf("tracker", description_, values_));
  panel.show(facts);
  EXPECT_EQ(table->item(0, 1)->text(), "0.6");
  EXPECT_EQ(value->text(), "0.7");
  QTest::keyClick(value, Qt::Key_Return);
  EXPECT_EQ(set, std::vector<std::string>{"tracking__quality__min_zncc=0.7"});
  EXPECT_EQ(minuteLimits(facts)[kConfidence].value, 0.6) << "the limit that is drawn is the one in force";
  panel.show(Facts());
  EXPECT_EQ(table->rowCount(), 0);
}

}  // namespace
}  // namespace laparoscope_servo::screen
