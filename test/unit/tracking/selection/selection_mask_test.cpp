#include "tracking/selection/selection_mask.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "support/error_text.h"
#include "support/synthetic_instrument.h"

namespace laparoscope_servo::tracking {
namespace {

const test_support::ShaftPicture kPicture = test_support::drawShaft(test_support::ShaftScene());
const cv::Rect kOnShaft(400, 270, 60, 50);
const cv::Rect kOnTissue(60, 60, 60, 50);

geometry::Rectangle rectangle(const cv::Rect& box) {
  return {static_cast<double>(box.x), static_cast<double>(box.y), static_cast<double>(box.width),
          static_cast<double>(box.height)};
}

std::string refusal(const SelectionMask& selectable, const cv::Rect& box) {
  return test_support::errorText<std::invalid_argument>([&] { selectable.check(rectangle(box), nullptr); });
}

TEST(SelectionMask, LeavesOutInstrumentsAndRefusesWhatLiesOnThem) {
  const SelectionMask selectable(kPicture.image, cv::Mat());
  EXPECT_EQ(cv::countNonZero(selectable.mask()(kOnShaft)), kOnShaft.area());
  EXPECT_EQ(cv::countNonZero(selectable.mask()(kOnTissue)), 0);
  EXPECT_NE(refusal(selectable, kOnShaft).find(" lies on an instrument by 100 %"), std::string::npos)
      << refusal(selectable, kOnShaft);
  EXPECT_EQ(refusal(selectable, kOnTissue), "");
}

TEST(SelectionMask, JoinsWhatIsKnownToBeCovered) {
  cv::Mat external = cv::Mat::zeros(kPicture.image.size(), CV_8UC1);
  external(kOnTissue).setTo(1);  // whatever is not 0
  const SelectionMask selectable(kPicture.image, external);
  EXPECT_EQ(cv::countNonZero(selectable.mask()(kOnShaft)), kOnShaft.area());
  EXPECT_EQ(cv::countNonZero(selectable.mask()(kOnTissue)), kOnTissue.area());
  // It is left out, but no instrument: who gave the mask says what to do with it.
  EXPECT_EQ(refusal(selectable, kOnTissue), "");
}

TEST(SelectionMask, JoinsWhatLiesBeyondTheBorderOfARoundPicture) {
  cv::Mat field = cv::Mat::zeros(kPicture.image.size(), CV_8UC1), image = cv::Mat::zeros(field.size(), CV_8UC3);
  cv::circle(field, {field.cols / 2, field.rows / 2}, 230, 255, cv::FILLED);
  kPicture.image.copyTo(image, field);
  const SelectionMask selectable(image, cv::Mat());
  const cv::Rect black(0, 0, 60, 60);
  EXPECT_EQ(cv::countNonZero(selectable.mask()(black)), black.area());
  EXPECT_NE(refusal(selectable, black).find("where it is black"), std::string::npos);
  EXPECT_EQ(cv::countNonZero(selectable.mask()(kOnShaft)), kOnShaft.area());
}

TEST(SelectionMask, IsEmptyWhereAllOfTheImageMayBeUsed) {
  test_support::ShaftScene scene;
  scene.with_shaft = false;
  const cv::Mat image = test_support::drawShaft(scene).image;
  EXPECT_TRUE(SelectionMask(image, cv::Mat()).mask().empty());
  cv::Mat grey;
  cv::cvtColor(kPicture.image, grey, cv::COLOR_BGR2GRAY);
  EXPECT_TRUE(SelectionMask(grey, cv::Mat()).mask().empty());
}

}  // namespace
}  // namespace laparoscope_servo::tracking
