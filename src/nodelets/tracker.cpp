#include "tracker.h"

#include <boost/make_shared.hpp>
#include <chrono>
#include <exception>
#include <optional>
#include <pluginlib/class_list_macros.hpp>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "laparoscope_servo/ros/overlay.h"
#include "laparoscope_servo/ros/parameters.h"
#include "laparoscope_servo/ros/result_messages.h"

namespace laparoscope_servo::nodelets {

namespace {

constexpr double kThrottle = 5.0;  // s between two lines of the log about the same kind of trouble

double steadySeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Message>
void publishIfHeard(const ros::Publisher& publisher, Message (*make)(const skin::Processed&),
                    const skin::Processed& processed) {
  if (publisher.getNumSubscribers() > 0) publisher.publish(boost::make_shared<Message>(make(processed)));
}

// Whoever takes a request has to answer it, also when an exception passes.
class AnswerGuard {
 public:
  explicit AnswerGuard(skin::RoiRequest& request) : request_(request), roi_(request.take()) {}
  ~AnswerGuard() {
    if (roi_) request_.answer(answer_);
  }
  AnswerGuard(const AnswerGuard&) = delete;
  AnswerGuard& operator=(const AnswerGuard&) = delete;

  const std::optional<geometry::Rectangle>& roi() const { return roi_; }
  void set(bool success, const std::string& message) { answer_ = {success, message}; }

 private:
  skin::RoiRequest& request_;
  std::optional<geometry::Rectangle> roi_;
  skin::RoiRequest::Answer answer_{false, "the image could not be processed"};
};

}  // namespace

Tracker::~Tracker() {
  // The service first: it may be waiting for an image that will not come any more.
  request_.close();
  if (request_spinner_) request_spinner_->stop();
  select_server_.shutdown();
}

void Tracker::onInit() {
  // Nothing that is wrong here may take the manager, and the camera driver in it, along.
  try {
    diagnostics_ = std::make_unique<diagnostic_updater::Updater>(getNodeHandle(), getPrivateNodeHandle(), getName());
    diagnostics_->setHardwareID("none");
    diagnostics_->add("tracking", this, &Tracker::diagnose);
    // Forced, and by the wall clock: Updater::update() falls silent when the time of a looped bag jumps back.
    diagnostics_timer_ = getNodeHandle().createWallTimer(
        ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_->force_update(); });
    const std::string& name = getPrivateNodeHandle().getNamespace();
    std::vector<std::string> errors;
    const auto parameters = skin::readTrackerParameters(skin::parametersOf(getPrivateNodeHandle()), name, errors);
    if (!errors.empty()) return standAside(skin::errorReport(errors));
    start(parameters);
  } catch (const std::exception& error) {
    standAside(error.what());
  }
}

void Tracker::standAside(const std::string& why) {
  why_aside_ = why;
  NODELET_ERROR("the tracker does not start: %s", why.c_str());
}

void Tracker::start(const skin::TrackerParameters& parameters) {
  session_ = std::make_unique<skin::TrackerSession>(parameters);
  statistics_ = std::make_unique<skin::TrackerDiagnostics>(parameters.tracking, parameters.robot_motion.enabled);
  if (parameters.robot_motion.enabled) followRobot(parameters.robot_motion);

  ros::NodeHandle& node = getNodeHandle();
  ros::NodeHandle& private_node = getPrivateNodeHandle();
  homography_publisher_ = private_node.advertise<Homography>("homography", 10);
  task_error_publisher_ = private_node.advertise<TaskError>("task_error", 10);
  areas_publisher_ = private_node.advertise<AreaSelection>("areas", 10);
  roi_publisher_ = private_node.advertise<geometry_msgs::PolygonStamped>("roi", 10);
  mask_publisher_ = private_node.advertise<sensor_msgs::Image>("occlusion_mask", 2);
  overlay_publisher_ = private_node.advertise<sensor_msgs::Image>("overlay", 2);
  reset_server_ = private_node.advertiseService("reset", &Tracker::reset, this);

  camera_info_subscriber_ = node.subscribe("camera_info", 2, &Tracker::cameraInfoCallback, this);
  // A queue of one: an image that waited is of no use to a control loop, the newest one is.
  transport_ = std::make_unique<image_transport::ImageTransport>(node);
  const image_transport::TransportHints hints("raw", ros::TransportHints().tcpNoDelay(), private_node);
  image_subscriber_ = transport_->subscribe("image", 1, &Tracker::imageCallback, this, hints);

  ros::NodeHandle request_node(private_node);
  request_node.setCallbackQueue(&request_queue_);
  select_server_ = request_node.advertiseService("select_roi", &Tracker::selectRoi, this);
  request_spinner_ = std::make_unique<ros::AsyncSpinner>(1, &request_queue_);
  request_spinner_->start();
}

