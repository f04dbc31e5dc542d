// The session with a source of masks of what covers the tissue.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ros/tracker/tracker_session.h"
#include "support/stamped_header.h"
#include "support/synthetic_sequence.h"

namespace laparoscope_servo {
namespace {

using test_support::at;
using tracking::State;

const cv::Size kSize(320, 240);
const geometry::Rectangle kRoi{100.0, 70.0, 100.0, 90.0};

class TrackerSessionMask : public testing::Test {
 protected:
  TrackerSessionMask() {
    session_.setMaskSource([this](const cv::Mat& image, const ros::Time& stamp) {
      asked_.push_back(stamp.toSec());
      EXPECT_EQ(image.size(), kSize);
      return mask_;
    });
  }

  cv::Mat picture() { return test_support::noisy(image_, random_); }
  static cv::Mat covering(const cv::Rect& part) {
    cv::Mat mask = cv::Mat::zeros(kSize, CV_8UC1);
    mask(part).setTo(255);
    return mask;
  }

  TrackerSession session_{TrackerParameters()};
  tracking::ExternalMask mask_;
  std::vector<double> asked_;
  cv::RNG random_{3};
  const cv::Mat image_ = test_support::texture(kSize);
};

TEST_F(TrackerSessionMask, IsAskedOnceForEachImageAndNothingChangesWithoutOne) {
  TrackerSession without{TrackerParameters()};
  for (int k = 0; k < 5; ++k) {
    const cv::Mat image = picture();
    const auto request = k == 0 ? std::make_optional(kRoi) : std::nullopt;
    const Processed a = session_.process(image, at(1.0 + k), request), b = without.process(image, at(1.0 + k), request);
    EXPECT_EQ(a.result.g, b.result.g);
    EXPECT_EQ(a.result.visible_fraction, b.result.visible_fraction);
    EXPECT_EQ(a.mask_share, 0.0);
  }
  EXPECT_EQ(asked_, (std::vector<double>{1.0, 2.0, 3.0, 4.0, 5.0}));
}

TEST_F(TrackerSessionMask, WhatItCoversIsLeftOut) {
  session_.process(picture(), at(1.0), kRoi);
  mask_ = {covering({100, 70, 50, 90}), 0.04, 3.0};
  const Processed half = session_.process(picture(), at(2.0));
  EXPECT_EQ(half.result.state, State::kTracking);
  EXPECT_NEAR(half.result.visible_fraction, 0.5, 0.05);
  EXPECT_NEAR(half.mask_share, 0.5, 0.05);
  EXPECT_EQ(half.external_mask.age, 0.04);
  EXPECT_EQ(half.external_mask.grown, 3.0);
  mask_ = {};
  const Processed all = session_.process(picture(), at(3.0));
  EXPECT_GT(all.result.visible_fraction, 0.9);
  EXPECT_EQ(all.mask_share, 0.0);
}

TEST_F(TrackerSessionMask, WhatItCoversAtSelectionIsNeverUsed) {
  mask_ = {covering({100, 70, 50, 90}), 0.0, 0.0};
  EXPECT_NEAR(session_.process(picture(), at(1.0), kRoi).result.visible_fraction, 0.5, 0.05);
  mask_ = {};
  EXPECT_LT(session_.process(picture(), at(2.0)).result.visible_fraction, 0.55);
}

TEST_F(TrackerSessionMask, ARegionThatIsCoveredIsRefusedAndTheTextSaysByWhat) {
  mask_ = {covering({90, 60, 120, 110}), 0.0, 0.0};
  const Processed refused = session_.process(picture(), at(1.0), kRoi);
  EXPECT_FALSE(refused.result.selected_now);
  EXPECT_NE(refused.selection_error.find("; the external mask covers 100 % of it"), std::string::npos)
      << refused.selection_error;
  mask_ = {};
  EXPECT_TRUE(session_.process(picture(), at(2.0), kRoi).result.selected_now);
}

}  // namespace
}  // namespace laparoscope_servo
