// Folders, videos and bags whose images tell their numbers.
#pragma once

#include <cv_bridge/cv_bridge.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <std_msgs/String.h>

#include <fstream>
#include <string>
#include <vector>

#include "ros/playback/image_source.h"
#include "ros/tracker/image_conversion.h"
#include "support/error_text.h"
#include "support/stamped_header.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {

// A plain image whose grey level tells its number.
inline cv::Mat numbered(int k) {
  return cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(10 * (k + 1)));
}

inline int numberOf(const SourceImage& image) {
  const cv::Mat pixels = image.message ? trackerImage(*image.message) : trackerImage(image.decoded);
  return cvRound(cv::mean(pixels)[0] / 10.0) - 1;
}

inline std::vector<SourceImage> readAll(const std::string& path, const SourceOptions& options = {}) {
  const auto source = openImageSource(path, options);
  std::vector<SourceImage> images;
  while (auto image = source->next()) images.push_back(*image);
  EXPECT_FALSE(source->next()) << "the end is the end";
  return images;
}

inline std::string errorOf(const std::string& path, const SourceOptions& options = {}) {
  return test_support::errorText<SourceError>([&] { readAll(path, options); });
}

inline bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

using test_support::at;

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

}  // namespace laparoscope_servo
