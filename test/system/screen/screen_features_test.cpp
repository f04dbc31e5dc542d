// The screen's window in front of the running trackers of instruments and of edges, and a camera that shows a shaft.
#include <nodelet/NodeletUnload.h>

#include <QCheckBox>
#include <QTabWidget>
#include <algorithm>

#include "screen/features/feature_painter.h"
#include "support/instrument_scene.h"
#include "support/like_colour.h"
#include "system/screen/image_feed.h"
#include "system/screen/screen_fixture.h"

namespace laparoscope_servo {
namespace {

using test_support::hands;
using test_support::ImageFeed;
using test_support::moveTo;
using test_support::waitFor;

const QSize kSize(320, 240);

class ScreenFeatures : public test_support::ScreenFixture {
 protected:
  void SetUp() override {
    show({1280, 800});
    find<QTabWidget>("tabs").setCurrentIndex(4);
    feed_.show([](int turn) {
      const cv::Mat scene = test_support::instrumentScene(0.0, static_cast<unsigned>(turn));
      return *cv_bridge::CvImage(std_msgs::Header(), "bgr8", scene).toImageMsg();
    });
  }

  // Of a tracker's line; empty where it has none.
  screen::BandText line(const QString& tracker) const {
    const auto* line = screen_->findChild<screen::FeatureLine*>("features_" + tracker);
    return line != nullptr ? line->text() : screen::BandText();
  }
  bool says(const QString& tracker, const std::string& beginning) const {
    return line(tracker).word.compare(0, beginning.size(), beginning) == 0;
  }
  // Pixels of a colour within 3 px of the display of both edges of the shaft, 60 to 120 px before its tip: the fewer.
  int onEdges(const QColor& colour) const {
    const QImage shown = image().grab().toImage();
    const Eigen::Vector2d direction = Eigen::Vector2d(0.9, 0.35).normalized(), across(-direction.y(), direction.x());
    int fewer = 1 << 30;
    for (const double side : {-test_support::kShaftHalfWidth, test_support::kShaftHalfWidth}) {
      int found = 0;
      for (double back = 60.0; back <= 120.0; back += 1.0) {
        const Eigen::Vector2d p = test_support::shaftTip(0.0) - back * direction + side * across;
        const QPoint at = image().mapFromGlobal(onDisplay(kSize, {p.x() + 0.5, p.y() + 0.5}));
        for (int y = -3; y <= 3; ++y) {
          for (int x = -3; x <= 3; ++x) {
            if (!shown.rect().contains(at + QPoint(x, y))) continue;
            found += test_support::isLike(shown.pixelColor(at + QPoint(x, y)), colour) ? 1 : 0;
          }
        }
      }
      fewer = std::min(fewer, found);
    }
    return fewer;
  }
  bool areDrawn() const { return onEdges(screen::kFeatureColour) > 100; }

  ImageFeed feed_;
};

TEST_F(ScreenFeatures, AnInstrumentIsDrawnWhereItIsAndSaidInWords) {
  ASSERT_TRUE(waitFor([this] { return says("instrument", "TRACKING"); })) << line("instrument").word;
  EXPECT_TRUE(waitFor([this] { return areDrawn(); })) << onEdges(screen::kFeatureColour);
  ASSERT_TRUE(waitFor([this] { return says("edges", "IDLE"); })) << line("edges").word;
  EXPECT_EQ(line("edges").sentence, "Nothing is selected that it could follow.");
  EXPECT_FALSE(line("edges").cure.empty());

  auto& box = find<QCheckBox>("draw_features");
  const QPoint at = box.mapToGlobal(QPoint(8, box.height() / 2));
  hands(moveTo(at) + "click 1");
  EXPECT_TRUE(waitFor([this] { return onEdges(screen::kFeatureColour) == 0; }));
  hands(moveTo(at) + "click 1");
  EXPECT_TRUE(waitFor([this] { return areDrawn(); }));
}

TEST_F(ScreenFeatures, WithoutACameraNothingIsDrawnAndItIsSaid) {
  ASSERT_TRUE(waitFor([this] { return says("instrument", "TRACKING") && areDrawn(); })) << line("instrument").word;
  feed_.show(nullptr);
  EXPECT_TRUE(waitFor([this] { return onEdges(screen::kFeatureColour) == 0; })) << "the picture is not live";
  EXPECT_TRUE(waitFor([this] { return says("instrument", "SILENT"); })) << line("instrument").word;
  EXPECT_FALSE(line("instrument").cure.empty());
}

// The last tests, for nobody starts again what they end.
TEST_F(ScreenFeatures, WhereNoRegionTrackerRunsThePictureIsOfATrackerOfFeatures) {
  ASSERT_TRUE(waitFor([this] { return says("instrument", "TRACKING") && areDrawn(); })) << line("instrument").word;
  ASSERT_EQ(std::system("rosnode kill /tracker >/dev/null"), 0);
  ASSERT_TRUE(waitFor([this] { return word("Tracker") == "GONE"; })) << word("Tracker");
  EXPECT_TRUE(waitFor([this] { return areDrawn(); })) << onEdges(screen::kFeatureColour);
}

TEST_F(ScreenFeatures, WhatATrackerSaidThatHasEndedIsGreyForAWhile) {
  ASSERT_TRUE(waitFor([this] { return says("instrument", "TRACKING") && areDrawn(); })) << line("instrument").word;
  nodelet::NodeletUnload unload;
  unload.request.name = "/instrument";
  ASSERT_TRUE(ros::service::call("/manager/unload_nodelet", unload) && unload.response.success);
  EXPECT_TRUE(waitFor([this] { return onEdges(screen::kOldFeatureColour) > 100; })) << "over the live picture";
  EXPECT_TRUE(waitFor([this] { return says("instrument", "GONE"); })) << line("instrument").word;
  EXPECT_TRUE(waitFor([this] { return onEdges(screen::kOldFeatureColour) < 20; })) << "after ten seconds";
  EXPECT_TRUE(says("edges", "IDLE")) << "the other one goes on";
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runScreenTests(argc, argv, "screen_features_test");
}
