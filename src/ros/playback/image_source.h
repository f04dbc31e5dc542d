// Reads images from a file, one after the other: a bag (sensor_msgs/Image or sensor_msgs/CompressedImage), a video, or
// a folder of images in the order of their names, with numbers in them as numbers: frame2 before frame10. Pixels are as
// a player shows them, rotated according to the file; pixels that are not square are not resampled.
#pragma once

#include <ros/time.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Header.h>

#include <cstddef>
#include <limits>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace laparoscope_servo {

// The input cannot be opened or read further; what() has its name and what was expected.
class SourceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct SourceOptions {
  std::string image_topic;        // of a bag; may be empty if it has only one topic with images
  std::string camera_info_topic;  // of a bag; empty: camera_info beside the image's topic
  double start = 0.0;             // s after the beginning of the input; images before are skipped
  double end = std::numeric_limits<double>::infinity();  // s after the beginning: the image then is the first left out
  double resume = 0.0;        // s after the beginning; behind the first image, those before are skipped
  double folder_rate = 25.0;  // Hz: rate for a folder of images, and for a video without a rate
  cv::Rect crop;              // px: of a video or a folder, the part of each image that is used; empty: all of it
};

struct SourceImage {
  std::size_t frame = 0;  // 0 is the first image of the input, also when the start is later
  // of a bag's message, but see notes(); for a video the stamp is the presentation time since the first picture, for a
  // folder frame / rate
  std_msgs::Header header;
  ros::Time record_time;                        // record time of a bag's message; otherwise the stamp
  sensor_msgs::ImageConstPtr message;           // image of a bag that is not compressed; otherwise null
  cv::Mat decoded;                              // all other images, decoded by OpenCV; otherwise empty
  sensor_msgs::CameraInfoConstPtr camera_info;  // new camera_info, for this image and later ones; null if there is none
  std::string error;                            // why this image cannot be decoded; message and decoded are then empty
  std::size_t lost = 1;                         // number of images that the error concerns: this one and later ones
};

class ImageSource {
 public:
  virtual ~ImageSource() = default;
  // Empty at the end. Throws SourceError when the input is damaged.
  virtual std::optional<SourceImage> next() = 0;
  // Number of images, including those before the start; 0 if not known.
  virtual std::size_t size() const = 0;
  // Frame rate [Hz], for a video made from the images.
  virtual double rate() const = 0;
  // Whether the stamps are those of a recording, or counted from 0.
  virtual bool hasRecordedStamps() const = 0;
  // Notes for the user about the input read so far.
  virtual std::vector<std::string> notes() const { return {}; }
};

// Throws SourceError if `path` does not exist or is none of the above.
std::unique_ptr<ImageSource> openImageSource(const std::string& path, const SourceOptions& options);
// Several paths are allowed for bags: the parts of one recording.
std::unique_ptr<ImageSource> openImageSource(const std::vector<std::string>& paths, const SourceOptions& options);

// Splits a text into inputs: an existing file or folder; otherwise several names, separated by spaces, with * and ? as
// in a shell.
std::vector<std::string> inputsOf(const std::string& text);

}  // namespace laparoscope_servo
