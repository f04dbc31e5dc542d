#include "ros/playback/scenes.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "ros/playback/first_image.h"
#include "support/synthetic_sequence.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

class ScenesTest : public testing::Test {
 protected:
  ScenesTest() { options_.inputs = {folder_.path()}; }

  // `bare`: the left half has no texture.
  void addShot(int images, std::uint64_t seed, bool bare = false) {
    const cv::Mat scene = test_support::texture(cv::Size(400, 240), seed);
    for (int k = 0; k < images; ++k) {
      cv::Mat image = scene(cv::Rect(k, 0, 320, 240)).clone();
      if (bare) image.colRange(0, 200).setTo(cv::Scalar::all(100));
      cv::imwrite(folder_.file(std::to_string(written_++) + ".png"), image);
    }
  }

  std::vector<std::size_t> framesOf(const Scene& scene) const {
    SourceOptions span;
    span.start = scene.start;
    span.end = scene.end;
    const auto source = openImageSource(folder_.path(), span);
    std::vector<std::size_t> frames;
    while (const auto image = source->next()) frames.push_back(image->frame);
    return frames;
  }

  test_support::TemporaryFolder folder_;
  OfflineOptions options_;
  int written_ = 0;
};

TEST_F(ScenesTest, AreWhatLiesBetweenCuts) {
  addShot(8, 1);
  addShot(12, 2, true);
  const std::vector<Scene> scenes = findScenes(options_);
  ASSERT_EQ(scenes.size(), 2u);
  const auto first = framesOf(scenes[0]), second = framesOf(scenes[1]);
  EXPECT_EQ(first.size(), 8u);
  EXPECT_EQ(first.front(), 0u);
  EXPECT_EQ(second.size(), 12u);
  EXPECT_EQ(second.front(), 8u);
}

TEST_F(ScenesTest, HaveARegionThatIsTakenInTheirFirstImage) {
  addShot(8, 1);
  addShot(12, 2, true);
  const std::vector<Scene> scenes = findScenes(options_);
  ASSERT_EQ(scenes.size(), 2u);
  for (const Scene& scene : scenes) {
    options_.source.start = scene.start;
    const FirstImage image(options_);
    ASSERT_TRUE(scene.roi);
    EXPECT_EQ(image.refusal(*scene.roi), "");
  }
  EXPECT_NE(scenes[0].roi->x, scenes[1].roi->x);
}

TEST_F(ScenesTest, AreOfTheWholeInput) {
  addShot(8, 1);
  addShot(12, 2);
  options_.source.start = 0.4;
  options_.source.end = 0.5;
  options_.source.crop = cv::Rect(0, 0, 64, 64);
  EXPECT_EQ(findScenes(options_).size(), 2u);
}

TEST_F(ScenesTest, GoOnBehindAnImageThatCannotBeDecoded) {
  addShot(8, 1);
  std::ofstream(folder_.file("3.png")) << "no picture";
  addShot(12, 2);
  const std::vector<Scene> scenes = findScenes(options_);
  ASSERT_EQ(scenes.size(), 2u);
  EXPECT_EQ(framesOf(scenes[1]).front(), 8u);
}

TEST_F(ScenesTest, WithoutCutsThereIsOneWithoutEnd) {
  addShot(8, 1);
  const std::vector<Scene> scenes = findScenes(options_);
  ASSERT_EQ(scenes.size(), 1u);
  EXPECT_EQ(scenes[0].start, 0.0);
  EXPECT_EQ(scenes[0].end, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(scenes[0].roi);
}

}  // namespace
}  // namespace laparoscope_servo
