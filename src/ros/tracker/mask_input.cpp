#include "ros/tracker/mask_input.h"

#include <sensor_msgs/image_encodings.h>

#include <memory>
#include <sstream>

#include "ros/tracker/feed_owner.h"
#include "ros/tracker/image_conversion.h"

namespace laparoscope_servo {

namespace {

// Shares the message's data, which OpenCV has no way to call constant; nobody writes into it.
cv::Mat maskOf(const sensor_msgs::Image& message) {
  namespace encodings = sensor_msgs::image_encodings;
  std::ostringstream text;
  if (message.encoding != encodings::MONO8 && message.encoding != encodings::TYPE_8UC1) {
    text << "encoding '" << message.encoding.substr(0, 20) << "', expected mono8";
  } else if (message.width == 0 || message.height == 0 || message.width > 65535 || message.height > 65535) {
    text << message.width << "x" << message.height << " px, expected sides of 1 to 65535";
  } else if (message.step < message.width || message.data.size() < std::size_t{message.step} * message.height) {
    text << message.data.size() << " bytes in lines of " << message.step << ", expected at least " << message.width
         << " in each of " << message.height << " lines";
  } else {
    return {static_cast<int>(message.height), static_cast<int>(message.width), CV_8UC1,
            const_cast<std::uint8_t*>(message.data.data()), message.step};
  }
  throw ImageError(text.str());
}

}  // namespace

MaskInput::MaskInput(const MaskInputConfig& config, const tracking::InputConfig& input)
    : max_ahead_(input.max_ahead),
      owner_(config.owner, "masks", "external_mask/owner"),
      gate_(input),
      masks_(config.max_age) {}

void MaskInput::take(const sensor_msgs::ImageConstPtr& message, const Arrival& arrival) {
  judgeSender(arrival);
  const cv::Mat mask = maskOf(*message);
  if (!image_size_.empty() && mask.size() != image_size_) {
    std::ostringstream text;
    text << "size " << mask.cols << "x" << mask.rows << " px, expected that of the images, " << image_size_.width << "x"
         << image_size_.height << " px";
    throw ImageError(text.str(), Refusal::kSize);
  }
  checkStamp(message->header.stamp, arrival.clock, max_ahead_);
  if (gate_.judge(message->header.stamp, mask.size(), mask.channels()).step_back > 0.0) masks_.clear();
  // Kept by a pointer that is its own holder: the message is of boost, the core's holder of the standard library.
  masks_.add(mask, message->header.stamp.toSec(), std::make_shared<const sensor_msgs::ImageConstPtr>(message));
}

// A node that starts again has a new connection: it counts once the old one has been silent for as long as that of
// images may be.
void MaskInput::judgeSender(const Arrival& arrival) {
  if (!(arrival.now - owner_at_ <= FeedOwner::kSilence)) owner_.release();
  switch (owner_.judge(arrival.sender, arrival.connection, arrival.now)) {
    case InputOwner::Verdict::kOwner:
      owner_at_ = arrival.now;
      return;
    case InputOwner::Verdict::kNewConnection:
      throw ImageError(
          "a second connection of " + shownName(arrival.sender) + ", expected only the first until it is silent",
          Refusal::kSender);
    case InputOwner::Verdict::kStranger:
      throw ImageError(owner_.complaint(arrival.now), Refusal::kSender);
  }
}

tracking::ExternalMask MaskInput::at(const ros::Time& stamp, const cv::Size& size) {
  image_size_ = size;
  return masks_.at(stamp.toSec(), size);
}

void MaskInput::clockJumpedBack() {
  gate_.clockJumpedBack();
  masks_.clear();
}

}  // namespace laparoscope_servo
