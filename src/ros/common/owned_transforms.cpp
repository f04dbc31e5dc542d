#include "ros/common/owned_transforms.h"

#include "ros/common/clocks.h"

namespace laparoscope_servo {

namespace {

constexpr std::uint32_t kQueue = 100;     // messages, as in tf2_ros
constexpr double kClockCorrection = 0.1;  // s: a smaller correction of the machine's clock is no jump

using Event = ros::MessageEvent<tf2_msgs::TFMessage const>;

}  // namespace

OwnedTransforms::OwnedTransforms(const TransformGateConfig& config) : gate_(config), spinner_(1, &queue_) {
  node_.setCallbackQueue(&queue_);
  const ros::TransportHints at_once = ros::TransportHints().tcpNoDelay();
  moving_subscriber_ = node_.subscribe<tf2_msgs::TFMessage>(
      "/tf", kQueue, boost::function<void(const Event&)>([this](const Event& event) { onTransforms(event, false); }),
      ros::VoidConstPtr(), at_once);
  static_subscriber_ = node_.subscribe<tf2_msgs::TFMessage>(
      "/tf_static", kQueue,
      boost::function<void(const Event&)>([this](const Event& event) { onTransforms(event, true); }),
      ros::VoidConstPtr(), at_once);
  spinner_.start();
}

void OwnedTransforms::onTransforms(const Event& event, bool is_static) {
  const auto message = event.getConstMessage();
  const ros::Time now = ros::Time::now();
  const std::lock_guard<std::mutex> lock(mutex_);
  if ((last_now_ - now).toSec() > kClockCorrection) gate_.clear();
  last_now_ = now;
  gate_.take(message->transforms, event.getPublisherName(), event.getConnectionHeaderPtr(), is_static, now,
             steadyNow());
}

OwnedTransforms::Word OwnedTransforms::step(bool engaged, double steady_now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  gate_.step(engaged, ros::Time::now(), steady_now);
  return {gate_.problem(steady_now), gate_.complaint(steady_now), gate_.takeChangedFrame(), gate_.strange(),
          gate_.refused()};
}

void OwnedTransforms::clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  gate_.clear();
}

void OwnedTransforms::use(const std::string& frame) {
  const std::lock_guard<std::mutex> lock(mutex_);
  gate_.use(frame);
}

std::shared_ptr<const tf2::BufferCore> OwnedTransforms::buffer() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return gate_.buffer();
}

}  // namespace laparoscope_servo
