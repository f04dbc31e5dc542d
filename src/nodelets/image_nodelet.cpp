#include "nodelets/image_nodelet.h"

#include <diagnostic_msgs/DiagnosticStatus.h>

#include <exception>
#include <utility>

#include "ros/common/clocks.h"
#include "ros/common/network_exposure.h"
#include "ros/common/parameters.h"
#include "ros/tracker/image_gate.h"
#include "ros/tracker/tracker_parameters.h"

namespace laparoscope_servo::nodelets {

namespace {

constexpr double kTurnTimeout = 10.0;  // s: an image takes less, also on a busy machine

}  // namespace

void ImageNodelet::onInit() {
  // Exceptions must not leave onInit(); they would end the nodelet manager, with the camera driver in it.
  try {
    diagnostics_ = std::make_unique<diagnostic_updater::Updater>(getNodeHandle(), getPrivateNodeHandle(), getName());
    diagnostics_->setHardwareID("none");
    diagnostics_->add("tracking", this, &ImageNodelet::fillDiagnostics);
    // Uses force_update() and the wall clock: Updater::update() stops publishing when the time of a looped bag jumps
    // back.
    diagnostics_timer_ = getNodeHandle().createWallTimer(
        ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_->force_update(); });
    turn_.take(getName(), kTurnTimeout);
    const std::vector<std::string> errors = configure();
    if (!errors.empty()) return standAside(errorReport(errors));
    warnOfExposure();
    start();
    started_ = true;
  } catch (const std::exception& error) {
    standAside(error.what());
  }
}

void ImageNodelet::standAside(const std::string& why) {
  why_aside_ = why;
  notStarted(why);
  NODELET_ERROR("the tracker does not start: %s", why.c_str());
}

void ImageNodelet::subscribe() {
  camera_info_subscriber_ = getNodeHandle().subscribe("camera_info", 2, &ImageNodelet::cameraInfoCallback, this);
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  const image_transport::TransportHints hints("raw", no_delay, getPrivateNodeHandle());
  // subscribes to the topic itself, since only then the sender of an image is known
  if (hints.getTransport() == "raw") {
    image_subscriber_ =
        getNodeHandle().subscribe("image", ImageBacklog::kQueue, &ImageNodelet::rawImageCallback, this, no_delay);
    return;
  }
  transport_ = std::make_unique<image_transport::ImageTransport>(getNodeHandle());
  // A queue of one, since it is not known how long an image has waited in it.
  transport_subscriber_ = transport_->subscribe("image", 1, &ImageNodelet::imageCallback, this, hints);
}

CameraMotion ImageNodelet::followRobot(const RobotMotionConfig& config) {
  robot_ = std::make_unique<RobotFollower>(config, getNodeHandle());
  return [this](const std::string& frame, const ros::Time& from, const ros::Time& to, std::string& why) {
    const auto motion = robot_->motion(frame, from, to, why);
    if (!robot_->complaint().empty()) NODELET_WARN_THROTTLE(kThrottle, "%s", robot_->complaint().c_str());
    return motion;
  };
}

void ImageNodelet::cameraInfoCallback(const ros::MessageEvent<const sensor_msgs::CameraInfo>& event) {
  if (!camera_info_owner_.counts(event.getPublisherName(), steadyNow())) return;
  takeCameraInfo(*event.getConstMessage());
}

void ImageNodelet::rawImageCallback(const ros::MessageEvent<const sensor_msgs::Image>& event) {
  const double now = steadyNow();
  if (!image_owner_.counts(event.getPublisherName(), now)) {
    return refuse("several nodes publish " + image_subscriber_.getTopic() + ": " + image_owner_.complaint(now),
                  Refusal::kSender);
  }
  const sensor_msgs::ImageConstPtr message = event.getConstMessage();
  // The time of a recording goes at the player's pace, and tells nothing of how long an image has waited.
  const double waited = ros::Time::isSimTime() ? 0.0 : (ros::Time::now() - event.getReceiptTime()).toSec();
  left_.reset();
  if (!backlog_.takes(message->header.stamp, waited)) return leaveForLater(message);
  imageCallback(message);
  backlog_.took(steadyNow() - now);
}

// The timer's turn comes behind the images that wait already: the newest of a burst is processed, whatever came before.
void ImageNodelet::leaveForLater(const sensor_msgs::ImageConstPtr& message) {
  constexpr double kSoon = 1e-4;  // s
  left_ = message;
  left_timer_ = getNodeHandle().createWallTimer(
      ros::WallDuration(kSoon),
      [this](const ros::WallTimerEvent&) {
        if (const sensor_msgs::ImageConstPtr newest = std::exchange(left_, nullptr)) imageCallback(newest);
      },
      true);
}

void ImageNodelet::imageCallback(const sensor_msgs::ImageConstPtr& message) {
  // A bad image must not end the process, which the camera driver may share. (cv::Exception is a std::exception.)
  try {
    processOrTell(message);
  } catch (const ImageError& error) {
    refuse(error.what(), error.cause());
  } catch (const std::exception& error) {
    refuse(error.what());
  }
}

// Other images that are refused are single ones, as a rule, and no reason to stop.
void ImageNodelet::processOrTell(const sensor_msgs::ImageConstPtr& message) {
  try {
    process(message);
  } catch (const ImageError& error) {
    if (error.cause() == Refusal::kSize) notSeen(*message, error.what());
    throw;
  }
}

void ImageNodelet::checkTime(const ros::Time& stamp, double max_ahead) {
  // A bag that begins again also sets the clock back.
  constexpr double kJump = 0.05;  // s: larger than corrections of the machine's clock
  const ros::Time now = ros::Time::now();
  if ((last_now_ - now).toSec() > kJump) clockJumpedBack();
  last_now_ = now;
  checkStamp(stamp, clockOfStamps(), max_ahead);
}

ros::Time ImageNodelet::clockOfStamps() {
  return ros::Time::isSimTime() ? ros::Time() : ros::Time::now();
}

void ImageNodelet::refuse(const std::string& error, Refusal cause) {
  refused(error, cause);
  NODELET_ERROR_THROTTLE(kThrottle, "image refused: %s", error.c_str());
}

void ImageNodelet::fillDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (!why_aside_.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, "not started: " + why_aside_);
  } else if (started_) {
    const double now = steadyNow();
    const bool raw = static_cast<bool>(image_subscriber_);
    diagnose(
        now,
        {raw ? image_subscriber_.getNumPublishers() : transport_subscriber_.getNumPublishers(),
         camera_info_subscriber_.getNumPublishers(), image_owner_.complaint(now), camera_info_owner_.complaint(now)},
        status);
  }
}

}  // namespace laparoscope_servo::nodelets
