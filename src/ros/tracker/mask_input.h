// Masks of what covers the tissue, from the node that knows: which of them are accepted, and which one is used for an
// image. The owner, its connection, encoding, size and stamps are checked as those of other inputs.
#pragma once

#include <ros/time.h>
#include <sensor_msgs/Image.h>

#include <limits>
#include <opencv2/core.hpp>
#include <string>

#include "laparoscope_servo/tracking/external_masks.h"
#include "laparoscope_servo/tracking/input_config.h"
#include "ros/common/input_owner.h"
#include "ros/tracker/image_gate.h"

namespace laparoscope_servo {

struct MaskInputConfig {
  bool enabled = false;
  std::string owner = "instrument";  // the node whose masks are accepted; empty: the one that publishes first
  double max_age = 0.1;              // s, see tracking::ExternalMasks
};

// Not thread-safe.
class MaskInput {
 public:
  // Who has sent a message, and when it came.
  struct Arrival {
    std::string sender;  // name of the node
    InputOwner::Connection connection;
    double now = 0.0;  // s, steady
    ros::Time clock;   // of the images' stamps; zero: not known
  };

  // `config.owner` resolved. `input`: limits of stamps, those of the images.
  MaskInput(const MaskInputConfig& config, const tracking::InputConfig& input);

  // Keeps the message: nothing is copied. Throws ImageError, with the value and what was expected, for one that is not
  // accepted.
  void take(const sensor_msgs::ImageConstPtr& message, const Arrival& arrival);

  // For the image at `stamp`, of `size`. Valid until the next call of a member function.
  tracking::ExternalMask at(const ros::Time& stamp, const cv::Size& size);

  // Call if the clock of the stamps has jumped back.
  void clockJumpedBack();

 private:
  void judgeSender(const Arrival& arrival);

  double max_ahead_;
  InputOwner owner_;
  double owner_at_ = -std::numeric_limits<double>::infinity();  // s, steady: the owner's last message
  ImageGate gate_;
  cv::Size image_size_;  // of the last image; empty: none has come
  tracking::ExternalMasks masks_;
};

}  // namespace laparoscope_servo
