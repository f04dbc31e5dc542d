// Images of a bag.
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CompressedImage.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "unit/ros/image_source_fixture.h"

namespace laparoscope_servo {
namespace {

using ImageSourceBagTest = ImageSourceTest;

TEST_F(ImageSourceBagTest, BagGivesMessagesWithTheirHeaders) {
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

TEST_F(ImageSourceBagTest, BagIsReadFromTheStartToTheEnd) {
  SourceOptions options;
  options.start = 0.1;
  options.end = 0.3;  // s of the recording's time, in which images are 0.1 s apart
  const auto images = readAll(writeBag("raw.bag", {"/scope/image_raw"}), options);
  ASSERT_EQ(images.size(), 2u);
  EXPECT_EQ(numberOf(images[0]), 1);
  EXPECT_EQ(images[1].frame, 2u);
}

TEST_F(ImageSourceBagTest, BagHasCameraInfoFromTheFirstImageOn) {
  const auto images = readAll(writeBag("raw.bag", {"/scope/image_raw"}));
  ASSERT_EQ(images.size(), 5u);
  ASSERT_TRUE(images[0].camera_info);
  EXPECT_EQ(images[0].camera_info->K[0], 100.0);
  ASSERT_TRUE(images[4].camera_info);
  EXPECT_EQ(images[4].camera_info->K[0], 103.0);  // the one before it
}

TEST_F(ImageSourceBagTest, BagHasCameraInfoOfBeforeTheStart) {
  SourceOptions options;
  options.start = 0.2;
  const auto images = readAll(writeBag("raw.bag", {"/scope/image_raw"}), options);
  ASSERT_EQ(images.size(), 3u);
  EXPECT_EQ(images[0].frame, 2u);
  EXPECT_EQ(numberOf(images[0]), 2);
  ASSERT_TRUE(images[0].camera_info);
  EXPECT_EQ(images[0].camera_info->K[0], 101.0);
}

TEST_F(ImageSourceBagTest, BagMayHaveCameraInfoUnderAnotherName) {
  const std::string path = writeBag("raw.bag", {"/left/image_raw"});
  const auto source = openImageSource(path, {});
  EXPECT_FALSE(source->next()->camera_info);
  ASSERT_EQ(source->notes().size(), 1u);
  EXPECT_TRUE(mentions(source->notes()[0], "no /left/camera_info, but /scope/camera_info")) << source->notes()[0];
  SourceOptions options;
  for (const char* name : {"/scope/camera_info", "scope/camera_info"}) {
    options.camera_info_topic = name;
    const auto images = readAll(path, options);
    ASSERT_TRUE(images.at(0).camera_info);
    EXPECT_EQ(images[0].camera_info->K[0], 100.0);
    EXPECT_TRUE(openImageSource(path, options)->notes().empty());
  }
  options.camera_info_topic = "/chatter";
  EXPECT_TRUE(mentions(errorOf(path, options), "std_msgs/String, expected sensor_msgs/CameraInfo"));
  options.camera_info_topic = "/none";
  EXPECT_TRUE(mentions(errorOf(path, options), "no topic '/none'"));
}

TEST_F(ImageSourceBagTest, BagMayHoldCompressedImages) {
  const auto images = readAll(writeBag("compressed.bag", {"/scope/image_raw/compressed"}, true));
  ASSERT_EQ(images.size(), 5u);
  EXPECT_FALSE(images[0].message);
  EXPECT_EQ(numberOf(images[3]), 3);
  EXPECT_EQ(images[3].header.stamp, ros::Time(99.3));
  ASSERT_TRUE(images[0].camera_info) << "beside the raw topic's name";
}

TEST_F(ImageSourceBagTest, BagNamesACompressedImageThatCannotBeDecoded) {
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

TEST_F(ImageSourceBagTest, BagWithSeveralImageTopicsAsksWhichOne) {
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

TEST_F(ImageSourceBagTest, BagWithoutTheTopicSaysWhichItHas) {
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

TEST_F(ImageSourceBagTest, TruncatedBagsAreErrorsThatNameTheRepair) {
  const std::string path = writeBag("whole.bag", {"/scope/image_raw"});
  const auto size = std::filesystem::file_size(path);
  for (const double share : {0.001, 0.1, 0.5, 0.9, 0.999}) {
    const std::string part = folder_.file("part.bag");
    std::filesystem::copy_file(path, part, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(part, static_cast<std::uintmax_t>(share * static_cast<double>(size)));
    const std::string error = errorOf(part);
    EXPECT_TRUE(mentions(error, "part.bag")) << share << ": " << error;
    EXPECT_TRUE(mentions(error, "breaks off")) << share << ": " << error;
    EXPECT_TRUE(mentions(error, "reindex")) << share << ": " << error;
  }
}

TEST_F(ImageSourceBagTest, WhatNoRepairMakesABagOfIsSaidToBeNone) {
  std::ofstream(folder_.file("empty.bag")).close();
  EXPECT_TRUE(mentions(errorOf(folder_.file("empty.bag")), "empty.bag' is empty"));
  std::ofstream(folder_.file("text.bag")) << "This is a text of some length.";
  std::ofstream(folder_.file("short.bag")) << "#RO";
  std::ofstream(folder_.file("old.bag")) << "#ROSBAG V1.2\nof long ago";
  for (const char* name : {"text.bag", "short.bag", "old.bag"}) {
    const std::string error = errorOf(folder_.file(name));
    EXPECT_TRUE(mentions(error, "is no bag of format 2.0")) << error;
    EXPECT_FALSE(mentions(error, "reindex")) << error;
  }
}

TEST_F(ImageSourceBagTest, BagWithDamagedContentIsAnErrorAndNoCrash) {
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

}  // namespace
}  // namespace laparoscope_servo
