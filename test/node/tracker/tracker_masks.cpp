// Masks of what covers the tissue, from node to node: of the nodelet Instrument beside the tracker in one manager, and
// of a node that does it wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "camera_bench.h"
#include "second_publisher.h"
#include "support/instrument_scene.h"

namespace laparoscope_servo {
namespace {

using test_support::CameraBench;
using test_support::DiagnosticsListener;
using test_support::Inbox;
using test_support::instrumentScene;
using test_support::waitFor;

// Where the shaft of the scene comes from the left, right of its tip in the beginning.
const geometry::Rectangle kCrossed{190.0, 90.0, 110.0, 110.0};
const geometry::Rectangle kRoi{110.0, 70.0, 100.0, 90.0};  // of the launch file

// Share of the region that the last mask covers, as /diagnostics says; 0 when it says nothing.
double shareOf(const DiagnosticsListener& diagnostics) {
  const std::string text = diagnostics.value("external mask");
  const std::size_t place = text.find("covers ");
  return place == std::string::npos ? 0.0 : std::stod(text.substr(place + 7));
}

TEST(TrackerMasks, AShaftThatCrossesTheRegionIsLeftOutAndTrackingGoesOn) {
  CameraBench bench("scope");
  ASSERT_TRUE(bench.ready());
  DiagnosticsListener diagnostics(bench.node(), "scope/tracker");
  Inbox<sensor_msgs::Image> masks(bench.node(), "instrument/mask");
  ASSERT_TRUE(waitFor([&] { return masks.connected(); }));
  ros::Time stamp(1000, 0);
  unsigned seed = 0;
  const auto track = [&](double shift) {
    stamp += ros::Duration(0.04);
    return bench.track(instrumentScene(shift, ++seed), stamp);
  };
  constexpr double kOutside = -60.0;  // px: the tip is left of the region
  ASSERT_TRUE(waitFor([&] { return track(kOutside) != nullptr && masks.at(stamp) != nullptr; }));
  auto answer = bench.select(kCrossed);
  while (answer.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready) track(kOutside);
  const SelectRoiResponse selected = answer.get();
  ASSERT_TRUE(selected.success) << selected.message;

  double largest = 0.0;
  for (double shift = kOutside; shift <= 40.0; shift += 2.0) {
    const HomographyConstPtr homography = track(shift);
    ASSERT_TRUE(homography);
    EXPECT_EQ(homography->state, Homography::TRACKING) << shift;
    const geometry::Quadrilateral corners = kCrossed.corners();
    for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(homography->corners[2 * c], corners[c].x(), 1.0) << shift;
    largest = std::max(largest, shareOf(diagnostics));
  }
  // It stays there, until /diagnostics tells of it.
  EXPECT_TRUE(waitFor([&] {
    track(40.0);
    largest = std::max(largest, shareOf(diagnostics));
    return largest > 0.1;
  })) << diagnostics.last();
  EXPECT_LT(largest, 0.8);
}

class TrackerMasksOfTheTest : public testing::Test {
 protected:
  struct Bench {
    CameraBench camera{"told"};
    ros::Publisher masks = camera.node().advertise<sensor_msgs::Image>("tracker/external_mask", 10);
    DiagnosticsListener diagnostics{camera.node(), "told/tracker"};
    ros::Time stamp{2000, 0};
  };
  static Bench& bench() {
    static Bench bench;
    return bench;
  }

  void SetUp() override {
    ASSERT_TRUE(bench().camera.ready());
    ASSERT_TRUE(waitFor([] { return bench().masks.getNumSubscribers() > 0; }));
    HomographyConstPtr homography;
    ASSERT_TRUE(waitFor([&] {
      homography = track();
      return homography && homography->state == Homography::TRACKING;
    }));
  }

  HomographyConstPtr track() {
    bench().stamp += ros::Duration(0.04);
    return bench().camera.track(image_, bench().stamp);
  }

  // The left half of the region.
  static sensor_msgs::Image half(const ros::Time& stamp) {
    cv::Mat mask = cv::Mat::zeros(240, 320, CV_8UC1);
    mask(cv::Rect(0, 0, 160, 240)).setTo(255);
    return *cv_bridge::CvImage(CameraBench::header(stamp), "mono8", mask).toImageMsg();
  }

