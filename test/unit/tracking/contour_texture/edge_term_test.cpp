#include "tracking/contour_texture/edge_term.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "laparoscope_servo/geometry/sl3.h"
#include "support/contour_scene.h"

namespace laparoscope_servo::tracking {
namespace {

using geometry::Vector8d;
using test_support::ContourScene;

class EdgeTermTest : public testing::Test {
 protected:
  EdgeTermTest() {
    features::Spline contour = features::Spline::throughPoints(ContourScene::selection(0.0)[0].points, true);
    term_.learn(scene_.image(0, 1), Outline(contour, n_));
  }

  // Of G alone.
  static Vector8d step(const Matrix10d& information, const Vector10d& score) {
    return -information.topLeftCorner<8, 8>().ldlt().solve(score.head<8>());
  }

  const ContourScene scene_{ContourScene::Look()};
  const geometry::Rectangle roi_{85.0, 50.0, 150.0, 140.0};
  const Eigen::Matrix3d n_ = templateFromPixels(roi_);
  const geometry::Sl3Steps steps_{n_};
  EdgeTerm term_{features::EdgeConfig()};
};

TEST_F(EdgeTermTest, AStepOfItsEquationsLeadsToTheContour) {
  const Eigen::Matrix3d truth = scene_.motion(3);
  term_.look(scene_.image(3, 2), Eigen::Matrix3d::Identity(), 20.0, 64);
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  ASSERT_GT(geometry::cornerDistance(g, truth, roi_), 8.0);
  for (int k = 0; k < 10; ++k) {
    Matrix10d information = Matrix10d::Zero();
    Vector10d score = Vector10d::Zero();
    term_.add(g, 1.0, information, score);
    information.diagonal().array() += 1e-3;
    g = steps_.plus(g, step(information, score));
  }
  term_.look(scene_.image(3, 2), g, 6.0, 200);
  for (int k = 0; k < 5; ++k) {
    Matrix10d information = Matrix10d::Zero();
    Vector10d score = Vector10d::Zero();
    term_.add(g, 1.0, information, score);
    g = steps_.plus(g, step(information, score));
  }
  for (const double angle : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0}) {
    const Eigen::Vector2d p = ContourScene::at(angle);
    EXPECT_LT((geometry::apply(g, p) - geometry::apply(truth, p)).norm(), 1.2) << angle;  // along itself it may slide
  }
}

// One step of Gauss-Newton undoes a small displacement, whatever its direction, as far as the contour shows it: along
// its normals.
TEST_F(EdgeTermTest, AStepUndoesASmallDisplacement) {
  const cv::Mat image = scene_.image(0, 2);
  for (int p = 0; p < 8; ++p) {
    Vector8d away = Vector8d::Zero();
    away[p] = 0.03;
    const Eigen::Matrix3d g = steps_.plus(Eigen::Matrix3d::Identity(), away);
    term_.look(image, g, 6.0, 200);
    const auto offset = [&](const Eigen::Matrix3d& at) {
      term_.gate(at);
      term_.forget();
      double sum = 0.0;
      for (const features::SiteFinding& finding : term_.findings()) sum += (finding.edge - finding.point).norm();
      return sum / static_cast<double>(term_.findings().size());
    };
    Matrix10d information = Matrix10d::Zero();
    Vector10d score = Vector10d::Zero();
    term_.add(g, 1.0, information, score);
    const double before = offset(g), after = offset(steps_.plus(g, step(information, score)));
    EXPECT_GT(before, 0.3) << p;
    EXPECT_LT(after, 0.25) << p;
  }
}

TEST_F(EdgeTermTest, AFewEdgesFarOffDoNotPull) {
  const auto cover = [](cv::Mat1f& picture) { picture(cv::Rect(0, 0, 110, 240)).setTo(40.0f); };
  const cv::Mat image = scene_.image(0, 2, cover);
  term_.look(image, Eigen::Matrix3d::Identity(), 20.0, 200);
  Matrix10d information = Matrix10d::Zero();
  Vector10d score = Vector10d::Zero();
  term_.add(Eigen::Matrix3d::Identity(), 1.0, information, score);
  const Eigen::Matrix3d moved = steps_.plus(Eigen::Matrix3d::Identity(), step(information, score));
  EXPECT_LT(geometry::cornerDistance(moved, Eigen::Matrix3d::Identity(), roi_), 2.0);
  EXPECT_LT(term_.sigma(), 1.0);
}

TEST_F(EdgeTermTest, JudgesWhetherTheContourIsThere) {
  const Matrix8d exact = 1e-8 * Matrix8d::Identity();
  const cv::Mat image = scene_.image(0, 2);
  term_.look(image, Eigen::Matrix3d::Identity(), 3.0, 200);
  term_.gate(Eigen::Matrix3d::Identity());
  const features::EdgeReport there = term_.judge(exact, 0.3);
  EXPECT_EQ(there.reason, features::Reason::kNone);
  EXPECT_GT(there.share, 0.9);
  const cv::Mat empty(ContourScene::kSize, CV_8UC1, cv::Scalar(100));
  term_.look(empty, Eigen::Matrix3d::Identity(), 3.0, 200);
  term_.gate(Eigen::Matrix3d::Identity());
  EXPECT_NE(term_.judge(exact, 0.3).reason, features::Reason::kNone);
  Eigen::Matrix3d aside = Eigen::Matrix3d::Identity();
  aside(0, 2) = 12.0;
  term_.look(image, aside, 3.0, 200);
  term_.gate(aside);
  EXPECT_LT(term_.judge(exact, 0.3).share, 0.5);
}

// Edges of what covers a part of the contour that lie on it here and there.
TEST_F(EdgeTermTest, SitesWhoseNeighboursDoNotAgreeLoseTheirSay) {
  const auto cover = [](cv::Mat1f& picture) {
    const cv::Rect left(0, 0, 150, 240);
    test::texture(picture.size(), 110.0, 20.0, 2.0, 9)(left).copyTo(picture(left));
  };
  term_.look(scene_.image(0, 2, cover), Eigen::Matrix3d::Identity(), 6.0, 200);
  for (int k = 0; k < 3; ++k) term_.gate(Eigen::Matrix3d::Identity());
  int believed = 0, covered = 0, in_sight = 0;
  for (const features::SiteFinding& finding : term_.findings()) {
    const bool has_say = finding.weight >= features::kAgreeWeight;
    if (finding.point.x() < 140.0) {
      ++covered;
      believed += has_say ? 1 : 0;
    } else if (finding.point.x() > 160.0) {
      in_sight += has_say ? 0 : 1;
    }
  }
  EXPECT_GT(covered, 30);
  EXPECT_LT(believed, covered / 6);
  EXPECT_EQ(in_sight, 0);
}

// A cover over half of the contour, 4 px further in, whose edge looks like the contour's: in the images that follow it
// does not pull any more before it is found to be a cover.
TEST_F(EdgeTermTest, WhatIsCoveredHasNoSayUntilItsNeighboursAgreeAgain) {
  const auto cover = [](cv::Mat1f& picture) {
    std::vector<cv::Point> ring;
    for (int k = 0; k <= 120; ++k) {
      const double angle = M_PI * (k <= 60 ? k : 120 - k) / 60.0;
      const Eigen::Vector2d arm = ContourScene::at(angle) - ContourScene::kCentre;
      const Eigen::Vector2d p = ContourScene::kCentre + (k <= 60 ? 1.4 : 1.0 - 4.0 / arm.norm()) * arm;
      ring.emplace_back(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
    }
    cv::fillPoly(picture, std::vector<std::vector<cv::Point>>{ring}, cv::Scalar(85.0));
  };
  const Eigen::Matrix3d there = Eigen::Matrix3d::Identity();
  const auto pullOf = [&](const cv::Mat& image) {
    term_.look(image, there, 6.0, 200);
    Matrix10d information = Matrix10d::Zero();
    Vector10d score = Vector10d::Zero();
    term_.add(there, 1.0, information, score);
    return score.head<8>().norm() / information.topLeftCorner<8, 8>().trace();
  };
  const double in_sight = pullOf(scene_.image(0, 2)), at_first = pullOf(scene_.image(0, 3, cover));
  EXPECT_GT(at_first, 5.0 * in_sight);
  term_.gate(there);
  EXPECT_LT(pullOf(scene_.image(0, 4, cover)), 0.3 * at_first);
  EXPECT_FALSE(term_.gate(there)) << "nothing is newly covered";
  pullOf(scene_.image(0, 5));
  term_.gate(there);
  EXPECT_LT(pullOf(scene_.image(0, 6)), 2.0 * in_sight);
  term_.gate(there);
  const auto agree = std::count_if(term_.findings().begin(), term_.findings().end(),
                                   [](const auto& finding) { return finding.weight >= features::kAgreeWeight; });
  EXPECT_GT(static_cast<double>(agree), 0.9 * static_cast<double>(term_.findings().size()))
      << "all of it has a say again";
}

TEST_F(EdgeTermTest, SaysNothingWithoutEdges) {
  const cv::Mat empty(ContourScene::kSize, CV_8UC1, cv::Scalar(100));
  term_.look(empty, Eigen::Matrix3d::Identity(), 20.0, 64);
  Matrix10d information = Matrix10d::Zero();
  Vector10d score = Vector10d::Zero();
  term_.add(Eigen::Matrix3d::Identity(), 1.0, information, score);
  EXPECT_TRUE((information.topLeftCorner<8, 8>().isZero(0.0)));
  EXPECT_TRUE(score.isZero(0.0)) << "the gain is the one that is expected";
  term_.add(Eigen::Matrix3d::Identity(), 1.2, information, score);
  EXPECT_GT(score[8], 0.0);
  EXPECT_EQ(term_.coarse(20.0).share, 0.0);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
