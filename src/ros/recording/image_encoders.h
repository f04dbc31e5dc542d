// Encodes images in threads of its own, as image_transport's plugin `compressed` would name and publish them.
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

// A JPEG of 8 bit, colour or grey. Throws ImageError for an image that cannot be used, e.g. a Bayer pattern.
sensor_msgs::CompressedImagePtr compressed(const sensor_msgs::Image& image, int jpeg_quality);

class ImageEncoders {
 public:
  using Done = std::function<void(const sensor_msgs::CompressedImagePtr&, const ros::Time&)>;

  // `most`: images that may wait. `done`: called in one of the threads, with the time given to add().
  ImageEncoders(int threads, int most, int jpeg_quality, const Done& done);
  // Images that wait are encoded first.
  ~ImageEncoders();
  ImageEncoders(const ImageEncoders&) = delete;
  ImageEncoders& operator=(const ImageEncoders&) = delete;

  // Never waits: false when too many wait already, and the image is dropped.
  bool add(const sensor_msgs::ImageConstPtr& image, const ros::Time& time);

  struct Counts {
    std::uint64_t dropped = 0;
    std::uint64_t refused = 0;
    std::string refusal;  // why the last one was
    double time = 0.0;    // s, of the last encoding
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
