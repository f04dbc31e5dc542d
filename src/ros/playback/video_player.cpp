#include "ros/playback/video_player.h"

#include <image_transport/camera_common.h>
#include <rosgraph_msgs/Clock.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <stdexcept>
#include <thread>

#include "ros/tracker/camera_info.h"
#include "ros/tracker/image_conversion.h"
#include "ros/tracker/result_messages.h"

namespace laparoscope_servo {

namespace {

constexpr std::chrono::milliseconds kClockPeriod(10);
constexpr std::chrono::milliseconds kCameraInfoTimeout(500);
constexpr std::chrono::milliseconds kStatePeriod(200);
constexpr std::chrono::milliseconds kHeldPeriod(200);
// After the clock went back: it comes on a topic of its own, and an image that overtakes it would be refused.
constexpr std::chrono::milliseconds kJumpPause(100);
const ros::Duration kHeldStep(0, 1000);            // step of repeated stamps; 40,000 fit between two images of a film
constexpr std::chrono::seconds kResultTimeout(2);  // a tracker without results must not stop the video

}  // namespace

void describe(parameters::Table& table, VideoPlayerConfig& c) {
  table.text("video", c.video, "bag (or several with spaces between), video file or folder of images")
      .required("/path/to/video.mp4");
  table.text("folder", c.folder, "of relative paths; empty: where the node was started");
  table.text("image_topic", c.image_topic, "of a bag; empty: the only one with images");
  table.text("camera_info_topic", c.camera_info_topic, "of a bag; empty: beside the images");
  table.text("camera_info", c.camera_info, "calibration file, YAML or INI; empty: none");
  table.text("frame_id", c.frame_id, "of a video's images; a bag's keep theirs");
  table.number("fps", c.fps, {0.1, 1000}, "Hz", "of a folder, and of a video that does not tell its own");
  table.number("speed", c.speed, {0.01, 100}, "times", "as fast as it was recorded");
  table.number("start", c.start, {0, 1e6}, "s", "what comes before is skipped");
  table.number("first_stamp", c.first_stamp, {1e-3, 1e9}, "s", "of a video's first image");
  table.flag("loop", c.loop, "begins again at the end");
  table.flag("stay", c.stay, "the node goes on at the end, so that the last image can be looked at");
  table.flag("restart_time", c.restart_time, "at a loop stamps jump back; false: they go on");
  table.flag("clock", c.clock, "publishes /clock");
  table.flag("hold", c.hold, "stays at the first image until a region is selected");
  table.flag("wait_for_screen", c.wait_for_screen, "the first image waits for a subscriber of ~state");
  table.flag("lockstep", c.lockstep, "the next image waits for homography, 2 s at most");
  table.number("subscribers", c.subscribers, {0, 100}, "nodes", "to wait for before the first image");
}

std::vector<std::string> validate(const VideoPlayerConfig& config) {
  return parameters::errorsOf(config);
}

VideoPlayer::VideoPlayer(ros::NodeHandle node, const VideoPlayerConfig& config)
    : node_(node), config_(config), transport_(node), control_node_("~"), control_spinner_(1, &control_queue_) {
  options_.image_topic = config.image_topic;
  options_.camera_info_topic = config.camera_info_topic;
  options_.start = config.start;
  options_.folder_rate = config.fps;
  if (!config.camera_info.empty()) camera_info_ = readCameraInfo(config.camera_info);
  if (config.clock) clock_publisher_ = node.advertise<rosgraph_msgs::Clock>("/clock", 10);
  if (config.lockstep || config.hold) {
    homography_subscriber_ = node.subscribe<Homography>("homography", 10, [this](const HomographyConstPtr& result) {
      tracked_ = result->state != Homography::IDLE;
      if (tracked_) control_.releaseHold();
      answered_ = answered_ || result->header.stamp == awaited_;
    });
  }
  // The queue is long enough for a burst of images after a slow read.
  image_publisher_ = transport_.advertise("image_raw", 50);
  const std::string info_topic = image_transport::getCameraInfoTopic(node.resolveName("image_raw"));
  camera_info_publisher_ = node.advertise<sensor_msgs::CameraInfo>(info_topic, 50);
  control_node_.setCallbackQueue(&control_queue_);
  state_publisher_ = control_node_.advertise<PlaybackState>("state", 5, true);
  control_server_ = control_node_.advertiseService<ControlPlayback::Request, ControlPlayback::Response>(
      "control", [this](ControlPlayback::Request& request, ControlPlayback::Response& response) {
        response.message = control_.command(request.command, request.position);
        response.success = static_cast<std::uint8_t>(response.message.empty());
        return true;
      });
  control_spinner_.start();
  tellState();
}

void VideoPlayer::open(double start) {
  SourceOptions options = options_;
  options.start = std::max(start, options_.start);
  source_ = openImageSource(inputsOf(config_.video), options);
  if (recorded_) return;
  if (!source_->hasRecordedStamps()) offset_ = ros::Duration(config_.first_stamp);
  recorded_ = std::make_unique<RecordedResults>(inputsOf(config_.video), config_.image_topic);
  if (recorded_->any()) recorded_publisher_ = node_.advertise<Homography>("recorded_homography", 50);
}

void VideoPlayer::run() {
  do {
    try {
      failure_.clear();
      if (!source_) open(from_);
      play();
    } catch (const SourceError& error) {
      if (!config_.wait_for_screen || !config_.stay) throw;
      fail(error);
    }
  } while (waitForAgain());
  if (!failure_.empty()) throw SourceError(failure_);
}

void VideoPlayer::fail(const SourceError& error) {
  ROS_ERROR("%s", error.what());
  failure_ = error.what();
  control_.fail();
  told_ = PlaybackState();  // said also when it could not be read before
  tellState();
}

// Until the end of the recording.
void VideoPlayer::play() {
  if (!begun_) {
    waitForSubscribers();
    control_.begin(config_.hold);
    begun_ = true;
  }
  while (ros::ok()) {
    const std::size_t before = published_;
    playOnce();
    if (ros::ok() && published_ == before && !sought_) {
      throw SourceError("'" + config_.video + "' has no image after " + std::to_string(config_.start) + " s");
    }
    if (!told_notes_) tellNotes();
    told_notes_ = true;
    if (!config_.loop) break;
    if (!config_.restart_time) offset_ += last_ - begin_ + ros::Duration(1.0 / source_->rate());
    open(0.0);
  }
  control_.end();
  tellState();
  ROS_INFO("played %zu images of '%s'%s", published_, config_.video.c_str(),
           config_.stay && ros::ok() ? "; the last one stays until this node is ended" : "");
}

// Waits at the end for another command; returns false if playback is over.
bool VideoPlayer::waitForAgain() {
  while (config_.stay && ros::ok()) {
    if (const std::optional<double> seek = control_.takeSeek()) {
      reopen(*seek);
      return true;
    }
    ros::spinOnce();
    std::this_thread::sleep_for(kClockPeriod);
  }
  return false;
}

// What cannot be opened any more is read on from where it is; one that could not be read at all is tried by run().
void VideoPlayer::reopen(double start) {
  sought_ = failure_.empty();
  from_ = start;
  if (!failure_.empty()) source_.reset();
  if (!source_) return;
  try {
    open(start);
  } catch (const SourceError& error) {
    ROS_ERROR("%s", error.what());
  }
}

void VideoPlayer::tellState() {
  PlaybackState state;
  state.state = control_.stateName();
  state.reason = failure_;
  state.position = position_;
  if (source_ && source_->rate() > 0.0) {
    state.duration = static_cast<double>(source_->size()) / source_->rate();
    state.period = 1.0 / (source_->rate() * config_.speed);
  }
  state.images = static_cast<std::uint32_t>(published_);
  const auto now = Clock::now();
  if (state.state == told_.state && now - told_at_ < kStatePeriod) return;
  told_at_ = now;
  if (state.state == told_.state && state.images == told_.images) return;
  told_ = state;
  state_publisher_.publish(state);
}

// Waits while playback is paused.
bool VideoPlayer::mayPlay() {
  while (ros::ok()) {
    tellState();
    if (const std::optional<double> seek = control_.takeSeek()) {
      reopen(*seek);
      return false;
    }
    if (control_.takeImage()) return true;
    rebase_ = true;
    repeatHeld();
    ros::spinOnce();
    std::this_thread::sleep_for(kClockPeriod);
  }
  return true;
}

void VideoPlayer::repeatHeld() {
  if (!held_ || tracked_ || !homography_subscriber_ || Clock::now() < held_due_) return;
  held_due_ = Clock::now() + kHeldPeriod;
  held_ = boost::make_shared<sensor_msgs::Image>(*held_);
  held_->header.stamp += kHeldStep;
  held_time_ += kHeldStep;
  publishClock(held_time_);
  camera_info_.header = held_->header;
  camera_info_publisher_.publish(camera_info_);
  image_publisher_.publish(held_);
}

void VideoPlayer::tellNotes() const {
  for (const std::string& note : source_->notes()) ROS_WARN("'%s': %s", config_.video.c_str(), note.c_str());
  if (unanswered_ > 0) ROS_WARN("the tracker gave no result for %zu of %zu images", unanswered_, published_);
}

void VideoPlayer::waitForSubscribers() const {
  int waited = 0;
  for (; ros::ok(); ++waited) {
    const auto subscribers = static_cast<int>(image_publisher_.getNumSubscribers());
    const bool tracker = !config_.lockstep || homography_subscriber_.getNumPublishers() > 0;
    const bool screen = !config_.wait_for_screen || state_publisher_.getNumSubscribers() > 0;
    if (subscribers >= config_.subscribers && tracker && screen) break;
    if (waited % 500 == 100) {
      ROS_INFO("waiting for subscribers of %s: %d of %d%s%s", image_publisher_.getTopic().c_str(), subscribers,
               config_.subscribers, tracker ? "" : ", and for a tracker", screen ? "" : ", and for a screen");
    }
    std::this_thread::sleep_for(kClockPeriod);
  }
  // Most subscribers of the images also subscribe to the intrinsics, and need them with the first image.
  const auto end = Clock::now() + kCameraInfoTimeout;
  while (ros::ok() && waited > 0 && camera_info_publisher_.getNumSubscribers() == 0 && Clock::now() < end) {
    std::this_thread::sleep_for(kClockPeriod);
  }
}

ros::Time VideoPlayer::timeOf(const SourceImage& image) const {
  return (source_->hasRecordedStamps() ? image.record_time : image.header.stamp) + offset_;
}

void VideoPlayer::playOnce() {
  for (bool first = true; ros::ok(); first = false) {
    while (!mayPlay()) first = true;
    const std::optional<SourceImage> image = source_->next();
    if (!image) return;
    last_ = timeOf(*image);
    if (first || rebase_) {
      rebase_ = false;
      begin_ = last_;
      begin_due_ = Clock::now();
    }
    waitUntil(last_);
    publishClock(last_);
    if (first && last_ < held_time_) {
      std::this_thread::sleep_for(kJumpPause);
      begin_due_ = Clock::now();
    }
    position_ = static_cast<double>(image->frame) / source_->rate();
    held_time_ = last_;
    if (image->error.empty()) {
      awaited_ = image->header.stamp + offset_;
      answered_ = false;
      publish(*image);
      if (config_.lockstep) waitForResult(last_);
    } else {
      ROS_ERROR("image %zu is left out: %s", image->frame, image->error.c_str());
    }
    ros::spinOnce();
  }
}

VideoPlayer::Clock::time_point VideoPlayer::dueTime(const ros::Time& time) const {
  const std::chrono::duration<double> elapsed((time - begin_).toSec() / config_.speed);
  return begin_due_ + std::chrono::duration_cast<Clock::duration>(elapsed);
}

void VideoPlayer::waitUntil(const ros::Time& time) {
  const auto due = dueTime(time);
  for (auto next = Clock::now() + kClockPeriod; next < due && ros::ok(); next += kClockPeriod) {
    std::this_thread::sleep_until(next);
    const std::chrono::duration<double> left = due - next;
    publishClock(time - ros::Duration(left.count() * config_.speed));
  }
  std::this_thread::sleep_until(due);
}

void VideoPlayer::waitForResult(const ros::Time& time) {
  const auto begin = Clock::now();
  while (ros::ok() && !answered_ && homography_subscriber_.getNumPublishers() > 0 &&
         Clock::now() - begin < kResultTimeout) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.001));
  }
  if (!answered_ && ros::ok()) ++unanswered_;
  // After a delay the following images keep their normal rate.
  const auto late = Clock::now() - dueTime(time + ros::Duration(1.0 / source_->rate()));
  if (late > Clock::duration::zero()) begin_due_ += late;
}

