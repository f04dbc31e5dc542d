#include "tracking/contour_texture/outline.h"

#include <gtest/gtest.h>

#include "laparoscope_servo/geometry/sl3.h"
#include "support/contour_scene.h"
#include "tracking/esm/normal_equations.h"

namespace laparoscope_servo::tracking {
namespace {

using test_support::ContourScene;

class OutlineTest : public testing::Test {
 protected:
  const ContourScene scene_{ContourScene::Look()};
  const features::Spline contour_ = features::Spline::throughPoints(ContourScene::selection(0.0)[0].points, true);
  const geometry::Rectangle roi_{85.0, 50.0, 150.0, 140.0};
  const Eigen::Matrix3d n_ = templateFromPixels(roi_);
  const Outline outline_{contour_, n_};
  std::vector<features::Site> sites_;
};

TEST_F(OutlineTest, SitesLieOnTheMovedContourAndFaceAcrossIt) {
  for (const int k : {0, 7, 20}) {
    const Eigen::Matrix3d g = scene_.motion(k);
    outline_.sites(g, 4.0, 200, sites_);
    EXPECT_EQ(sites_.size(), 100u);
    for (std::size_t i = 0; i < sites_.size(); ++i) {
      const features::Site& site = sites_[i];
      EXPECT_LT((site.point - geometry::apply(g, outline_.point(site.slot))).norm(), 1e-9);
      EXPECT_NEAR(site.normal.norm(), 1.0, 1e-9);
      const Eigen::Vector2d along = sites_[(i + 1) % sites_.size()].point - sites_[(i + 99) % sites_.size()].point;
      EXPECT_LT(std::abs(site.normal.dot(along.normalized())), 0.05) << i;
    }
  }
}

TEST_F(OutlineTest, AreThoseOfTheSplineWhereItWasSelected) {
  std::vector<features::Site> spline;
  contour_.sites(4.0, 100, spline);
  outline_.sites(Eigen::Matrix3d::Identity(), 4.0, 100, sites_);
  ASSERT_EQ(spline.size(), sites_.size());
  for (std::size_t i = 0; i < sites_.size(); ++i) {
    EXPECT_EQ(spline[i].slot, sites_[i].slot);
    EXPECT_LT((spline[i].point - sites_[i].point).norm(), 0.6);
    EXPECT_GT(spline[i].normal.dot(sites_[i].normal), 0.999);
    EXPECT_NEAR(spline[i].curvature, sites_[i].curvature, 0.01) << i;
  }
}

TEST_F(OutlineTest, TheJacobianIsThatOfDifferences) {
  const geometry::Sl3Steps steps(n_);
  constexpr double kStep = 1e-6;
  for (const int k : {0, 13, 30}) {
    const Eigen::Matrix3d g = scene_.motion(k);
    outline_.sites(g, 4.0, 50, sites_);
    for (const features::Site& site : sites_) {
      ASSERT_EQ(site.first, 0);
      ASSERT_EQ(site.count, 8);
      for (int p = 0; p < 8; ++p) {
        geometry::Vector8d x = geometry::Vector8d::Zero();
        x[p] = kStep;
        const Eigen::Vector2d moved = geometry::apply(steps.plus(g, x), outline_.point(site.slot));
        EXPECT_NEAR(site.normal.dot(moved - site.point) / kStep, site.jacobian[static_cast<std::size_t>(p)], 1e-3)
            << p << ' ' << site.slot;
      }
    }
  }
}

TEST_F(OutlineTest, HasNoMoreSitesThanAskedForAndFewerWhereTheContourIsShort) {
  outline_.sites(Eigen::Matrix3d::Identity(), 1.0, 60, sites_);
  EXPECT_LE(sites_.size(), 60u);
  outline_.sites(Eigen::Matrix3d::Identity(), 20.0, 400, sites_);
  EXPECT_EQ(sites_.size(), 25u);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
