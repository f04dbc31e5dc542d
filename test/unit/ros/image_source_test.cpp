#include "laparoscope_servo/ros/image_source.h"

#include <cv_bridge/cv_bridge.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CompressedImage.h>
#include <std_msgs/String.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "laparoscope_servo/ros/image_conversion.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo::skin {
namespace {

// A plain image whose grey level tells its number.
cv::Mat numbered(int k) {
  return cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(10 * (k + 1)));
}

int numberOf(const SourceImage& image) {
  const cv::Mat pixels = image.message ? trackerImage(*image.message) : trackerImage(image.decoded);
  return cvRound(cv::mean(pixels)[0] / 10.0) - 1;
}

std::vector<SourceImage> readAll(const std::string& path, const SourceOptions& options = {}) {
  const auto source = openImageSource(path, options);
  std::vector<SourceImage> images;
  while (auto image = source->next()) images.push_back(*image);
  EXPECT_FALSE(source->next()) << "the end is the end";
  return images;
}

std::string errorOf(const std::string& path, const SourceOptions& options = {}) {
  try {
    readAll(path, options);
  } catch (const SourceError& error) {
    return error.what();
  }
  return "";
}

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std_msgs::Header at(double stamp) {
  std_msgs::Header header;
  header.frame_id = "optical";
  header.stamp = ros::Time(stamp);
  return header;
}

class ImageSourceTest : public testing::Test {
 protected:
  // Written at times 100, 100.1, …; stamps are a second earlier.
  std::string writeBag(const std::string& name, const std::vector<std::string>& image_topics, bool compressed = false) {
    const std::string path = folder_.file(name);
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    for (int k = 0; k < 5; ++k) {
      const double time = 100.0 + 0.1 * k;
      for (const std::string& topic : image_topics) {
        cv_bridge::CvImage image(at(time - 1.0), "bgr8", numbered(k));
        if (compressed) {
          bag.write(topic, ros::Time(time), *image.toCompressedImageMsg(cv_bridge::PNG));
        } else {
          bag.write(topic, ros::Time(time), *image.toImageMsg());
        }
      }
      sensor_msgs::CameraInfo info;
      info.header = at(time - 1.0);
      info.K[0] = 100.0 + k;
      bag.write("/scope/camera_info", ros::Time(time + 0.01), info);
      bag.write("/chatter", ros::Time(time), std_msgs::String());
    }
    return path;
  }

  std::string writeFile(const std::string& name, const std::string& content) {
    std::ofstream(folder_.file(name), std::ios::binary) << content;
    return folder_.file(name);
  }

  test_support::TemporaryFolder folder_;
};

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

TEST_F(ImageSourceTest, BagGivesMessagesWithTheirHeaders) {
  const auto images = readAll(writeBag("raw.bag", {"/scope/image_raw"}));
  ASSERT_EQ(images.size(), 5u);
  for (int k = 0; k < 5; ++k) {
    ASSERT_TRUE(images[k].message);
    EXPECT_EQ(numberOf(images[k]), k);
    EXPECT_EQ(images[k].header.frame_id, "optical");
    EXPECT_EQ(images[k].header.stamp, ros::Time(99.0 + 0.1 * k));
    EXPECT_EQ(images[k].record_time, ros::Time(100.0 + 0.1 * k));
  }
  EXPECT_NEAR(openImageSource(folder_.file("raw.bag"), {})->rate(), 10.0, 1e-6);
}

TEST_F(ImageSourceTest, BagHasCameraInfoFromTheFirstImageOn) {
  const auto images = readAll(writeBag("raw.bag", {"/scope/image_raw"}));
  ASSERT_EQ(images.size(), 5u);
  ASSERT_TRUE(images[0].camera_info);
  EXPECT_EQ(images[0].camera_info->K[0], 100.0);
  ASSERT_TRUE(images[4].camera_info);
  EXPECT_EQ(images[4].camera_info->K[0], 103.0);  // the one before it
}

TEST_F(ImageSourceTest, BagHasCameraInfoOfBeforeTheStart) {
  SourceOptions options;
  options.start = 0.2;
  const auto images = readAll(writeBag("raw.bag", {"/scope/image_raw"}), options);
  ASSERT_EQ(images.size(), 3u);
  EXPECT_EQ(images[0].frame, 2u);
  EXPECT_EQ(numberOf(images[0]), 2);
  ASSERT_TRUE(images[0].camera_info);
  EXPECT_EQ(images[0].camera_info->K[0], 101.0);
}

