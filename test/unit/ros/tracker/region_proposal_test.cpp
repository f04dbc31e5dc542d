#include "ros/tracker/region_proposal.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic_tissue.h"

namespace laparoscope_servo {
namespace {

TEST(ProposalText, NamesTheRegionAsTheParameterRoiTakesIt) {
  EXPECT_EQ(proposalText(geometry::Rectangle{12, 34, 100, 90}), "; 12,34,100,90 would do");
  EXPECT_EQ(proposalText(std::nullopt), "");
}

TEST(RegionThatWouldDo, IsNoneWhereRegionOrImageIsNone) {
  const tracking::RegionTracker tracker{tracking::TrackerConfig()};
  const cv::Mat image = test::tissue({320, 240}, 5);
  EXPECT_TRUE(regionThatWouldDo(tracker, image, {100, 80, 8, 8}));
  EXPECT_FALSE(regionThatWouldDo(tracker, image, {std::nan(""), 80, 60, 60}));
  EXPECT_FALSE(regionThatWouldDo(tracker, image, {100, 80, -5, 60}));
  EXPECT_FALSE(regionThatWouldDo(tracker, cv::Mat(), {100, 80, 60, 60}));
}

}  // namespace
}  // namespace laparoscope_servo
