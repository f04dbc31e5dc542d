// Points of texture are where the images show them, and are claimed nowhere else.
#include "laparoscope_servo/features/points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "points/points_check.h"

namespace laparoscope_servo::features {
namespace {

TEST_F(PointsTest, AreWhereTheyHaveShifted) {
  select();
  Eigen::Matrix3d g;
  for (int k = 1; k <= 12; ++k) {
    g = motion({3.2 * k, -1.7 * k});
    EXPECT_EQ(track(image(g)).state, State::kTracking) << k;
    EXPECT_LT(worst(g), 0.25) << k;
  }
}

TEST_F(PointsTest, AreWhereTheyHaveTurnedAndGrown) {
  select({110, 80, 100, 80}, 12);  // which stays in the image
  Eigen::Matrix3d g;
  for (int k = 1; k <= 25; ++k) {
    g = motion({0.4 * k, 0.3 * k}, 0.02 * k, 1.0 + 0.02 * k);
    track(image(g));
    EXPECT_LT(worst(g), 0.4) << k;
  }
  EXPECT_GE(tracking(), corners_.size() - 2);
  const Eigen::Matrix2d expected = 1.5 * Eigen::Rotation2Dd(0.5).toRotationMatrix();
  for (const PointResult& point : tracker_.result().points) {
    if (point.state == State::kTracking) {
      EXPECT_LT((point.shape - expected).norm(), 0.12);
    }
  }
}

TEST_F(PointsTest, BearTheLightAndTellIt) {
  select();
  for (int k = 1; k <= 10; ++k) {
    const double gain = 1.0 - 0.04 * k, bias = 2.0 * k;
    const Eigen::Matrix3d g = motion({0.5 * k, 0.0});
    EXPECT_EQ(track(image(g, gain, bias)).state, State::kTracking) << k;
    EXPECT_LT(worst(g), 0.3);
    // gain x image + offset looks like the first view.
    for (const PointResult& point : tracker_.result().points) EXPECT_NEAR(point.gain, 1.0 / gain, 0.15 / gain);
  }
}

// What is compared is always the first view, so there is no drift: the last errors are no larger than the first.
TEST_F(PointsTest, DoNotDrift) {
  select();
  double first = 0.0, last = 0.0;
  for (int k = 1; k <= 80; ++k) {
    const Eigen::Matrix3d g = motion({12.0 * std::sin(0.3 * k), 9.0 * std::sin(0.23 * k)}, 0.1 * std::sin(0.17 * k));
    track(image(g));
    if (k <= 20) first = std::max(first, worst(g));
    if (k > 60) last = std::max(last, worst(g));
  }
  EXPECT_GE(tracking(), corners_.size() - 1);
  EXPECT_LT(last, 1.5 * first);
}

TEST_F(PointsTest, FollowTheMotionThatIsKnown) {
  for (const bool known : {true, false}) {
    select({100, 70, 100, 80}, 12);  // which stays in the image
    const Eigen::Matrix3d g = motion({95.0, 35.0}, 0.6);
    const PointsResult& result = known ? tracker_.track(image(g), kPeriod, g) : tracker_.track(image(g), kPeriod);
    if (known) {
      EXPECT_GE(tracking(), corners_.size() - 1);
    } else {
      EXPECT_NE(result.state, State::kTracking);
    }
    EXPECT_LT(worst(g), 0.5) << known;
  }
}

// The cover takes a part of them, the scene moves on beneath it, and those that come back are where they should be.
TEST_F(PointsTest, ComeBackFromBehindACover) {
  select();
  const auto covered = [](cv::Mat picture) {
    picture.colRange(0, 150).setTo(cv::Scalar(60, 60, 65));
    return picture;
  };
  Eigen::Matrix3d g;
  int k = 0;
  for (; k < 15; ++k) {
    g = motion({1.5 * k, -1.0 * k}, 0.01 * k);
    track(covered(image(g)));
    EXPECT_LT(worst(g), 0.75) << k;  // of windows that are covered in part
  }
  const std::size_t seen = tracking();
  EXPECT_LT(seen, corners_.size() - 3);
  EXPECT_GE(seen, 3u);
  for (const PointResult& point : tracker_.result().points) {
    if (point.state == State::kTracking) continue;
    EXPECT_EQ(point.state, State::kSearching);
    EXPECT_NE(point.reason, Reason::kNone);
    EXPECT_TRUE(std::isinf(point.expected_error));
  }
  for (; k < 22; ++k) {
    g = motion({1.5 * k, -1.0 * k}, 0.01 * k);
    track(image(g));
    EXPECT_LT(worst(g), 0.5) << k;
  }
  EXPECT_GE(tracking(), corners_.size() - 1);
}

// All are gone, and come back elsewhere: the first view is matched as a whole.
TEST_F(PointsTest, AreRecalledWhereNoneLeads) {
  select();
  const cv::Mat gone(kSize, CV_8UC3, cv::Scalar(60, 70, 110));
  for (int k = 0; k < 5; ++k) track(gone);
  EXPECT_EQ(tracking(), 0u);
  const Eigen::Matrix3d g = motion({45.0, -25.0}, 0.4, 1.1);
  for (int k = 0; k < 20; ++k) {
    track(image(g));
    EXPECT_LT(worst(g), 0.5) << k;
  }
  EXPECT_GE(tracking(), corners_.size() / 2);
}

TEST_F(PointsTest, AreLostAfterAWhileAndFoundInAnothersPlaceNever) {
  select();
  const cv::Mat other = test::tissue(kSize, 77);
  for (int k = 0; k < 60; ++k) {
    track(test::view(other, motion({0.5 * k, 0.0}), 1.0, 0.0, 1.5, static_cast<unsigned>(k)));
    EXPECT_EQ(tracking(), 0u) << k;
  }
  EXPECT_EQ(tracker_.result().state, State::kLost);
}

// A point where an instrument's edge crosses the tissue's texture: the crossing slides, and is neither the tissue nor
// the instrument. What is claimed moves with one of them.
TEST_F(PointsTest, DoNotSlideAlongAnOcclusionEdge) {
  const auto behind = [](const Eigen::Matrix3d& g) {
    cv::Mat picture = image(g);
    std::vector<cv::Point> shaft = {{150, 0}, {190, 0}, {140, 239}, {100, 239}};
    cv::fillConvexPoly(picture, shaft, cv::Scalar(70, 70, 70), cv::LINE_AA);
    return picture;
  };
  const cv::Mat first = behind(Eigen::Matrix3d::Identity());
  // Along both edges of the shaft.
  std::vector<Eigen::Vector2d> places;
  for (double y = 40.0; y <= 200.0; y += 12.0) {
    for (const double x : {150.0, 190.0}) {
      try {
        const Eigen::Vector2d place(x - 50.0 * y / 239.0, y);
        PointTracker trial;
        trial.select(first, 0.0, {{cv::Mat(), {place}}});
        places.push_back(place);
      } catch (const std::invalid_argument&) {
        // has no texture
      }
    }
  }
  ASSERT_GE(places.size(), 10u);
  tracker_.select(first, 0.0, {{cv::Mat(), places}});
  int claims = 0, slid = 0;
  for (int k = 1; k <= 25; ++k) {
    const Eigen::Matrix3d g = motion({1.2 * k, 0.0});
    const PointsResult& result = tracker_.track(behind(g), kPeriod * k);
    for (std::size_t i = 0; k > 10 && i < places.size(); ++i) {
      const PointResult& point = result.points[i];
      if (point.state != State::kTracking) continue;
      ++claims;
      const double with_tissue = (point.place - geometry::apply(g, places[i])).norm(),
                   with_shaft = (point.place - places[i]).norm();
      if (std::min(with_tissue, with_shaft) > 2.0) ++slid;
    }
  }
  EXPECT_LE(slid, 0.03 * 15.0 * static_cast<double>(places.size())) << "of " << claims << " claims";
}

TEST_F(PointsTest, OfAStoredPictureAreFoundInTheImage) {
  const cv::Mat stored = image(Eigen::Matrix3d::Identity());
  corners_ = findCorners(stored, {70, 50, 180, 140}, 20, {});
  const Eigen::Matrix3d g = motion({25.0, 10.0}, -0.3, 1.15);
  tracker_.select(image(g, 0.85, 5.0), 0.0, {{stored, corners_}});
  EXPECT_GE(tracking(), corners_.size() / 2);
  EXPECT_LT(worst(g), 0.4);
  time_ = 0.0;
  for (int k = 1; k < 10; ++k) track(image(motion({25.0 + k, 10.0}, -0.3, 1.15)));
  EXPECT_GE(tracking(), corners_.size() * 3 / 4);
  EXPECT_LT(worst(motion({34.0, 10.0}, -0.3, 1.15)), 0.4);
}

TEST_F(PointsTest, GiveTheSameNumbersForTheSameImages) {
  select();
  std::vector<cv::Mat> images;
  for (int k = 0; k < 8; ++k) {
    images.push_back(image(motion({2.0 * k, k * 1.0})));
    if (k > 3 && k < 6) images.back().colRange(0, 200).setTo(cv::Scalar::all(70));
  }
  PointTracker a, b;
  for (PointTracker* tracker : {&a, &b}) tracker->select(images[0], 0.0, {{cv::Mat(), corners_}});
  for (std::size_t k = 1; k < images.size(); ++k) {
    const PointsResult &first = a.track(images[k], 0.04 * k), &second = b.track(images[k].clone(), 0.04 * k);
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      EXPECT_EQ(first.points[i].place, second.points[i].place);
      EXPECT_EQ(first.points[i].state, second.points[i].state);
      if (first.points[i].state == State::kTracking) {
        EXPECT_EQ(first.points[i].covariance, second.points[i].covariance);
      }
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo::features
