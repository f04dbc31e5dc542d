#include "ros/playback/video_writer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "ros/playback/image_source.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

const cv::Size kSize(65, 49);  // odd

cv::Mat picture(int k) {
  return cv::Mat(kSize, CV_8UC3, cv::Scalar(10.0 * k, 100, 150));
}

TEST(VideoWriter, WhatItWritesIsReadAgain) {
  const test_support::TemporaryFolder folder;
  for (const char* name : {"a.mp4", "a.AVI", "a.mkv", "a.mov"}) {
    const std::string path = folder.file("elsewhere");
    VideoWriter writer(name, path, kSize, 12.5);
    for (int k = 0; k < 20; ++k) writer.write(picture(k));
    writer.close();
    const auto source = openImageSource(path, {});
    EXPECT_NEAR(source->rate(), 12.5, 1e-6) << name;
    for (int k = 0; k < 20; ++k) {
      const auto image = source->next();
      ASSERT_TRUE(image) << name << k;
      ASSERT_EQ(image->error, "") << name;
      ASSERT_EQ(image->decoded.size(), kSize);
      EXPECT_NEAR(image->header.stamp.toSec(), 0.08 * k, 1e-9);
      EXPECT_LT(cv::norm(image->decoded, picture(k), cv::NORM_L1) / (3.0 * kSize.area()), 6.0) << name << k;
    }
    EXPECT_FALSE(source->next()) << name;
  }
}

TEST(VideoWriter, KnowsItsEndings) {
  EXPECT_TRUE(VideoWriter::knows("a.b/c.Mp4"));
  for (const char* name : {"a.txt", "mp4", ".mp4/a", "a.mp4.partial", ""})
    EXPECT_FALSE(VideoWriter::knows(name)) << name;
}

TEST(VideoWriter, AFullDiskIsAnError) {
  for (const char* name : {"a.mp4", "a.avi"}) {
    const auto fill = [&] {
      VideoWriter writer(name, "/dev/full", kSize, 25.0);
      for (int k = 0; k < 50; ++k) writer.write(picture(k));
      writer.close();
    };
    try {
      fill();
      FAIL() << "expected an error of " << name;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo
