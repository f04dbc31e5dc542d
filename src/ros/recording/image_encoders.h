// Encodes images in separate threads, in the form of image_transport's plugin `compressed`.
#pragma once

#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace laparoscope_servo {

// Encodes as a JPEG of 8 bit, colour or grey. Throws ImageError for an unusable image, e.g. a Bayer pattern.
sensor_msgs::CompressedImagePtr compressed(const sensor_msgs::Image& image, int jpeg_quality);

class ImageEncoders {
 public:
  using Done = std::function<void(const sensor_msgs::CompressedImagePtr&, const ros::Time&)>;

  // `most`: largest number of waiting images. `done`: called in one of the threads, with the time given to add().
  ImageEncoders(int threads, int most, int jpeg_quality, const Done& done);
  // Encodes waiting images first.
  ~ImageEncoders();
  ImageEncoders(const ImageEncoders&) = delete;
  ImageEncoders& operator=(const ImageEncoders&) = delete;

  // Never blocks. Returns false, and drops the image, if too many are waiting.
  bool add(const sensor_msgs::ImageConstPtr& image, const ros::Time& time);

  struct Counts {
    std::uint64_t dropped = 0;
    std::uint64_t refused = 0;
    std::string refusal;  // why the last image was refused
    double time = 0.0;    // s, duration of the last encoding
  };
  Counts counts() const;

 private:
  void run();

  std::size_t most_;
  int quality_;
  Done done_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::pair<sensor_msgs::ImageConstPtr, ros::Time>> waiting_;
  Counts counts_;
  bool ends_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace laparoscope_servo
