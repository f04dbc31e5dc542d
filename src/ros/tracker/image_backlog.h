// Which images are processed when several wait, because the camera or this machine has stalled.
//
// All of them while the tracker needs less than half of the images' period: four that wait are then done within four
// periods, and from one image to the next the region moves least. A slower tracker would fall behind for good, so it
// takes only images that have waited less than one period, and whoever asks processes the last one that was not taken
// when no newer one waits.
#pragma once

#include <ros/time.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace laparoscope_servo {

class ImageBacklog {
 public:
  // Images that may wait, the size of the subscriber's queue: a stall of 66 ms at 60 Hz.
  static constexpr std::uint32_t kQueue = 4;

  // Whether to process an image, by its stamp and by how long it has waited since it came, s of the clock of ROS.
  // Call it for each image, in the order in which they came.
  bool takes(const ros::Time& stamp, double waited);
  // Call it with the time that an image took, s.
  void took(double duration);

 private:
  static constexpr std::size_t kRemembered = 9;  // of which the median counts, so that a stall does not
  struct Recent {
    std::array<double, kRemembered> values{};
    std::size_t count = 0;
    void add(double value);
    double median() const;  // 0 before there is any
  };

  ros::Time last_;
  Recent periods_;    // s
  Recent durations_;  // s
};

}  // namespace laparoscope_servo
