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
#include "ros/common/network_exposure.h"
#include "ros/common/parameters.h"
#include "ros/tracker/image_gate.h"
#include "ros/tracker/overlay.h"
#include "ros/tracker/result_messages.h"

namespace laparoscope_servo::nodelets {

namespace {

constexpr double kAhead = 1.0;        // s, by which tf may be ahead of this machine's clock
constexpr double kStatePeriod = 0.2;  // s between two checks for images
constexpr double kThrottle = 5.0;     // s between two lines of the log about the same kind of error

template <class Message>
void publishIfHeard(const ros::Publisher& publisher, Message (*make)(const Processed&), const Processed& processed) {
  if (publisher.getNumSubscribers() > 0) publisher.publish(boost::make_shared<Message>(make(processed)));
}

// Answers a request that was taken, also if an exception is thrown.
class AnswerGuard {
 public:
  explicit AnswerGuard(TrackerRequest& request) : request_(request), question_(request.take()) {}
  ~AnswerGuard() {
    if (question_) request_.answer(answer_);
  }
  AnswerGuard(const AnswerGuard&) = delete;
  AnswerGuard& operator=(const AnswerGuard&) = delete;

  // The question if it is of this kind, or null.
  template <class Kind>
  const Kind* get() const {
    return question_ ? std::get_if<Kind>(&*question_) : nullptr;
  }
  void set(const TrackerRequest::Answer& answer) { answer_ = answer; }

 private:
  TrackerRequest& request_;
  std::optional<TrackerRequest::Question> question_;
  TrackerRequest::Answer answer_{false, "the image could not be processed"};
};

}  // namespace

Tracker::~Tracker() {
  // Ends the services first, which may be waiting for an image that will not come any more.
  request_.close();
  if (request_spinner_) request_spinner_->stop();
  if (view_spinner_) view_spinner_->stop();
  for (ros::ServiceServer* server :
       {&select_server_, &check_server_, &freeze_server_, &select_frozen_server_, &list_server_})
    server->shutdown();
  store_server_.shutdown();
  recall_server_.shutdown();
}

void Tracker::onInit() {
  // Exceptions must not leave onInit(); they would end the nodelet manager, with the camera driver in it.
  try {
    state_publisher_ = getPrivateNodeHandle().advertise<TrackerState>("state", 5, true);
    diagnostics_ = std::make_unique<diagnostic_updater::Updater>(getNodeHandle(), getPrivateNodeHandle(), getName());
    diagnostics_->setHardwareID("none");
    diagnostics_->add("tracking", this, &Tracker::diagnose);
    // Uses force_update() and the wall clock: Updater::update() stops publishing when the time of a looped bag jumps
    // back.
    diagnostics_timer_ = getNodeHandle().createWallTimer(
        ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_->force_update(); });
    const std::string& name = getPrivateNodeHandle().getNamespace();
    std::vector<std::string> errors;
    const auto parameters = readTrackerParameters(parametersOf(getPrivateNodeHandle()), name, errors);
    if (!errors.empty()) return standAside(errorReport(errors));
    warnOfExposure();
    start(parameters);
  } catch (const std::exception& error) {
    standAside(error.what());
  }
}

void Tracker::standAside(const std::string& why) {
  why_aside_ = why;
  state_publisher_.publish(notStarted(why));
  NODELET_ERROR("the tracker does not start: %s", why.c_str());
}

void Tracker::start(const TrackerParameters& parameters) {
  session_ = std::make_unique<TrackerSession>(parameters);
  views_ = std::make_unique<ViewLibrary>(parameters);
  desk_ = std::make_unique<RegionDesk>(parameters);
  statistics_ = std::make_unique<TrackerDiagnostics>(parameters.tracking, parameters.robot_motion.enabled);
  if (parameters.robot_motion.enabled) followRobot(parameters.robot_motion);

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
  camera_info_subscriber_ = node.subscribe("camera_info", 2, &Tracker::cameraInfoCallback, this);
  subscribeImages();

  ros::NodeHandle request_node(private_node);
  request_node.setCallbackQueue(&request_queue_);
  select_server_ = request_node.advertiseService("select_roi", &Tracker::selectRoi, this);
  check_server_ = request_node.advertiseService("check_roi", &Tracker::checkRoi, this);
  freeze_server_ = request_node.advertiseService("freeze_image", &Tracker::freezeImage, this);
  select_frozen_server_ = request_node.advertiseService("select_frozen_roi", &Tracker::selectFrozenRoi, this);
  request_spinner_ = std::make_unique<ros::AsyncSpinner>(1, &request_queue_);
  request_spinner_->start();

  ros::NodeHandle view_node(private_node);
  view_node.setCallbackQueue(&view_queue_);
  store_server_ = view_node.advertiseService("store_view", &Tracker::storeView, this);
  recall_server_ = view_node.advertiseService("recall_view", &Tracker::recallView, this);
  list_server_ = view_node.advertiseService("list_views", &Tracker::listViews, this);
  view_spinner_ = std::make_unique<ros::AsyncSpinner>(1, &view_queue_);
  view_spinner_->start();
}

