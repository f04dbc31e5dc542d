#include "ros/aesop/calibration_services.h"

#include <ros/console.h>

#include <algorithm>

#include "laparoscope_servo/CalibrationState.h"
#include "ros/common/clocks.h"
#include "ros/common/eigen_messages.h"

namespace laparoscope_servo {

namespace {

using Stage = CalibrationStage;

constexpr double kPeriod = 0.5;     // s, between two publications while poses are collected
constexpr double kWordPause = 2.0;  // s, between two lines of the log

std::string stageName(Stage stage) {
  switch (stage) {
    case Stage::kIdle:
      return CalibrationState::IDLE;
    case Stage::kCollecting:
    case Stage::kStopping:
      return CalibrationState::COLLECTING;
    case Stage::kDone:
      return CalibrationState::DONE;
    case Stage::kFailed:
      return CalibrationState::FAILED;
  }
  return "";
}

CalibrationState toMessage(const InsertionPointCalibration& calibration, const std::string& frame) {
  const servo::InsertionPointFit& fit = calibration.fit();
  CalibrationState message;
  message.header.stamp = ros::Time::now();
  message.header.frame_id = frame;
  message.state = stageName(calibration.stage());
  if (calibration.method()) message.method = name(*calibration.method());
  message.message = calibration.message();
  message.poses = static_cast<std::uint32_t>(fit.poses);
  message.cone = fit.cone;
  message.known = fit.known ? 1 : 0;
  message.point = pointMessage(fit.point);
  std::copy(fit.covariance.data(), fit.covariance.data() + 9, message.covariance.begin());
  message.stddev = fit.stddev;
  message.residual = fit.residual;
  message.largest_residual = fit.largest_residual;
  return message;
}

}  // namespace

CalibrationServices::CalibrationServices(const ros::NodeHandle& private_node, const AesopParameters& parameters,
                                         const ServiceCallers& callers, ServiceErrors& errors, aesop::Driver& driver)
    : node_(private_node, "calibrate_insertion_point"),
      callers_(callers),
      errors_(errors),
      frame_(parameters.frame_prefix + "aesop_base"),
      origin_(parameters.insertion_point_origin),
      calibration_(parameters.calibration, driver) {
  publisher_ = node_.advertise<CalibrationState>("state", 10, true);
  using Start = ros::ServiceEvent<StartCalibration::Request, StartCalibration::Response>;
  using End = ros::ServiceEvent<std_srvs::Trigger::Request, Ending>;
  const boost::function<bool(Start&)> on_start = [this](Start& event) {
    StartCalibration::Response& response = event.getResponse();
    response.message = callers_.refusal("calibrate_insertion_point/start", event.getCallerName());
    if (response.message.empty()) errors_.guard(response, [&] { start(event.getRequest(), response); });
    return true;
  };
  const boost::function<bool(End&)> on_finish = [this](End& event) {
    Ending& response = event.getResponse();
    response.message = callers_.refusal("calibrate_insertion_point/finish", event.getCallerName());
    if (response.message.empty()) errors_.guard(response, [&] { end(calibration_.finish(steadyNow()), response); });
    return true;
  };
  // Services that stop the arm may be called by every node.
  const boost::function<bool(End&)> on_cancel = [this](End& event) {
    Ending& response = event.getResponse();
    errors_.guard(response, [&] { end(calibration_.cancel(steadyNow()), response); });
    return true;
  };
  services_ = {node_.advertiseService("start", on_start), node_.advertiseService("finish", on_finish),
               node_.advertiseService("cancel", on_cancel)};
  ROS_INFO_STREAM("insertion point: " << origin_);
  publisher_.publish(toMessage(calibration_, frame_));
}

bool CalibrationServices::step(double stamp_now, double now) {
  const bool moved = calibration_.step(stamp_now, now);
  if (moved) origin_ = calibration_.message();
  publish(now);
  return moved;
}

bool CalibrationServices::takes(const scope::Velocity& command, double now) {
  if (!calibration_.drives()) return false;
  calibration_.otherCommand(command, now);
  publish(now);
  return true;
}

void CalibrationServices::publish(double now) {
  const Stage stage = calibration_.stage();
  const bool changed = stage != published_;
  if (!changed && (stage != Stage::kCollecting || now < next_publication_)) return;
  published_ = stage;
  next_publication_ = now + kPeriod;
  publisher_.publish(toMessage(calibration_, frame_));
  if (stage == Stage::kCollecting) {
    ROS_INFO_STREAM_THROTTLE(kWordPause,
                             "calibration: " << calibration_.fit().poses << " poses, " << calibration_.message());
  } else if (stage == Stage::kFailed) {
    ROS_ERROR_STREAM("calibration failed: " << calibration_.message());
  } else if (stage == Stage::kDone) {
    ROS_INFO_STREAM(calibration_.message());
  }
}

void CalibrationServices::describe(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  status.add("insertion point", origin_);
  status.add("calibration", stageName(calibration_.stage()) + ": " + calibration_.message());
}

void CalibrationServices::start(const StartCalibration::Request& request, StartCalibration::Response& response) {
  if (request.method != StartCalibration::Request::HAND && request.method != StartCalibration::Request::PATTERN) {
    response.message = "no method '" + request.method + "', expected HAND or PATTERN";
    return;
  }
  const bool by_hand = request.method == StartCalibration::Request::HAND;
  response.message = calibration_.start(by_hand ? CalibrationMethod::kHand : CalibrationMethod::kPattern, steadyNow());
  response.success = response.message.empty();
  if (!response.success) return;
  response.message = by_hand ? "move the scope about the trocar, to all sides; then finish" : "the arm moves";
  publish(steadyNow());
}

void CalibrationServices::end(const std::string& refusal, Ending& response) {
  response.success = refusal.empty();
  response.message = refusal.empty() ? calibration_.message() : refusal;
  publish(steadyNow());
}

}  // namespace laparoscope_servo
