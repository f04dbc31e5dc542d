#include "nodelets/feature_nodelet.h"

#include <boost/make_shared.hpp>
#include <exception>
#include <sstream>
#include <utility>

#include "ros/common/clocks.h"
#include "ros/common/parameters.h"
#include "ros/features/feature_diagnostics.h"
#include "ros/features/feature_messages.h"
#include "ros/features/feature_overlay.h"
#include "ros/features/feature_trackers.h"
#include "ros/features/selection_text.h"
#include "ros/tracker/result_messages.h"

namespace laparoscope_servo::nodelets {

FeatureNodelet::~FeatureNodelet() {
  // Ends the service first, which may be waiting for an image that will not come any more.
  request_.close();
  request_thread_.reset();
}

std::vector<std::string> FeatureNodelet::configure() {
  std::vector<std::string> errors;
  auto tracker = makeFeatureTracker(kind_, parametersOf(getPrivateNodeHandle()), getPrivateNodeHandle().getNamespace(),
                                    input_, errors);
  if (errors.empty()) session_ = std::make_unique<FeatureSession>(input_, std::move(tracker));
  return errors;
}

void FeatureNodelet::start() {
  ros::NodeHandle& private_node = getPrivateNodeHandle();
  features_publisher_ = private_node.advertise<TrackedFeatures>("features", 10);
  overlay_publisher_ = private_node.advertise<sensor_msgs::Image>("overlay", 2);
  preview_publisher_ = private_node.advertise<sensor_msgs::Image>("preview", 2);
  if (session_->givesMask()) mask_publisher_ = private_node.advertise<sensor_msgs::Image>("mask", 2);
  if (session_->givesPoses()) poses_ = std::make_unique<PosePublisher>(private_node, input_.publish_tf);
  if (input_.robot_motion.enabled) session_->setCameraMotion(followRobot(input_.robot_motion));
  reset_server_ = private_node.advertiseService("reset", &FeatureNodelet::reset, this);
  request_thread_ = std::make_unique<ServiceThread>(private_node);
  request_thread_->advertiseService("select_features", &FeatureNodelet::select, this);
  subscribe();
  request_thread_->start();
}

void FeatureNodelet::process(const sensor_msgs::ImageConstPtr& message) {
  AnswerGuard<Request> guard(request_);
  ProcessedFeatures processed;
  try {
    checkTime(message->header.stamp, input_.input.max_ahead);
    processed = session_->process(*message, guard.question());
  } catch (const std::exception& error) {
    guard.set({false, std::string("the image could not be used: ") + error.what()});
    throw;
  }
  if (guard.question()) {
    const std::string number = std::to_string(processed.result.features.size());
    guard.set({processed.selected_now, processed.selected_now ? "selected: " + number : processed.selection_error});
  }
  if (!processed.selection_error.empty())
    NODELET_ERROR_THROTTLE(kThrottle, "nothing was selected: %s", processed.selection_error.c_str());
  last_ = processed.result;
  selection_error_ = processed.selection_error;
  camera_error_ = processed.camera_error;
  motion_error_ = processed.motion_error;
  statistics_.processed(steadyNow(), processed.period, processed.processing_time, processed.repeats.whole > 0);
  publish(processed);
  statistics_.answered(steadyNow(), (ros::Time::now() - processed.header.stamp).toSec());
}

void FeatureNodelet::publishFeatures(const ProcessedFeatures& processed, const cv::Size& size) {
  if (features_publisher_.getNumSubscribers() == 0) return;
  features_publisher_.publish(boost::make_shared<TrackedFeatures>(
      featuresMessage(processed.header, size, processed.result, processed.selection_stamp)));
}

void FeatureNodelet::notSeen(const sensor_msgs::Image& image, const std::string& why) {
  publishFeatures(session_->notSeen(image.header, why),
                  cv::Size(static_cast<int>(image.width), static_cast<int>(image.height)));
}

void FeatureNodelet::publish(const ProcessedFeatures& processed) {
  publishFeatures(processed, processed.image.size());
  if (poses_) poses_->publish(processed.header, processed.result);
  if (mask_publisher_ && mask_publisher_.getNumSubscribers() > 0)
    mask_publisher_.publish(imageMessage(processed.header, session_->mask()));
  if (preview_publisher_.getNumSubscribers() > 0 && preview_.due(steadyNow()))
    preview_publisher_.publish(imageMessage(processed.header, preview_.of(processed.image, nullptr)));
  if (overlay_publisher_.getNumSubscribers() > 0) {
    overlay_publisher_.publish(
        imageMessage(processed.header, drawFeatures(processed.image, processed.result, session_->mask())));
  }
}

void FeatureNodelet::refused(const std::string& error, Refusal cause) {
  statistics_.refused(steadyNow(), error, cause);
}

void FeatureNodelet::diagnose(double now, const FeedPublishers& publishers,
                              diagnostic_updater::DiagnosticStatusWrapper& status) {
  statistics_.setPublishers(publishers);
  fillFeatureDiagnostics(now, last_, selection_error_, statistics_, status);
  status.add("intrinsics", camera_error_.empty() ? "from camera_info" : camera_error_);
  if (input_.robot_motion.enabled) status.add("robot_motion", motion_error_.empty() ? "from tf" : motion_error_);
}

bool FeatureNodelet::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  session_->reset();
  response.success = static_cast<std::uint8_t>(true);
  response.message = "the features are forgotten";
  return true;
}

bool FeatureNodelet::select(SelectFeatures::Request& request, SelectFeatures::Response& response) {
  Answer answer;
  try {
    const features::FeatureSelection selection = parseSelection(request.selection);
    std::ostringstream timeout;
    timeout << "no image came on " << getNodeHandle().resolveName("image") << " within " << input_.select_timeout
            << " s (parameter select_timeout)";
    answer = request_.ask(selection, input_.select_timeout, timeout.str());
  } catch (const std::exception& error) {
    answer.message = error.what();
  }
  response.success = static_cast<std::uint8_t>(answer.success);
  response.message = answer.message;
  return true;
}

}  // namespace laparoscope_servo::nodelets
