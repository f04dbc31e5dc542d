#include "tracking/align/block_matching.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "support/synthetic_lens.h"
#include "support/synthetic_tissue.h"
#include "tracking/align/shift_fit.h"

namespace laparoscope_servo::tracking {
namespace {

const geometry::Rectangle kRoi = {100, 80, 120, 110};
const cv::Size kSize(330, 280);

class BlockMatchingTest : public ::testing::Test {
 protected:
  BlockMatchingTest() { matching_.setReference(pyramid(scene_), kRoi); }

  static image::RegionPyramid pyramid(const cv::Mat& image) {
    image::RegionPyramid result;
    result.build(image, cv::Rect(cv::Point(0, 0), image.size()), 3, image::kLuma);
    return result;
  }
  const std::vector<BlockShift>& measured(const cv::Mat& image,
                                          const Eigen::Matrix3d& g = Eigen::Matrix3d::Identity()) {
    return matching_.measure(pyramid(image), g);
  }
  // The scene, moved by (x, y) px.
  cv::Mat moved(double x, double y, double gain = 1.0, double bias = 0.0, double noise = 0.0) const {
    Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
    g.topRightCorner<2, 1>() << x, y;
    return test::view(scene_, g, gain, bias, noise);
  }

  cv::Mat scene_ = test::tissue(kSize, 21);
  BlockMatching matching_;
};

TEST_F(BlockMatchingTest, FindsNearlyEveryBlockWhereItIs) {
  ASSERT_GE(matching_.blocks(), 30);
  const std::vector<BlockShift>& shifts = measured(scene_);
  EXPECT_EQ(confidentShifts(shifts), matching_.blocks());
  for (const BlockShift& s : shifts) {
    EXPECT_LT(s.shift.norm(), 0.05);
    EXPECT_NEAR(s.correlation, 1.0, 1e-3);
  }
}

TEST_F(BlockMatchingTest, SaysWhetherThereIsRoomForAllBlocks) {
  EXPECT_TRUE(matching_.hasRoom());
  matching_.setReference(pyramid(scene_), {100, 80, 29, 29});
  EXPECT_TRUE(matching_.hasRoom());
  matching_.setReference(pyramid(scene_), {100, 80, 28, 110});
  EXPECT_FALSE(matching_.hasRoom());
}

TEST_F(BlockMatchingTest, AShiftLeadsFromTheCentreToWhereTheBlockIsSeen) {
  const std::vector<BlockShift>& shifts = measured(moved(3.4, -2.6));
  EXPECT_GE(confidentShifts(shifts), 30);
  for (const BlockShift& s : shifts) {
    if (s.confident) {
      EXPECT_LT((s.shift - Eigen::Vector2d(3.4, -2.6)).norm(), 0.25);
    }
  }
}

TEST_F(BlockMatchingTest, ShiftsAreOfTheReferenceWhateverTheHomographyShows) {
  Eigen::Matrix3d claimed;
  claimed << 0.0, -1.0, 290.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;  // a quarter of a turn
  Eigen::Matrix3d true_shift = Eigen::Matrix3d::Identity();
  true_shift.topRightCorner<2, 1>() << 2.0, 4.0;
  const std::vector<BlockShift>& shifts = measured(test::view(scene_, claimed * true_shift), claimed);
  ASSERT_GE(confidentShifts(shifts), 25);
  for (const BlockShift& s : shifts) {
    if (s.confident) {
      EXPECT_LT((s.shift - Eigen::Vector2d(2.0, 4.0)).norm(), 0.2);
    }
  }
}

// Raw images of a lens; the finest level is as coarse as the image or coarser.
TEST(BlockMatchingOfRawImages, ShiftsAreInRectifiedPixelsAtAnyFinestScale) {
  const cv::Size size(480, 360);
  const geometry::Rectangle roi = {150, 90, 150, 140};
  const auto lens = std::make_shared<const image::Lens>(test::laparoscope(size, 330.0));
  const test::LensView view(*lens, size);
  const cv::Mat scene = test::tissue(cv::Size(640, 480), 3);
  const Eigen::Vector2d true_shift(4.0, -3.0);
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g.topRightCorner<2, 1>() = true_shift;
  for (const int finest : {1, 2}) {
    SCOPED_TRACE(finest);
    const auto pyramid = [&](const cv::Mat& image) {
      image::RegionPyramid result;
      result.build(image, cv::Rect(cv::Point(0, 0), image.size()), 2, image::kLuma, finest);
      return result;
    };
    BlockMatching matching(lens);
    matching.setReference(pyramid(view(scene, Eigen::Matrix3d::Identity())), roi);
    const std::vector<BlockShift>& shifts = matching.measure(pyramid(view(scene, g)), Eigen::Matrix3d::Identity());
    EXPECT_GE(confidentShifts(shifts), 25);
    for (const BlockShift& s : shifts) {
      if (s.confident) {
        EXPECT_LT((s.shift - true_shift).norm(), 0.3 * finest);
      }
    }
    cv::Mat mask = cv::Mat::zeros(size, CV_8UC1);  // of the raw image
    mask(cv::Rect(0, 0, 225, size.height)).setTo(255);
    for (const BlockShift& s : matching.measure(pyramid(view(scene, g)), Eigen::Matrix3d::Identity(), mask)) {
      const double side = BlockMatching::kSide * finest, x = lens->toRaw(s.centre).value().x();
      if (x < 225.0 - 0.2 * side) {
        EXPECT_FALSE(s.confident) << x;
      }
      if (x > 225.0 + side) {
        EXPECT_TRUE(s.confident) << x;
      }
    }
  }
}

// A ramp of shade, a gain and a veil move no block.
TEST_F(BlockMatchingTest, LightIsNoShift) {
  cv::Mat image = moved(1.0, 2.0, 0.5, 60.0, 1.0);
  for (int j = 0; j < image.rows; ++j) {
    for (int i = 0; i < image.cols; ++i) {
      for (int c = 0; c < 3; ++c) {
        unsigned char& value = image.at<cv::Vec3b>(j, i)[c];
        value = cv::saturate_cast<unsigned char>(value - 0.2 * i);
      }
    }
  }
  const std::vector<BlockShift>& shifts = measured(image);
  EXPECT_GE(confidentShifts(shifts), 25);
  const double off = medianShift(shifts, Eigen::Matrix3d::Identity());
  EXPECT_NEAR(off, std::hypot(1.0, 2.0), 0.2);
}

TEST_F(BlockMatchingTest, AnotherSceneHasHardlyABlockOfThis) {
  for (unsigned seed = 100; seed < 110; ++seed) {
    EXPECT_LT(confidentShifts(measured(test::tissue(kSize, seed))), 3) << seed;
  }
}

TEST_F(BlockMatchingTest, WhatIsCoveredIsNotConfidentAndTheRestIs) {
  cv::Mat image = moved(1.5, 0.0);
  cv::rectangle(image, cv::Rect(0, 0, 160, kSize.height), cv::Scalar(120, 120, 120), cv::FILLED);
  int covered = 0, free = 0;
  for (const BlockShift& s : measured(image)) {
    (s.centre.x() < 145.0 ? covered : free) += s.confident ? 1 : 0;
    if (s.confident && s.centre.x() > 180.0) {
      EXPECT_LT((s.shift - Eigen::Vector2d(1.5, 0.0)).norm(), 0.25);
    }
  }
  EXPECT_EQ(covered, 0);
  EXPECT_GE(free, 12);
}

// The border of the picture stands still, and is the strongest edge by far: it is found in place of the tissue.
TEST_F(BlockMatchingTest, WhatTheMaskCoversIsNoPartOfABlock) {
  cv::Mat mask(kSize, CV_8UC1, cv::Scalar(255));
  mask(cv::Rect(125, 100, 205, 180)).setTo(0);
  const auto faint = [&](const cv::Mat& scene) {
    cv::Mat image = 0.06 * scene + cv::Scalar(60, 60, 60);
    image.setTo(0, mask);
    return image;
  };
  const cv::Mat reference = faint(scene_), image = faint(moved(3.0, -2.0));
  const auto elsewhere = [](const std::vector<BlockShift>& shifts) {
    return std::count_if(shifts.begin(), shifts.end(), [](const BlockShift& s) {
      return s.confident && (s.shift - Eigen::Vector2d(3.0, -2.0)).norm() > 1.0;
    });
  };
  matching_.setReference(pyramid(reference), kRoi);
  EXPECT_GE(elsewhere(measured(image)), 3);
  matching_.setReference(pyramid(reference), kRoi, mask);
  const std::vector<BlockShift>& shifts = matching_.measure(pyramid(image), Eigen::Matrix3d::Identity(), mask);
  EXPECT_EQ(elsewhere(shifts), 0);
  EXPECT_GE(confidentShifts(shifts), 12);
}

TEST_F(BlockMatchingTest, WhatTheMaskCoversNowIsAskedForInVain) {
  cv::Mat mask = cv::Mat::zeros(kSize, CV_8UC1);
  mask(cv::Rect(0, 0, 160, kSize.height)).setTo(255);
  const std::vector<BlockShift>& shifts = matching_.measure(pyramid(scene_), Eigen::Matrix3d::Identity(), mask);
  EXPECT_EQ(static_cast<int>(shifts.size()), matching_.blocks()) << "they lie in the image";
  for (const BlockShift& s : shifts) {
    if (s.centre.x() < 155.0) {
      EXPECT_FALSE(s.confident) << s.centre.x();
    }
    if (s.centre.x() > 175.0) {
      EXPECT_TRUE(s.confident) << s.centre.x();
    }
  }
}

TEST_F(BlockMatchingTest, ARegionWithoutTextureHasNoBlocks) {
  BlockMatching plain;
  plain.setReference(pyramid(cv::Mat(kSize, CV_8UC3, cv::Scalar(60, 70, 140))), kRoi);
  EXPECT_EQ(plain.blocks(), 0);
  EXPECT_TRUE(plain.measure(pyramid(scene_), Eigen::Matrix3d::Identity()).empty());
}

TEST_F(BlockMatchingTest, ARegionSmallerThanABlockHasNone) {
  BlockMatching small;
  small.setReference(pyramid(scene_), {100, 80, 16, 16});
  EXPECT_EQ(small.blocks(), 0);
}

TEST_F(BlockMatchingTest, BlocksOutsideTheImageAreNotAsked) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  g(0, 2) = -170.0;  // the region's left two fifths are outside
  const std::vector<BlockShift>& shifts = measured(test::view(scene_, g), g);
  EXPECT_LT(static_cast<int>(shifts.size()), matching_.blocks());
  EXPECT_GT(confidentShifts(shifts), 10);
}

// Blocks of a small region overlap: neighbours that find the same by chance are no proof.
TEST_F(BlockMatchingTest, ASmallRegionIsNotFoundInAnotherScene) {
  BlockMatching small;
  small.setReference(pyramid(scene_), {120, 90, 60, 60});
  ASSERT_GE(small.blocks(), 30);
  EXPECT_GE(confidentShifts(small.measure(pyramid(moved(2.0, 1.0)), Eigen::Matrix3d::Identity())), 25);
  int images_with_proof = 0;
  for (unsigned seed = 100; seed < 140; ++seed) {
    const cv::Mat other = test::tissue(kSize, seed);
    images_with_proof += confidentShifts(small.measure(pyramid(other), Eigen::Matrix3d::Identity())) >= 3;
  }
  EXPECT_LE(images_with_proof, 1);
}

// Smooth tissue: what a block of the fine level holds looks alike all around.
TEST_F(BlockMatchingTest, OnSmoothTissueBlocksAreLargerAndTellMore) {
  cv::Mat smooth;
  cv::GaussianBlur(scene_, smooth, cv::Size(), 12.0);
  cv::addWeighted(smooth, 4.0, smooth, 0.0, -300.0, smooth);
  BlockMatching fine, chosen;
  fine.setReference(pyramid(smooth), kRoi, 0);
  chosen.setReference(pyramid(smooth), kRoi);
  EXPECT_LT(fine.blocks(), 12);
  EXPECT_EQ(chosen.level(), 1);
  EXPECT_GT(chosen.blocks(), fine.blocks());
  EXPECT_EQ(matching_.level(), 0) << "where the fine level tells enough";
}

TEST_F(BlockMatchingTest, ACoarserLevelFindsWhatIsTooFarForTheFineOne) {
  BlockMatching coarse;
  coarse.setReference(pyramid(scene_), kRoi, matching_.level() + 1);
  EXPECT_EQ(coarse.scale(), 2.0 * matching_.scale());
  const cv::Mat image = moved(12.0, -3.0);
  EXPECT_LT(confidentShifts(measured(image)), 3);
  const std::vector<BlockShift>& shifts = coarse.measure(pyramid(image), Eigen::Matrix3d::Identity());
  EXPECT_GE(confidentShifts(shifts), 20);
  EXPECT_NEAR(medianShift(shifts, Eigen::Matrix3d::Identity()), std::hypot(12.0, 3.0), 0.5);
}

}  // namespace
}  // namespace laparoscope_servo::tracking