  // Mask and image come over two connections: until one has come before the image that follows.
  bool halfIsUsed() {
    return waitFor([this] {
      bench().masks.publish(half(bench().stamp));
      const HomographyConstPtr homography = track();
      return homography && homography->state == Homography::TRACKING &&
             std::abs(homography->visible_fraction - 0.5) < 0.1;
    });
  }
  // All of it is used again: masks that are too old are not used for ever.
  bool allIsUsed() {
    return waitFor([this] {
      const HomographyConstPtr homography = track();
      return homography && homography->visible_fraction > 0.9;
    });
  }

  // `mask` is refused with this text; tracking goes on, with the masks that come later.
  void isRefused(const std::function<sensor_msgs::Image()>& mask, const std::string& text) {
    EXPECT_TRUE(halfIsUsed());
    EXPECT_TRUE(allIsUsed());
    EXPECT_TRUE(waitFor([&] {
      bench().masks.publish(mask());
      const HomographyConstPtr homography = track();
      EXPECT_TRUE(homography && homography->state == Homography::TRACKING);
      EXPECT_TRUE(homography && homography->visible_fraction > 0.9);
      return bench().diagnostics.last().message.find(text) != std::string::npos;
    })) << bench().diagnostics.last();
    EXPECT_EQ(bench().diagnostics.last().level, diagnostic_msgs::DiagnosticStatus::WARN);
    EXPECT_TRUE(halfIsUsed()) << bench().diagnostics.last();
  }

  const cv::Mat image_ = test_support::texture(cv::Size(320, 240));
};

TEST_F(TrackerMasksOfTheTest, AnEarlierOneIsUsedUntilItIsTooOld) {
  EXPECT_TRUE(halfIsUsed()) << bench().diagnostics.last();
  EXPECT_TRUE(waitFor([&] {
    halfIsUsed();
    return bench().diagnostics.value("external mask").find("covers 0.5") != std::string::npos;
  })) << bench().diagnostics.last();
  EXPECT_TRUE(allIsUsed());
}

TEST_F(TrackerMasksOfTheTest, AnotherSizeIsRefused) {
  isRefused(
      [] {
        sensor_msgs::Image mask = half(bench().stamp);
        mask.height = 120;
        mask.data.resize(mask.step * mask.height);
        return mask;
      },
      "size 320x120 px, expected that of the images, 320x240 px");
}

TEST_F(TrackerMasksOfTheTest, AnotherEncodingIsRefused) {
  isRefused(
      [] {
        sensor_msgs::Image mask = half(bench().stamp);
        mask.encoding = "bgr8";
        return mask;
      },
      "encoding 'bgr8', expected mono8");
}

TEST_F(TrackerMasksOfTheTest, AStampOfTheFutureIsRefused) {
  isRefused([] { return half(ros::Time::now() + ros::Duration(5.0)); },
            "ahead of this machine's clock, expected at most 0.1 s");
}

TEST_F(TrackerMasksOfTheTest, ATimeThatJumpsBackIsRefused) {
  bool first = true;
  isRefused(
      [&] {  // every second one: several in a row are another time, which is believed
        first = !first;
        return half(first ? bench().stamp - ros::Duration(1000.0) : bench().stamp - ros::Duration(0.3));
      },
      "before the one before it");
}

TEST_F(TrackerMasksOfTheTest, ASecondPublisherIsRefused) {
  EXPECT_TRUE(halfIsUsed());
  const test_support::SecondPublisher other("/told/tracker/external_mask");
  bool named = false;
  EXPECT_TRUE(waitFor([&] {
    EXPECT_TRUE(halfIsUsed()) << "it takes nothing away from the owner";
    const std::string message = bench().diagnostics.last().message;
    named = named || (message.find("masks of /rostopic") != std::string::npos &&
                      message.find("only those of /tracker_masks count") != std::string::npos);
    return named;
  })) << bench().diagnostics.last();
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "tracker_masks");
}