void Tracker::followRobot(const skin::RobotMotionConfig& config) {
  tf_ = std::make_unique<tf2_ros::Buffer>();
  tf_listener_ = std::make_unique<tf2_ros::TransformListener>(*tf_);  // in a thread of its own
  session_->setCameraMotion([this, fixed_frame = config.fixed_frame](const std::string& frame, const ros::Time& from,
                                                                     const ros::Time& to, std::string& why) {
    return skin::cameraMotion(*tf_, fixed_frame, frame, from, to, why);
  });
}

void Tracker::cameraInfoCallback(const sensor_msgs::CameraInfoConstPtr& message) {
  session_->setCameraInfo(*message);
}

void Tracker::imageCallback(const sensor_msgs::ImageConstPtr& message) {
  // cv::Exception is a std::exception. One odd image must not end the process that the camera driver may share.
  try {
    process(message);
  } catch (const std::exception& error) {
    refuse(error.what());
  }
}

void Tracker::process(const sensor_msgs::ImageConstPtr& message) {
  AnswerGuard guard(request_);
  skin::Processed processed;
  try {
    processed = session_->process(*message, guard.roi());
  } catch (const std::exception& error) {
    guard.set(false, std::string("the image could not be used: ") + error.what());
    throw;
  }
  if (guard.roi()) {
    const bool selected = processed.result.selected_now;
    guard.set(selected, selected ? "selected " + skin::roiText(*guard.roi()) : processed.selection_error);
  }
  if (!processed.selection_error.empty()) {
    NODELET_ERROR_THROTTLE(kThrottle, "the ROI could not be selected: %s", processed.selection_error.c_str());
  }
  statistics_->processed(steadySeconds(), processed, session_->ignoresDistortion());
  publish(processed);
}

void Tracker::publish(const skin::Processed& processed) {
  publishIfHeard(homography_publisher_, skin::homographyMessage, processed);
  publishIfHeard(task_error_publisher_, skin::taskErrorMessage, processed);
  publishIfHeard(areas_publisher_, skin::areaSelectionMessage, processed);
  publishIfHeard(roi_publisher_, skin::roiMessage, processed);
  if (mask_publisher_.getNumSubscribers() > 0) {
    mask_publisher_.publish(skin::imageMessage(processed.header, session_->occlusionMask()));
  }
  if (overlay_publisher_.getNumSubscribers() > 0) {
    overlay_publisher_.publish(skin::imageMessage(
        processed.header, skin::drawOverlay(processed.image, processed.result, processed.lens.get())));
  }
}

void Tracker::refuse(const std::string& error) {
  statistics_->refused(steadySeconds(), error);
  NODELET_ERROR_THROTTLE(kThrottle, "image refused: %s", error.c_str());
}

bool Tracker::selectRoi(SelectRoi::Request& request, SelectRoi::Response& response) {
  const geometry::Rectangle roi{static_cast<double>(request.roi.x_offset), static_cast<double>(request.roi.y_offset),
                                static_cast<double>(request.roi.width), static_cast<double>(request.roi.height)};
  std::ostringstream timeout;
  timeout << "no image came on " << image_subscriber_.getTopic() << " within " << session_->parameters().select_timeout
          << " s (parameter select_timeout)";
  const skin::RoiRequest::Answer answer = request_.ask(roi, session_->parameters().select_timeout, timeout.str());
  response.success = static_cast<std::uint8_t>(answer.success);
  response.message = answer.message;
  return true;
}

bool Tracker::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  session_->reset();
  response.success = static_cast<std::uint8_t>(true);
  response.message = "the ROI is forgotten";
  return true;
}

void Tracker::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (!why_aside_.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, "not started: " + why_aside_);
  } else if (statistics_) {
    statistics_->fill(steadySeconds(), status);
  }
}

}  // namespace laparoscope_servo::nodelets

PLUGINLIB_EXPORT_CLASS(laparoscope_servo::nodelets::Tracker, nodelet::Nodelet)
