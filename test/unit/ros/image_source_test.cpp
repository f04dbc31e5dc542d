#include "laparoscope_servo/ros/image_source.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "image_source_fixture.h"

namespace laparoscope_servo::skin {
namespace {

TEST_F(ImageSourceTest, FolderGivesImagesInTheOrderOfTheirNames) {
  cv::imwrite(folder_.file("b.png"), numbered(1));
  cv::imwrite(folder_.file("a.JPG"), numbered(0));
  cv::imwrite(folder_.file("c.bmp"), numbered(2));
  writeFile("0_notes.txt", "no image");
  writeFile(".hidden.png", "no image");
  const auto images = readAll(folder_.path());
  ASSERT_EQ(images.size(), 3u);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(numberOf(images[k]), k);
    EXPECT_EQ(images[k].frame, static_cast<std::size_t>(k));
    EXPECT_EQ(images[k].header.stamp, ros::Time(k / 25.0));
    EXPECT_EQ(images[k].error, "");
  }
}

TEST_F(ImageSourceTest, FolderSkipsToTheStartAndKeepsTheNumbers) {
  for (int k = 0; k < 8; ++k) cv::imwrite(folder_.file(std::to_string(k) + ".png"), numbered(k));
  SourceOptions options;
  options.folder_rate = 10.0;
  options.start = 0.3;  // frame 3 is at 0.3 s, whatever rounding says
  const auto images = readAll(folder_.path(), options);
  ASSERT_EQ(images.size(), 5u);
  EXPECT_EQ(images[0].frame, 3u);
  EXPECT_EQ(numberOf(images[0]), 3);
  EXPECT_EQ(images[0].header.stamp, ros::Time(0.3));
}

TEST_F(ImageSourceTest, FolderNamesAFileThatCannotBeReadAndGoesOn) {
  cv::imwrite(folder_.file("a.png"), numbered(0));
  writeFile("b.png", "this is no image");
  cv::imwrite(folder_.file("c.png"), numbered(2));
  const auto images = readAll(folder_.path());
  ASSERT_EQ(images.size(), 3u);
  EXPECT_TRUE(mentions(images[1].error, "b.png")) << images[1].error;
  EXPECT_EQ(numberOf(images[2]), 2);
}

TEST_F(ImageSourceTest, FolderWithoutImagesIsAnError) {
  EXPECT_TRUE(mentions(errorOf(folder_.path()), "no images"));
}

TEST_F(ImageSourceTest, FolderMayHoldImagesOfSixteenBitAndGrey) {
  cv::imwrite(folder_.file("a.png"), cv::Mat(48, 64, CV_16UC1, cv::Scalar(257 * 10)));
  cv::imwrite(folder_.file("b.png"), cv::Mat(48, 64, CV_8UC1, cv::Scalar(20)));
  const auto images = readAll(folder_.path());
  ASSERT_EQ(images.size(), 2u);
  EXPECT_EQ(numberOf(images[0]), 0);
  EXPECT_EQ(numberOf(images[1]), 1);
  EXPECT_EQ(trackerImage(images[0].decoded).type(), CV_8UC1);
}

TEST_F(ImageSourceTest, VideoHasStampsOfItsRate) {
  const std::string path = folder_.file("video.avi");
  cv::VideoWriter writer(path, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 20.0, cv::Size(64, 48));
  if (!writer.isOpened()) GTEST_SKIP() << "this OpenCV writes no video";
  for (int k = 0; k < 6; ++k) writer.write(numbered(k));
  writer.release();
  const auto images = readAll(path);
  ASSERT_EQ(images.size(), 6u);
  for (int k = 0; k < 6; ++k) {
    EXPECT_EQ(numberOf(images[k]), k);
    EXPECT_EQ(images[k].header.stamp, ros::Time(k / 20.0));
  }
  EXPECT_EQ(openImageSource(path, {})->size(), 6u);
  EXPECT_EQ(openImageSource(path, {})->rate(), 20.0);
  SourceOptions options;
  options.start = 0.1;
  const auto later = readAll(path, options);
  ASSERT_EQ(later.size(), 4u);
  EXPECT_EQ(later[0].frame, 2u);
  EXPECT_EQ(numberOf(later[0]), 2);
  // Frames are buffers of their own.
  EXPECT_NE(images[0].decoded.data, images[1].decoded.data);
}

TEST_F(ImageSourceTest, SaysWhatItExpectsOfAFileThatIsNothing) {
  EXPECT_TRUE(mentions(errorOf(folder_.file("missing.bag")), "does not exist"));
  EXPECT_TRUE(mentions(errorOf(writeFile("noise.mp4", "no video")), "expected a bag"));
  EXPECT_TRUE(mentions(errorOf(writeFile("empty.mp4", "")), "expected a bag"));
  const std::string bag = errorOf(writeFile("noise.bag", "no bag, but named as one"));
  EXPECT_TRUE(mentions(bag, "no bag")) << bag;
  EXPECT_NE(errorOf(writeFile("empty.bag", "")), "");
}

TEST_F(ImageSourceTest, RefusesOptionsThatMakeNoSense) {
  cv::imwrite(folder_.file("a.png"), numbered(0));
  SourceOptions options;
  options.start = -1.0;
  EXPECT_TRUE(mentions(errorOf(folder_.path(), options), "start"));
  options = {};
  options.folder_rate = 0.0;
  EXPECT_TRUE(mentions(errorOf(folder_.path(), options), "rate"));
  options = {};
  options.start = 10.0;
  EXPECT_TRUE(readAll(folder_.path(), options).empty());
}

}  // namespace
}  // namespace laparoscope_servo::skin
