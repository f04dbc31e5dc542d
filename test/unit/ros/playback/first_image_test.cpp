#include "ros/playback/first_image.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "support/synthetic_sequence.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

class FirstImageTest : public testing::Test {
 protected:
  // Its left half has no texture.
  FirstImageTest() {
    cv::Mat picture = test_support::texture(cv::Size(640, 400));
    picture.colRange(0, 320).setTo(cv::Scalar::all(100));
    cv::imwrite(folder_.file("0.png"), picture);
    cv::imwrite(folder_.file("1.png"), picture);
    options_.inputs = {folder_.path()};
  }

  test_support::TemporaryFolder folder_;
  OfflineOptions options_;
};

TEST_F(FirstImageTest, IsTheOneInWhichTheRegionIsSelected) {
  const FirstImage first(options_);
  EXPECT_EQ(first.frame(), 0u);
  EXPECT_EQ(first.size(), cv::Size(640, 400));
  EXPECT_EQ(first.picture(320).size(), cv::Size(320, 200));
  options_.inputs.clear();
  EXPECT_THROW(FirstImage{options_}, std::invalid_argument);
}

TEST_F(FirstImageTest, ProposesARegionThatWouldBeTaken) {
  const FirstImage first(options_);
  EXPECT_EQ(first.refusal({400, 150, 100, 100}), "");
  const geometry::Rectangle bare{180, 150, 100, 100};
  EXPECT_NE(first.refusal(bare), "");
  const auto proposal = first.proposal(bare);
  ASSERT_TRUE(proposal);
  EXPECT_EQ(first.refusal(*proposal), "");
}

TEST_F(FirstImageTest, SuggestsASquareThatWouldBeTaken) {
  const FirstImage first(options_);
  const auto suggestion = first.suggestion();
  ASSERT_TRUE(suggestion);
  EXPECT_EQ(first.refusal(*suggestion), "");
}

TEST_F(FirstImageTest, ProposesNothingForARegionThatIsNone) {
  EXPECT_FALSE(FirstImage(options_).proposal({0, 0, 0, 0}));
}

}  // namespace
}  // namespace laparoscope_servo