void Tracker::followRobot(const RobotMotionConfig& config) {
  const std::string fixed_frame = fixedFrame(config, getNodeHandle().getNamespace());
  TransformGateConfig gate;
  if (!config.owner.empty()) gate.owner = getNodeHandle().resolveName(config.owner, false);
  gate.parameter = "robot_motion/owner";
  gate.frames = {fixed_frame};
  gate.max_ahead = kAhead;
  transforms_ = std::make_unique<OwnedTransforms>(gate);
  session_->setCameraMotion([this, fixed_frame](const std::string& frame, const ros::Time& from, const ros::Time& to,
                                                std::string& why) -> std::optional<Eigen::Isometry3d> {
    transforms_->use(frame);
    const OwnedTransforms::Word word = transforms_->step(false, steadyNow());
    if (!word.complaint.empty()) NODELET_WARN_THROTTLE(kThrottle, "%s", word.complaint.c_str());
    why = word.problem;
    if (!why.empty()) return std::nullopt;
    const auto motion = cameraMotion(*transforms_->buffer(), fixed_frame, frame, from, to, why);
    if (!motion && !word.complaint.empty()) why += "; " + word.complaint;
    return motion;
  });
}

void Tracker::subscribeImages() {
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  const image_transport::TransportHints hints("raw", no_delay, getPrivateNodeHandle());
  // subscribes to the topic itself, since only then the sender of an image is known
  if (hints.getTransport() == "raw") {
    image_subscriber_ =
        getNodeHandle().subscribe("image", ImageBacklog::kQueue, &Tracker::rawImageCallback, this, no_delay);
    return;
  }
  transport_ = std::make_unique<image_transport::ImageTransport>(getNodeHandle());
  // A queue of one, since it is not known how long an image has waited in it.
  transport_subscriber_ = transport_->subscribe("image", 1, &Tracker::imageCallback, this, hints);
}

void Tracker::cameraInfoCallback(const ros::MessageEvent<const sensor_msgs::CameraInfo>& event) {
  if (!camera_info_owner_.counts(event.getPublisherName(), steadyNow())) return;
  session_->setCameraInfo(*event.getConstMessage());
}

void Tracker::rawImageCallback(const ros::MessageEvent<const sensor_msgs::Image>& event) {
  const double now = steadyNow();
  if (!image_owner_.counts(event.getPublisherName(), now)) {
    return refuse("several nodes publish " + image_subscriber_.getTopic() + ": " + image_owner_.complaint(now),
                  Refusal::kSender);
  }
  const sensor_msgs::ImageConstPtr message = event.getConstMessage();
  // The time of a recording goes at the player's pace, and tells nothing of how long an image has waited.
  const double waited = ros::Time::isSimTime() ? 0.0 : (ros::Time::now() - event.getReceiptTime()).toSec();
  if (!backlog_.takes(message->header.stamp, waited)) return;
  imageCallback(message);
  backlog_.took(steadyNow() - now);
}

// A bag that begins again also sets the clock back.
void Tracker::watchClock() {
  constexpr double kJump = 0.05;  // s: larger than corrections of the machine's clock
  const ros::Time now = ros::Time::now();
  if ((last_now_ - now).toSec() > kJump) session_->clockJumpedBack();
  last_now_ = now;
}

void Tracker::imageCallback(const sensor_msgs::ImageConstPtr& message) {
  // A bad image must not end the process, which the camera driver may share. (cv::Exception is a std::exception.)
  try {
    process(message);
  } catch (const ImageError& error) {
    refuse(error.what(), error.cause());
  } catch (const std::exception& error) {
    refuse(error.what());
  }
}

void Tracker::process(const sensor_msgs::ImageConstPtr& message) {
  AnswerGuard guard(request_);
  Processed processed;
  try {
    watchClock();
    if (live_->take(changed_)) session_->retune(changed_);
    // Simulated time comes on its own topic, before or after the image, so stamps are then not compared with it.
    const ros::Time now = ros::Time::isSimTime() ? ros::Time() : ros::Time::now();
    checkStamp(message->header.stamp, now, session_->parameters().input.max_ahead);
    const auto* roi = guard.get<geometry::Rectangle>();
    processed = session_->process(*message, roi != nullptr ? std::make_optional(*roi) : std::nullopt);
  } catch (const std::exception& error) {
    guard.set({false, std::string("the image could not be used: ") + error.what()});
    throw;
  }
  if (const auto* roi = guard.get<geometry::Rectangle>()) {
    const bool selected = processed.result.selected_now;
    guard.set({selected, selected ? "selected " + roiText(*roi) : processed.selection_error});
  } else if (const auto* route = guard.get<RecallRoute>()) {
    const std::string error = session_->recall(*route);
    guard.set({error.empty(), error});
  } else if (guard.get<TrackerRequest::WantSnapshot>() != nullptr) {
    guard.set({true, "", std::make_shared<const Snapshot>(session_->snapshot(processed))});
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

void Tracker::publishState(const std::optional<TrackerState>& state) {
  if (state) state_publisher_.publish(*state);
}

void Tracker::refuse(const std::string& error, Refusal cause) {
  state_report_.refused(error);
  statistics_->refused(steadyNow(), error, cause);
  NODELET_ERROR_THROTTLE(kThrottle, "image refused: %s", error.c_str());
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
    const double now = steadyNow();
    const bool raw = static_cast<bool>(image_subscriber_);
    statistics_->setPublishers({raw ? image_subscriber_.getNumPublishers() : transport_subscriber_.getNumPublishers(),
                                camera_info_subscriber_.getNumPublishers(), image_owner_.complaint(now),
                                camera_info_owner_.complaint(now)});
    statistics_->fill(now, status);
  }
}

}  // namespace laparoscope_servo::nodelets

PLUGINLIB_EXPORT_CLASS(laparoscope_servo::nodelets::Tracker, nodelet::Nodelet)
