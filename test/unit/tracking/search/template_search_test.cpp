#include "tracking/search/template_search.h"

#include <gtest/gtest.h>

#include "support/synthetic_tissue.h"
#include "tracking/esm/esm.h"

namespace laparoscope_servo::tracking {
namespace {

const geometry::Rectangle kRoi = {60, 50, 80, 70};

class RelocalisationTest : public ::testing::Test {
 protected:
  cv::Mat scene_ = test::tissue(cv::Size(480, 360), 21);
  Esm esm_{EsmConfig()};

  void SetUp() override { esm_.setReference(pyramidOf(scene_), kRoi); }
  static image::RegionPyramid pyramidOf(const cv::Mat& image) {
    image::RegionPyramid pyramid;
    pyramid.build(image, cv::Rect(0, 0, image.cols, image.rows), 3, image::kLuma);
    return pyramid;
  }
  std::vector<Candidate> search(const cv::Mat& image, const Eigen::Matrix3d& last, int count = 3) {
    const EsmLevel& level = esm_.level(2);
    return templateSearch(level.planes[0].value.view(), level.image_T_patch, pyramidOf(image).level(2), level.scale,
                          kRoi, last, count);
  }
};

TEST_F(RelocalisationTest, FindsTheRegionWhereverItMoved) {
  for (const auto& [x, y] :
       {std::pair(0.0, 0.0), std::pair(250.0, 150.0), std::pair(-40.0, -30.0), std::pair(301.0, 77.0)}) {
    Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
    g.topRightCorner<2, 1>() << x, y;
    const std::vector<Candidate> found = search(test::view(scene_, g), Eigen::Matrix3d::Identity());
    ASSERT_FALSE(found.empty());
    EXPECT_LT(geometry::cornerDistance(found[0].g, g, kRoi), 4.0);  // one pixel of the level
    EXPECT_GT(found[0].score, 0.7);  // half a pixel of the level off, fine texture has gone
  }
}

TEST_F(RelocalisationTest, KeepsTheLastScaleAndRotation) {
  Eigen::Matrix3d turn;
  turn << 1.1, -0.2, 60.0, 0.2, 1.1, 20.0, 0.0, 0.0, 1.0;
  Eigen::Matrix3d moved = turn;
  moved(0, 2) += 120.0;
  const std::vector<Candidate> found = search(test::view(scene_, moved), turn / std::cbrt(turn.determinant()));
  ASSERT_FALSE(found.empty());
  EXPECT_LT(geometry::cornerDistance(found[0].g, moved, kRoi), 5.0);
  EXPECT_NEAR(found[0].g.determinant(), 1.0, 1e-9);
}

TEST_F(RelocalisationTest, CandidatesAreOrderedAndApart) {
  const std::vector<Candidate> found = search(scene_, Eigen::Matrix3d::Identity(), 4);
  ASSERT_GE(found.size(), 2u);
  for (std::size_t k = 1; k < found.size(); ++k) {
    EXPECT_LE(found[k].score, found[k - 1].score);
    for (std::size_t l = 0; l < k; ++l) EXPECT_GT(geometry::cornerDistance(found[k].g, found[l].g, kRoi), 10.0);
  }
}

TEST_F(RelocalisationTest, HasNoCandidateWhereTheRegionDoesNotFit) {
  Eigen::Matrix3d huge = Eigen::Vector3d(20.0, 20.0, 1.0).asDiagonal();
  EXPECT_TRUE(search(scene_, huge).empty());
  Eigen::Matrix3d mirrored = Eigen::Vector3d(-1.0, 1.0, 1.0).asDiagonal();
  EXPECT_TRUE(search(scene_, mirrored).empty());
}

}  // namespace
}  // namespace laparoscope_servo::tracking
