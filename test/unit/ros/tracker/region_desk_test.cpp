#include "ros/tracker/region_desk.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "support/error_text.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo {
namespace {

using test_support::errorText;

const geometry::Rectangle kRoi{110.0, 75.0, 100.0, 90.0};
constexpr double kNow = 50.0;  // s

class RegionDeskTest : public testing::Test {
 protected:
  static std::shared_ptr<Snapshot> snapshot(double stamp, const cv::Size& size = cv::Size(320, 240)) {
    auto result = std::make_shared<Snapshot>();
    result->image = test::tissue(size, 5);
    result->stamp = ros::Time(stamp);
    result->epoch = 3;
    return result;
  }

  TrackerParameters parameters_;
  RegionDesk desk_{parameters_};
};

TEST_F(RegionDeskTest, SaysWhetherARegionWouldBeTaken) {
  auto now = snapshot(1.0);
  EXPECT_EQ(errorText<std::invalid_argument>([&] { desk_.check(*now, kRoi); }), "");
  EXPECT_NE(errorText<std::invalid_argument>([&] {
              desk_.check(*now, {250.0, 75.0, 100.0, 90.0});
            }).find("not inside the image"),
            std::string::npos);
  now->lens_error = "images cannot be rectified: no camera_info";
  EXPECT_EQ(errorText<std::invalid_argument>([&] { desk_.check(*now, kRoi); }), now->lens_error);
}

TEST_F(RegionDeskTest, KeepsOnePictureAndKnowsItByItsStamp) {
  EXPECT_TRUE(desk_.preview().empty());
  EXPECT_NE(errorText<std::invalid_argument>([&] { desk_.kept(ros::Time(1.0), kNow); }).find("freeze_image"),
            std::string::npos);
  EXPECT_FALSE(desk_.holds(ros::Time(1.0)));
  desk_.keep(snapshot(1.0, cv::Size(1280, 720)), kNow);
  EXPECT_EQ(desk_.preview().size(), cv::Size(640, 360));
  EXPECT_EQ(desk_.kept(ros::Time(1.0), kNow)->stamp, ros::Time(1.0));
  desk_.keep(snapshot(2.0), kNow);
  EXPECT_TRUE(desk_.holds(ros::Time(2.0)));
  EXPECT_NE(errorText<std::invalid_argument>([&] { desk_.kept(ros::Time(1.0), kNow); }).find("another one was frozen"),
            std::string::npos);
}

TEST_F(RegionDeskTest, APictureThatWasFrozenLongAgoIsNotDrawnIn) {
  desk_.keep(snapshot(1.0), kNow);
  const double longest = parameters_.views.max_frozen_age;
  EXPECT_EQ(errorText<std::invalid_argument>([&] { desk_.kept(ros::Time(1.0), kNow + longest); }), "");
  const std::string why = errorText<std::invalid_argument>([&] { desk_.kept(ros::Time(1.0), kNow + longest + 5.0); });
  EXPECT_EQ(why, "the picture was frozen 65 s ago, expected at most 60 s (parameter views/max_frozen_age)");
  desk_.keep(snapshot(2.0), kNow + longest);
  EXPECT_EQ(errorText<std::invalid_argument>([&] { desk_.kept(ros::Time(2.0), kNow + longest + 5.0); }), "");
}

TEST_F(RegionDeskTest, TheRegionIsCutFromThatVeryImage) {
  const auto before = snapshot(1.0);
  const RecallRoute route = desk_.route(*before, kRoi, *snapshot(5.0));
  ASSERT_EQ(route.steps.size(), 1u);
  EXPECT_EQ(route.steps[0].name, "");
  EXPECT_EQ(route.steps[0].view.image.data, before->image.data);
  EXPECT_EQ(route.steps[0].view.roi.x, kRoi.x);
  EXPECT_EQ(route.steps[0].stamp, before->stamp);
  EXPECT_EQ(route.epoch, 3u);
  EXPECT_NE(errorText<std::invalid_argument>([&] {
              desk_.route(*before, kRoi, *snapshot(5.0, cv::Size(640, 480)));
            }).find("another size"),
            std::string::npos);
  EXPECT_NE(errorText<std::invalid_argument>([&] {
              desk_.route(*before, {0.0, 0.0, 2.0, 2.0}, *snapshot(5.0));
            }).find("too small"),
            std::string::npos);
}

TEST_F(RegionDeskTest, ProposesARegionThatWouldBeTaken) {
  auto now = snapshot(1.0);
  now->image(cv::Rect(0, 0, 160, 240)).setTo(cv::Scalar(70, 80, 150));
  const geometry::Rectangle smooth = {60, 75, 80, 80};
  EXPECT_NE(errorText<std::invalid_argument>([&] { desk_.check(*now, smooth); }), "");
  const auto proposal = desk_.propose(*now, smooth);
  ASSERT_TRUE(proposal);
  EXPECT_EQ(errorText<std::invalid_argument>([&] { desk_.check(*now, *proposal); }), "");
  now->lens_error = "images cannot be rectified: no camera_info";
  EXPECT_FALSE(desk_.propose(*now, smooth));
}

}  // namespace
}  // namespace laparoscope_servo
