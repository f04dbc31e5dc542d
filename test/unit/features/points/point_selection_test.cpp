#include "features/points/point_selection.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "points_check.h"
#include "seen.h"

namespace laparoscope_servo::features {
namespace {

class PointSelectionTest : public testing::Test {
 protected:
  PointChoice select(const cv::Mat& image, const std::vector<PointGroup>& groups) {
    return selectPoints(seen(image), 2.0, groups, config_, comparer_);
  }

  PointsConfig config_;
  PointComparer comparer_{config_};
  const cv::Mat scene_ = test::tissue(kSize, 21);
  const std::vector<Eigen::Vector2d> corners_ = findCorners(scene_, {80, 60, 160, 120}, 12, config_);
};

TEST_F(PointSelectionTest, KeepsTheOrderOfGroupsAndOfTheirPoints) {
  const std::vector<Eigen::Vector2d> few(corners_.begin(), corners_.begin() + 3),
      others(corners_.begin() + 3, corners_.begin() + 8);
  const PointChoice choice = select(scene_, {{cv::Mat(), few}, {scene_, others}});
  ASSERT_EQ(choice.points.size(), 8u);
  ASSERT_EQ(choice.sources.size(), 2u);
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_EQ(choice.points[k].view.place(), corners_[k]);
    EXPECT_EQ(choice.points[k].group, k < 3 ? 0u : 1u);
    EXPECT_EQ(choice.points[k].keeper.state(), State::kTracking);
    EXPECT_LT((choice.points[k].pose.place - corners_[k]).norm(), 0.05);
  }
}

// Half of the picture is covered in the image: those points are selected, and searched for.
TEST_F(PointSelectionTest, SelectsWhatIsNotSeenOfAPictureThatIs) {
  const Eigen::Matrix3d g = motion({10.0, 5.0}, 0.2);
  cv::Mat image = test::view(scene_, g, 1.0, 0.0, 1.0);
  image.colRange(0, 160).setTo(cv::Scalar(60, 60, 65));
  const PointChoice choice = select(image, {{scene_, corners_}});
  int seen = 0, searched = 0;
  for (const TrackedPoint& point : choice.points) {
    (point.keeper.state() == State::kTracking ? seen : searched) += 1;
    if (point.keeper.state() == State::kTracking) {
      EXPECT_LT((point.pose.place - geometry::apply(g, point.view.place())).norm(), 0.3);
    }
  }
  EXPECT_GE(seen, 3);
  EXPECT_GE(searched, 2);
}

// What is seen already stays where it is; the points of another picture are left alone.
TEST_F(PointSelectionTest, LooksForThePointsOfOnePictureByAMotion) {
  PointChoice choice = select(scene_, {{cv::Mat(), corners_}});
  const Eigen::Matrix3d g = motion({30.0, -12.0}, 0.5);
  const PointImage now = seen(test::view(scene_, g, 1.0, 0.0, 1.0));
  for (TrackedPoint& point : choice.points) point.reason = Reason::kNotSeen;
  choice.points[0].reason = Reason::kNone;
  EXPECT_EQ(lookBy(g, 7, now, comparer_, choice.points), 0u);
  EXPECT_GE(lookBy(g, 0, now, comparer_, choice.points), corners_.size() - 1);
  EXPECT_LT((choice.points[0].pose.place - corners_[0]).norm(), 0.05);
  EXPECT_LT((choice.points[1].pose.place - geometry::apply(g, corners_[1])).norm(), 0.2);
}

TEST_F(PointSelectionTest, RefusesAPictureThatIsNotThere) {
  EXPECT_THROW(select(test::tissue(kSize, 50), {{scene_, corners_}}), std::invalid_argument);
  EXPECT_THROW(select(scene_, {{cv::Mat(), {}}}), std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::features
