// Images from a file, one after the other: a bag (sensor_msgs/Image or sensor_msgs/CompressedImage), a video, or a
// folder of images in the order of their names, with numbers in them as numbers: frame2 before frame10. Pixels are as a
// player shows them, turned as the file says; pixels that are not square stay as they are stored.
#pragma once

#include <ros/time.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Header.h>

#include <cstddef>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace laparoscope_servo {

// The input cannot be opened, or read on; what() names it and says what was expected.
class SourceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct SourceOptions {
  std::string image_topic;        // of a bag; may be empty when it has only one with images
  std::string camera_info_topic;  // of a bag; empty: camera_info beside the image's topic
  double start = 0.0;             // s after the beginning of the input; images before are skipped
  double folder_rate = 25.0;      // Hz: the stamps of a folder's images, and of a video that does not tell its rate
};

struct SourceImage {
  std::size_t frame = 0;    // 0 is the first image of the input, also when the start is later
  std_msgs::Header header;  // of a bag's message, but see notes(); for a video the stamp is the time of presentation
                            // from the first picture on, for a folder frame / rate
  ros::Time record_time;    // of a bag's message; for others the stamp
  sensor_msgs::ImageConstPtr message;  // an image of a bag that is not compressed, otherwise
  cv::Mat decoded;                     // as OpenCV decodes it
  sensor_msgs::CameraInfoConstPtr
      camera_info;       // a new one, for this image and those that follow; null if none has come
  std::string error;     // this image cannot be decoded: why; message and decoded are empty then
  std::size_t lost = 1;  // images that the error is about, this one and those behind it
};

class ImageSource {
 public:
  virtual ~ImageSource() = default;
  // Empty at the end. Throws SourceError when the input is damaged.
  virtual std::optional<SourceImage> next() = 0;
  // Number of images, also those before the start; 0 when it is not known.
  virtual std::size_t size() const = 0;
  // Hz, for a video made of the images.
  virtual double rate() const = 0;
  // Whether the stamps are those of a recording, or counted from 0.
  virtual bool hasRecordedStamps() const = 0;
  // What a user should know about the input as far as it was read, and would not notice.
  virtual std::vector<std::string> notes() const { return {}; }
};

// Throws SourceError when `path` does not exist, or is none of the above.
std::unique_ptr<ImageSource> openImageSource(const std::string& path, const SourceOptions& options);
// The same; several are allowed of bags, the parts of one recording.
std::unique_ptr<ImageSource> openImageSource(const std::vector<std::string>& paths, const SourceOptions& options);

// One text that names inputs: a file or folder as it is; otherwise several, with spaces between, and with * and ? as a
// shell has them.
std::vector<std::string> inputsOf(const std::string& text);

}  // namespace laparoscope_servo
