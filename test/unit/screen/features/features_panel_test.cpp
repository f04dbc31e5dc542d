#include "screen/features/features_panel.h"

#include <gtest/gtest.h>

#include "unit/screen/features/feature_facts_examples.h"

namespace laparoscope_servo::screen {
namespace {

constexpr double kNow = 100.0;

Facts with(const std::vector<std::string>& names) {
  Facts facts;
  facts.master = true;
  for (const std::string& name : names) {
    FeatureTrackerFacts tracker;
    tracker.name = name;
    tracker.connected = true;
    tracker.heard_at = kNow;
    tracker.newest = featureResult(test_support::featuresMessage(1.0, {test_support::lineMessage()}));
    facts.features.push_back(tracker);
  }
  return facts;
}

std::vector<QString> wordsOf(const FeaturesPanel& panel) {
  std::vector<QString> words;
  for (const FeatureLine* line : panel.findChildren<FeatureLine*>())
    words.push_back(line->objectName() + ": " + QString::fromStdString(line->text().word));
  return words;
}

TEST(FeaturesPanel, HasALineForEachTracker) {
  FeaturesPanel panel([](bool) {}, nullptr);
  panel.show(with({}), kNow);
  EXPECT_TRUE(wordsOf(panel).empty());
  panel.show(with({"edges"}), kNow);
  EXPECT_EQ(wordsOf(panel), (std::vector<QString>{"features_edges: TRACKING 1 of 1"}));
  panel.show(with({"dots", "edges"}), kNow);
  EXPECT_EQ(wordsOf(panel),
            (std::vector<QString>{"features_dots: TRACKING 1 of 1", "features_edges: TRACKING 1 of 1"}));
}

TEST(FeaturesPanel, ALineChangesItsLookWithItsWords) {
  FeatureLine line(nullptr);
  line.resize(380, line.height());
  const auto look = [&line](const BandText& text) {
    line.show("edges", text);
    return line.grab().toImage();
  };
  const QImage good = look({"TRACKING 1 of 1", "All are seen.", "", "", Level::kGood});
  const QImage bad = look({"TRACKING 1 of 1", "All are seen.", "", "", Level::kBad});
  EXPECT_NE(good.convertToFormat(QImage::Format_Grayscale8).copy(0, 0, 26, 74),
            bad.convertToFormat(QImage::Format_Grayscale8).copy(0, 0, 26, 74))
      << "the symbol, without colour";
  EXPECT_NE(bad, look({"TRACKING 1 of 1", "All are seen.", "Do something.", "", Level::kBad}));
  look({"LOST", "", "", "<b>no markup</b>", Level::kBad});
  EXPECT_EQ(line.toolTip(), QString("<b>no markup</b>").toHtmlEscaped());
}

TEST(FeaturesPanel, TheBoxSaysWhetherTheyAreDrawn) {
  std::vector<bool> said;
  FeaturesPanel panel([&said](bool draw) { said.push_back(draw); }, nullptr);
  auto* box = panel.findChild<QCheckBox*>("draw_features");
  ASSERT_NE(box, nullptr);
  EXPECT_TRUE(box->isChecked());
  box->click();
  box->click();
  EXPECT_EQ(said, (std::vector<bool>{false, true}));
}

}  // namespace
}  // namespace laparoscope_servo::screen
