#include "ros/playback/image_source.h"

#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <utility>
#include <vector>

#include "unit/ros/image_source_fixture.h"

namespace laparoscope_servo {
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

TEST_F(ImageSourceTest, FolderEndsInFrontOfTheImageAtTheEnd) {
  for (int k = 0; k < 8; ++k) cv::imwrite(folder_.file(std::to_string(k) + ".png"), numbered(k));
  SourceOptions options;
  options.folder_rate = 10.0;
  options.start = 0.2;
  options.end = 0.7;  // frame 7 is at 0.7 s, whatever rounding says
  const auto images = readAll(folder_.path(), options);
  ASSERT_EQ(images.size(), 5u);
  EXPECT_EQ(numberOf(images.front()), 2);
  EXPECT_EQ(numberOf(images.back()), 6);
}

TEST_F(ImageSourceTest, CropGivesThatPartOfEachImageAndRefusesSmallerOnes) {
  cv::Mat image(60, 40, CV_8UC3, cv::Scalar::all(10));
  image(cv::Rect(5, 30, 20, 10)).setTo(200);
  cv::imwrite(folder_.file("a.png"), image);
  cv::imwrite(folder_.file("b.png"), image.rowRange(0, 35));
  cv::imwrite(folder_.file("c.png"), image);
  SourceOptions options;
  options.crop = {5, 30, 20, 10};
  const auto images = readAll(folder_.path(), options);
  ASSERT_EQ(images.size(), 3u);
  for (const std::size_t k : {0u, 2u}) {
    ASSERT_EQ(images[k].decoded.size(), cv::Size(20, 10));
    EXPECT_TRUE(images[k].decoded.isContinuous());
    EXPECT_EQ(cv::mean(images[k].decoded)[0], 200.0);
  }
  EXPECT_EQ(images[1].error, "the image has 40x35 px, expected at least 25x40 for crop");
  EXPECT_TRUE(images[1].decoded.empty());
}

TEST_F(ImageSourceTest, CropIsNoneOfABag) {
  writeFile("a.bag", "#ROSBAG V2.0");
  SourceOptions options;
  options.crop = {0, 0, 20, 10};
  EXPECT_NE(errorOf(folder_.file("a.bag"), options).find("expected a video or a folder of images"), std::string::npos);
}

TEST_F(ImageSourceTest, BehindTheFirstImageItResumesLater) {
  for (int k = 0; k < 8; ++k) cv::imwrite(folder_.file(std::to_string(k) + ".png"), numbered(k));
  SourceOptions options;
  options.folder_rate = 10.0;
  options.start = 0.1;
  options.resume = 0.5;
  options.end = 0.7;
  const auto images = readAll(folder_.path(), options);
  ASSERT_EQ(images.size(), 3u);
  EXPECT_EQ(numberOf(images[0]), 1);
  EXPECT_EQ(numberOf(images[1]), 5);
  EXPECT_EQ(images[2].frame, 6u);
}

TEST_F(ImageSourceTest, FolderNamesAFileThatCannotBeReadAndGoesOn) {
  cv::imwrite(folder_.file("a.png"), numbered(0));
  writeFile("b.png", "this is no image");
  writeFile("c.ppm", "P6\n100000 100000\n255\nxxx");  // more pixels than OpenCV reads
  cv::imwrite(folder_.file("d.png"), numbered(3));
  const auto images = readAll(folder_.path());
  ASSERT_EQ(images.size(), 4u);
  EXPECT_TRUE(mentions(images[1].error, "b.png")) << images[1].error;
  EXPECT_TRUE(mentions(images[2].error, "c.ppm")) << images[2].error;
  EXPECT_EQ(numberOf(images[3]), 3);
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

TEST_F(ImageSourceTest, FolderCountsNumbersInNamesAsNumbers) {
  for (const int k : {0, 1, 2, 9, 10, 11, 20})
    cv::imwrite(folder_.file("frame" + std::to_string(k) + ".png"), numbered(k));
  std::vector<int> numbers;
  for (const SourceImage& image : readAll(folder_.path())) numbers.push_back(numberOf(image));
  EXPECT_EQ(numbers, (std::vector<int>{0, 1, 2, 9, 10, 11, 20}));
}

// A JPEG that says how it has to be turned, as cameras write it.
void writeTurned(const std::string& path, const cv::Mat& image, char orientation) {
  std::vector<unsigned char> jpeg;
  cv::imencode(".jpg", image, jpeg);
  std::string exif("Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0?\0\0\0\0\0\0", 32);
  exif[exif.find('?')] = orientation;
  const std::string header = std::string("\xFF\xE1\0", 3) + static_cast<char>(exif.size() + 2) + exif;
  jpeg.insert(jpeg.begin() + 2, header.begin(), header.end());
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(jpeg.data()), static_cast<std::streamsize>(jpeg.size()));
}

TEST_F(ImageSourceTest, FolderTurnsImagesAsTheySay) {
  cv::Mat stored(48, 64, CV_8UC3, cv::Scalar::all(128));
  stored(cv::Rect(0, 0, 16, 16)) = cv::Scalar(0, 0, 255);
  cv::Mat turned = stored;
  int k = 0;
  for (const auto& [orientation, code] : {std::pair<char, int>{1, -1},
                                          {3, cv::ROTATE_180},
                                          {6, cv::ROTATE_90_CLOCKWISE},
                                          {8, cv::ROTATE_90_COUNTERCLOCKWISE}}) {
    writeTurned(folder_.file(std::to_string(k) + ".jpg"), stored, orientation);
    if (code >= 0) cv::rotate(stored, turned, code);
    const auto images = readAll(folder_.path());
    ASSERT_EQ(images[k].error, "");
    ASSERT_EQ(images[k].decoded.size(), turned.size()) << k;
    EXPECT_LT(cv::norm(images[k].decoded, turned, cv::NORM_L1) / static_cast<double>(turned.total()), 6.0) << k;
    ++k;
  }
}

TEST_F(ImageSourceTest, FolderDropsAlphaAndPassesSizesOn) {
  const cv::Mat with_alpha(48, 64, CV_8UC4, cv::Scalar(20, 20, 20, 7));
  cv::imwrite(folder_.file("0.png"), with_alpha);
  cv::imwrite(folder_.file("1.png"), cv::Mat(96, 128, CV_8UC3, cv::Scalar::all(20)));
  const auto images = readAll(folder_.path());
  ASSERT_EQ(images.size(), 2u);
  EXPECT_EQ(numberOf(images[0]), 1);
  EXPECT_EQ(images[0].decoded.size(), cv::Size(64, 48));
  EXPECT_EQ(images[1].decoded.size(), cv::Size(128, 96));
}

TEST_F(ImageSourceTest, OneTextMayNameSeveralInputs) {
  for (const char* name : {"a_0.bag", "a_1.bag", "a b.bag"}) writeFile(name, "");
  using Names = std::vector<std::string>;
  const auto file = [this](const std::string& name) { return folder_.file(name); };
  EXPECT_EQ(inputsOf(file("a b.bag")), Names{file("a b.bag")}) << "a name with a space";
  EXPECT_EQ(inputsOf(file("a_1.bag") + "  " + file("a_0.bag")), (Names{file("a_1.bag"), file("a_0.bag")}));
  EXPECT_EQ(inputsOf(file("a_*.bag")), (Names{file("a_0.bag"), file("a_1.bag")}));
  EXPECT_EQ(inputsOf(file("none_*.bag")), Names{file("none_*.bag")}) << "so that an error names it";
  EXPECT_EQ(inputsOf(""), Names{""});
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
  options.end = 0.2;
  const auto middle = readAll(path, options);
  ASSERT_EQ(middle.size(), 2u);
  EXPECT_EQ(numberOf(middle[1]), 3);
  options.start = 0.0;
  options.resume = 0.15;
  const auto resumed = readAll(path, options);
  ASSERT_EQ(resumed.size(), 2u);
  EXPECT_EQ(resumed[0].frame, 0u);
  EXPECT_EQ(resumed[1].frame, 3u);
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
  options.start = options.end = 1.0;
  EXPECT_TRUE(mentions(errorOf(folder_.path(), options), "end"));
  for (const double resume : {1.0, 2.0, -1.0, std::nan("")}) {
    options.end = 2.0;
    options.resume = resume;
    EXPECT_TRUE(mentions(errorOf(folder_.path(), options), "resume")) << resume;
  }
  options = {};
  options.folder_rate = 0.0;
  EXPECT_TRUE(mentions(errorOf(folder_.path(), options), "rate"));
  options = {};
  options.start = 10.0;
  EXPECT_TRUE(readAll(folder_.path(), options).empty());
}

}  // namespace
}  // namespace laparoscope_servo