TEST_F(ImageSourceTest, BagMayHoldCompressedImages) {
  const auto images = readAll(writeBag("compressed.bag", {"/scope/image_raw/compressed"}, true));
  ASSERT_EQ(images.size(), 5u);
  EXPECT_FALSE(images[0].message);
  EXPECT_EQ(numberOf(images[3]), 3);
  EXPECT_EQ(images[3].header.stamp, ros::Time(99.3));
  ASSERT_TRUE(images[0].camera_info) << "beside the raw topic's name";
}

TEST_F(ImageSourceTest, BagNamesACompressedImageThatCannotBeDecoded) {
  rosbag::Bag bag(folder_.file("odd.bag"), rosbag::bagmode::Write);
  sensor_msgs::CompressedImage image;
  image.header = at(1.0);
  image.format = "jpeg";
  bag.write("/image/compressed", ros::Time(1.0), image);
  image.data = {1, 2, 3};
  bag.write("/image/compressed", ros::Time(2.0), image);
  image =
      *cv_bridge::CvImage(at(3.0), "mono8", cv::Mat(4, 4, CV_8UC1, cv::Scalar(7))).toCompressedImageMsg(cv_bridge::PNG);
  image.format = "bayer_rggb8; png compressed ";
  bag.write("/image/compressed", ros::Time(3.0), image);
  bag.close();
  const auto images = readAll(folder_.file("odd.bag"));
  ASSERT_EQ(images.size(), 3u);
  EXPECT_TRUE(mentions(images[0].error, "jpeg")) << images[0].error;
  EXPECT_TRUE(mentions(images[1].error, "3 bytes")) << images[1].error;
  EXPECT_TRUE(mentions(images[2].error, "image_proc")) << images[2].error;
}

TEST_F(ImageSourceTest, BagWithSeveralImageTopicsAsksWhichOne) {
  const std::string path = writeBag("several.bag", {"/scope/image_raw", "/room/image"});
  const std::string error = errorOf(path);
  EXPECT_TRUE(mentions(error, "/scope/image_raw (sensor_msgs/Image)")) << error;
  EXPECT_TRUE(mentions(error, "/room/image")) << error;
  EXPECT_TRUE(mentions(error, "--image-topic")) << error;
  SourceOptions options;
  options.image_topic = "/room/image";
  const auto images = readAll(path, options);
  EXPECT_EQ(images.size(), 5u);
  EXPECT_FALSE(images[0].camera_info) << "that of another camera";
  options.image_topic = "scope/image_raw";
  EXPECT_EQ(readAll(path, options).size(), 5u);
}

TEST_F(ImageSourceTest, BagWithoutTheTopicSaysWhichItHas) {
  const std::string none = errorOf(writeBag("none.bag", {}));
  EXPECT_TRUE(mentions(none, "no topic with images")) << none;
  EXPECT_TRUE(mentions(none, "/chatter (std_msgs/String)")) << none;
  SourceOptions options;
  options.image_topic = "/other";
  const std::string other = errorOf(folder_.file("none.bag"), options);
  EXPECT_TRUE(mentions(other, "'/other'")) << other;
  EXPECT_TRUE(mentions(other, "/scope/camera_info")) << other;
  options.image_topic = "/chatter";
  EXPECT_TRUE(mentions(errorOf(folder_.file("none.bag"), options), "std_msgs/String"));
  rosbag::Bag(folder_.file("void.bag"), rosbag::bagmode::Write).close();
  EXPECT_TRUE(mentions(errorOf(folder_.file("void.bag")), "the bag is empty"));
}

TEST_F(ImageSourceTest, TruncatedBagsAreErrorsThatNameTheRepair) {
  const std::string path = writeBag("whole.bag", {"/scope/image_raw"});
  const auto size = std::filesystem::file_size(path);
  for (const double share : {0.001, 0.1, 0.5, 0.9, 0.999}) {
    const std::string part = folder_.file("part.bag");
    std::filesystem::copy_file(path, part, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(part, static_cast<std::uintmax_t>(share * static_cast<double>(size)));
    const std::string error = errorOf(part);
    EXPECT_TRUE(mentions(error, "part.bag")) << share << ": " << error;
    EXPECT_TRUE(mentions(error, "reindex")) << share << ": " << error;
  }
}

TEST_F(ImageSourceTest, BagWithDamagedContentIsAnErrorAndNoCrash) {
  const std::string path = writeBag("damaged.bag", {"/scope/image_raw"});
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(20000);
  for (int k = 0; k < 8000; ++k) file.put(static_cast<char>(0xFF));
  file.close();
  try {
    readAll(path);  // what of it can be read may be read
  } catch (const SourceError& error) {
    EXPECT_TRUE(mentions(error.what(), "damaged")) << error.what();
  }
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
