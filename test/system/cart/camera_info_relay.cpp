#include "camera_info_relay.h"

#include <memory>

namespace laparoscope_servo::test {

CameraInfoRelay::CameraInfoRelay(const std::string& from, const std::string& to) : spinner_(1, &queue_) {
  node_.setCallbackQueue(&queue_);
  publisher_ = node_.advertise<sensor_msgs::CameraInfo>(to, 2);
  subscriber_ = node_.subscribe(from, 2, &CameraInfoRelay::onInfo, this, ros::TransportHints().tcpNoDelay());
  spinner_.start();
}

CameraInfoRelay::~CameraInfoRelay() {
  spinner_.stop();
}

void CameraInfoRelay::begin(const Fault& fault) {
  const std::lock_guard<std::mutex> lock(mutex_);
  fault_ = fault;
}

void CameraInfoRelay::cut() {
  const std::lock_guard<std::mutex> lock(mutex_);
  cut_ = true;
}

void CameraInfoRelay::end() {
  const std::lock_guard<std::mutex> lock(mutex_);
  fault_ = nullptr;
  cut_ = false;
}

void CameraInfoRelay::onInfo(const sensor_msgs::CameraInfo& info) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!cut_) publisher_.publish(fault_ ? fault_(info) : info);
}

CameraInfoRelay::Fault withFocalLength(double factor) {
  return [factor](sensor_msgs::CameraInfo info) {
    for (const std::size_t k : {0U, 4U}) info.K[k] *= factor;
    for (const std::size_t k : {0U, 5U}) info.P[k] *= factor;
    return info;
  };
}

CameraInfoRelay::Fault withPrincipalPoint(double right, double down) {
  return [=](sensor_msgs::CameraInfo info) {
    info.K[2] += right;
    info.P[2] += right;
    info.K[5] += down;
    info.P[6] += down;
    return info;
  };
}

CameraInfoRelay::Fault onEverySecond(const CameraInfoRelay::Fault& fault) {
  const auto count = std::make_shared<int>(0);
  return [=](const sensor_msgs::CameraInfo& info) { return ++*count % 2 == 0 ? fault(info) : info; };
}

}  // namespace laparoscope_servo::test