void VideoPlayer::publishClock(const ros::Time& time) {
  if (!config_.clock) return;
  rosgraph_msgs::Clock message;
  message.clock = time;
  clock_publisher_.publish(message);
}

// With the image's stamp as it is played.
void VideoPlayer::publishRecorded(const SourceImage& image) {
  const HomographyConstPtr recorded = recorded_->at(image.header.stamp, image.record_time);
  if (!recorded) return;
  Homography result = *recorded;
  result.header.stamp += offset_;
  recorded_publisher_.publish(result);
}

void VideoPlayer::publish(const SourceImage& image) {
  publishRecorded(image);
  std_msgs::Header header = image.header;
  header.stamp += offset_;
  if (!source_->hasRecordedStamps()) header.frame_id = config_.frame_id;

  sensor_msgs::ImagePtr message;
  if (image.message) {
    message = boost::make_shared<sensor_msgs::Image>(*image.message);
    message->header = header;
  } else {
    message = imageMessage(header, trackerImage(image.decoded));
  }
  if (config_.camera_info.empty()) {
    if (image.camera_info) camera_info_ = *image.camera_info;
    if (camera_info_.K[0] == 0.0) {
      camera_info_.width = message->width;
      camera_info_.height = message->height;
    }
  } else if (camera_info_.width != message->width || camera_info_.height != message->height) {
    throw std::runtime_error("calibration '" + config_.camera_info + "' is for images of " +
                             std::to_string(camera_info_.width) + "x" + std::to_string(camera_info_.height) +
                             " px, but those of '" + config_.video + "' have " + std::to_string(message->width) + "x" +
                             std::to_string(message->height) + " px");
  }
  camera_info_.header = header;
  camera_info_publisher_.publish(camera_info_);
  image_publisher_.publish(message);
  held_ = message;
  held_due_ = Clock::now() + kHeldPeriod;
  sought_ = false;
  ++published_;
}

}  // namespace laparoscope_servo
