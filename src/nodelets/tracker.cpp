#include "nodelets/tracker.h"

#include <boost/make_shared.hpp>
#include <exception>
#include <optional>
#include <pluginlib/class_list_macros.hpp>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include "ros/common/clocks.h"
#include "ros/common/parameters.h"
#include "ros/tracker/overlay.h"
#include "ros/tracker/result_messages.h"

namespace laparoscope_servo::nodelets {

namespace {

constexpr double kStatePeriod = 0.2;  // s between two checks for images

template <class Message>
void publishIfHeard(const ros::Publisher& publisher, Message (*make)(const Processed&), const Processed& processed) {
  if (publisher.getNumSubscribers() > 0) publisher.publish(boost::make_shared<Message>(make(processed)));
}

// The question if it is of this kind, or null.
template <class Kind>
const Kind* questionOf(const AnswerGuard<TrackerRequest>& guard) {
  return guard.question() ? std::get_if<Kind>(&*guard.question()) : nullptr;
}

}  // namespace

Tracker::~Tracker() {
  // Ends the services first, which may be waiting for an image that will not come any more.
  request_.close();
  request_thread_.reset();
  view_thread_.reset();
}

std::vector<std::string> Tracker::configure() {
  state_publisher_ = getPrivateNodeHandle().advertise<TrackerState>("state", 5, true);
  std::vector<std::string> errors;
  parameters_ =
      readTrackerParameters(parametersOf(getPrivateNodeHandle()), getPrivateNodeHandle().getNamespace(), errors);
  return errors;
}

void Tracker::notStarted(const std::string& why) {
  if (state_publisher_) state_publisher_.publish(laparoscope_servo::notStarted(why));
}

void Tracker::start() {
  const TrackerParameters& parameters = parameters_;
  session_ = std::make_unique<TrackerSession>(parameters);
  views_ = std::make_unique<ViewLibrary>(parameters);
  desk_ = std::make_unique<RegionDesk>(parameters);
  statistics_ = std::make_unique<TrackerDiagnostics>(parameters.tracking, parameters.robot_motion.enabled,
                                                     parameters.external_mask.enabled);
  if (parameters.robot_motion.enabled) session_->setCameraMotion(followRobot(parameters.robot_motion));
  if (parameters.external_mask.enabled) followMasks(parameters.external_mask);

  ros::NodeHandle& node = getNodeHandle();
  ros::NodeHandle& private_node = getPrivateNodeHandle();
  homography_publisher_ = private_node.advertise<Homography>("homography", 10);
  task_error_publisher_ = private_node.advertise<TaskError>("task_error", 10);
  areas_publisher_ = private_node.advertise<AreaSelection>("areas", 10);
  roi_publisher_ = private_node.advertise<geometry_msgs::PolygonStamped>("roi", 10);
  mask_publisher_ = private_node.advertise<sensor_msgs::Image>("occlusion_mask", 2);
  overlay_publisher_ = private_node.advertise<sensor_msgs::Image>("overlay", 2);
  preview_publisher_ = private_node.advertise<sensor_msgs::Image>("preview", 2);
  state_timer_ = node.createWallTimer(ros::WallDuration(kStatePeriod), [this](const ros::WallTimerEvent&) {
    publishState(state_report_.tick(steadyNow()));
  });
  reset_server_ = private_node.advertiseService("reset", &Tracker::reset, this);

  live_ = std::make_unique<LiveParameters<TrackerParameters>>(private_node, parameters);
  request_thread_ = std::make_unique<ServiceThread>(private_node);
  request_thread_->advertiseService("select_roi", &Tracker::selectRoi, this);
  request_thread_->advertiseService("check_roi", &Tracker::checkRoi, this);
  request_thread_->advertiseService("freeze_image", &Tracker::freezeImage, this);
  request_thread_->advertiseService("select_frozen_roi", &Tracker::selectFrozenRoi, this);
  view_thread_ = std::make_unique<ServiceThread>(private_node);
  view_thread_->advertiseService("store_view", &Tracker::storeView, this);
  view_thread_->advertiseService("recall_view", &Tracker::recallView, this);
  view_thread_->advertiseService("list_views", &Tracker::listViews, this);
  subscribe();
  request_thread_->start();
  view_thread_->start();
}

void Tracker::followMasks(MaskInputConfig config) {
  constexpr std::uint32_t kQueue = 10;  // masks that come while an image is processed, and those of a stranger between
  if (!config.owner.empty()) config.owner = getNodeHandle().resolveName(config.owner, false);
  masks_ = std::make_unique<MaskInput>(config, session_->parameters().input);
  session_->setMaskSource(
      [this](const cv::Mat& image, const ros::Time& stamp) { return masks_->at(stamp, image.size()); });
  mask_subscriber_ = getPrivateNodeHandle().subscribe("external_mask", kQueue, &Tracker::takeMask, this,
                                                      ros::TransportHints().tcpNoDelay());
}

// A mask that is refused leaves tracking as it is.
void Tracker::takeMask(const ros::MessageEvent<const sensor_msgs::Image>& event) {
  const double now = steadyNow();
  try {
    masks_->take(event.getConstMessage(),
                 {event.getPublisherName(), event.getConnectionHeaderPtr(), now, clockOfStamps()});
  } catch (const std::exception& error) {
    statistics_->maskRefused(now, error.what());
    NODELET_WARN_THROTTLE(kThrottle, "external mask refused: %s", error.what());
  }
}

void Tracker::clockJumpedBack() {
  session_->clockJumpedBack();
  if (masks_) masks_->clockJumpedBack();
}

void Tracker::process(const sensor_msgs::ImageConstPtr& message) {
  AnswerGuard<TrackerRequest> guard(request_);
  Processed processed;
  try {
    if (live_->take(parameters_)) session_->retune(parameters_);
    checkTime(message->header.stamp, session_->parameters().input.max_ahead);
    const auto* roi = questionOf<geometry::Rectangle>(guard);
    processed = session_->process(*message, roi != nullptr ? std::make_optional(*roi) : std::nullopt);
  } catch (const std::exception& error) {
    guard.set({false, std::string("the image could not be used: ") + error.what()});
    throw;
  }
  if (const auto* roi = questionOf<geometry::Rectangle>(guard)) {
    const bool selected = processed.result.selected_now;
    guard.set({selected, selected ? "selected " + roiText(*roi) : processed.selection_error});
  } else if (const auto* route = questionOf<RecallRoute>(guard)) {
    const std::string error = session_->recall(*route);
    guard.set({error.empty(), error});
  } else if (questionOf<WantSnapshot>(guard) != nullptr) {
    guard.set({true, "", std::make_shared<const Snapshot>(session_->snapshot(processed)), session_->reference()});
  }
  if (!processed.selection_error.empty()) {
    NODELET_ERROR_THROTTLE(kThrottle, "the ROI could not be selected: %s", processed.selection_error.c_str());
  }
  statistics_->processed(steadyNow(), processed, session_->ignoresDistortion());
  publish(processed);
  statistics_->answered(steadyNow(), (ros::Time::now() - processed.header.stamp).toSec());
}

void Tracker::publish(const Processed& processed) {
  publishIfHeard(homography_publisher_, homographyMessage, processed);
  publishIfHeard(task_error_publisher_, taskErrorMessage, processed);
  publishIfHeard(areas_publisher_, areaSelectionMessage, processed);
  publishIfHeard(roi_publisher_, roiMessage, processed);
  publishState(state_report_.processed(steadyNow(), processed));
  if (mask_publisher_.getNumSubscribers() > 0) {
    mask_publisher_.publish(imageMessage(processed.header, session_->occlusionMask()));
  }
  if (preview_publisher_.getNumSubscribers() > 0 && preview_.due(steadyNow())) {
    preview_publisher_.publish(imageMessage(processed.header, preview_.of(processed.image, processed.lens)));
  }
  if (overlay_publisher_.getNumSubscribers() > 0) {
    overlay_publisher_.publish(
        imageMessage(processed.header, drawOverlay(processed.image, processed.result, processed.lens.get())));
  }
}

void Tracker::notSeen(const sensor_msgs::Image& image, const std::string& /*why*/) {
  Processed not_seen;
  not_seen.header = image.header;
  not_seen.reference_stamp = session_->referenceStamp();
  publishIfHeard(task_error_publisher_, taskErrorMessage, not_seen);
}

void Tracker::publishState(const std::optional<TrackerState>& state) {
  if (state) state_publisher_.publish(*state);
}

void Tracker::refused(const std::string& error, Refusal cause) {
  const double now = steadyNow();
  state_report_.refused(now, error);
  statistics_->refused(now, error, cause);
}

bool Tracker::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  session_->reset();
  response.success = static_cast<std::uint8_t>(true);
  response.message = "the ROI is forgotten";
  return true;
}

void Tracker::diagnose(double now, const FeedPublishers& publishers,
                       diagnostic_updater::DiagnosticStatusWrapper& status) {
  statistics_->setPublishers(publishers);
  statistics_->fill(now, status);
}

}  // namespace laparoscope_servo::nodelets

PLUGINLIB_EXPORT_CLASS(laparoscope_servo::nodelets::Tracker, nodelet::Nodelet)
