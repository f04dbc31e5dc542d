#include "ros/playback/video_player.h"

#include <laparoscope_servo/Homography.h>

#include <algorithm>
#include <thread>

namespace laparoscope_servo {

namespace {

constexpr std::chrono::milliseconds kClockPeriod(10);
constexpr std::chrono::milliseconds kCameraInfoTimeout(500);
constexpr std::chrono::milliseconds kStatePeriod(200);
// After the clock went back: it comes on a topic of its own, and an image that overtakes it would be refused.
constexpr std::chrono::milliseconds kJumpPause(100);
constexpr std::chrono::seconds kResultTimeout(2);  // a tracker without results must not stop the video

}  // namespace

VideoPlayer::VideoPlayer(ros::NodeHandle node, const VideoPlayerConfig& config)
    : config_(config),
      output_(node, config),
      pace_(config.speed),
      control_node_("~"),
      control_spinner_(1, &control_queue_) {
  options_.image_topic = config.image_topic;
  options_.camera_info_topic = config.camera_info_topic;
  options_.start = config.start;
  options_.folder_rate = config.fps;
  if (config.lockstep || config.hold) {
    homography_subscriber_ = node.subscribe<Homography>("homography", 10, [this](const HomographyConstPtr& result) {
      tracked_ = result->state != Homography::IDLE;
      if (tracked_) control_.releaseHold();
      answered_ = answered_ || result->header.stamp == awaited_;
    });
  }
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
  if (opened_) return;
  opened_ = true;
  if (!source_->hasRecordedStamps()) offset_ = ros::Duration(config_.first_stamp);
  output_.openResults();
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
  if (!control_.hasBegun()) {
    waitForSubscribers();
    control_.begin(config_.hold);
  }
  while (ros::ok()) {
    const std::size_t before = output_.published();
    playOnce();
    if (ros::ok() && output_.published() == before && !sought_) {
      throw SourceError("'" + config_.video + "' has no image after " + std::to_string(config_.start) + " s");
    }
    if (!told_notes_) tellNotes();
    told_notes_ = true;
    if (!config_.loop) break;
    if (!config_.restart_time) goes_on_ = last_ + ros::Duration(1.0 / source_->rate());
    open(0.0);
  }
  control_.end();
  tellState();
  ROS_INFO("played %zu images of '%s'%s", output_.published(), config_.video.c_str(),
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
  state.images = static_cast<std::uint32_t>(output_.published());
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
    // While nothing is tracked, so that a region can be selected in it.
    if (!tracked_ && homography_subscriber_) output_.repeat();
    ros::spinOnce();
    std::this_thread::sleep_for(kClockPeriod);
  }
  return true;
}

void VideoPlayer::tellNotes() const {
  for (const std::string& note : source_->notes()) ROS_WARN("'%s': %s", config_.video.c_str(), note.c_str());
  if (unanswered_ > 0) ROS_WARN("the tracker gave no result for %zu of %zu images", unanswered_, output_.published());
}

void VideoPlayer::waitForSubscribers() const {
  int waited = 0;
  for (; ros::ok(); ++waited) {
    const int subscribers = output_.subscribers();
    const bool tracker = !config_.lockstep || homography_subscriber_.getNumPublishers() > 0;
    const bool screen = !config_.wait_for_screen || state_publisher_.getNumSubscribers() > 0;
    if (subscribers >= config_.subscribers && tracker && screen) break;
    if (waited % 500 == 100) {
      ROS_INFO("waiting for subscribers of %s: %d of %d%s%s", output_.topic().c_str(), subscribers, config_.subscribers,
               tracker ? "" : ", and for a tracker", screen ? "" : ", and for a screen");
    }
    std::this_thread::sleep_for(kClockPeriod);
  }
  // Most subscribers of the images also subscribe to the intrinsics, and need them with the first image.
  const auto end = Clock::now() + kCameraInfoTimeout;
  while (ros::ok() && waited > 0 && !output_.isCameraInfoSubscribed() && Clock::now() < end) {
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
    if (goes_on_) offset_ += *goes_on_ - timeOf(*image);
    goes_on_.reset();
    last_ = timeOf(*image);
    if (first || rebase_) pace_.begin(last_, Clock::now());
    rebase_ = false;
    waitUntil(last_);
    const bool jumps_back = first && last_ < output_.time();
    output_.setTime(last_);
    if (jumps_back) {
      std::this_thread::sleep_for(kJumpPause);
      pace_.begin(last_, Clock::now());
    }
    position_ = static_cast<double>(image->frame) / source_->rate();
    if (image->error.empty()) {
      awaited_ = image->header.stamp + offset_;
      answered_ = false;
      output_.publish(*image, offset_, source_->hasRecordedStamps());
      sought_ = false;
      if (config_.lockstep) waitForResult(last_);
    } else {
      ROS_ERROR("image %zu is left out: %s", image->frame, image->error.c_str());
    }
    ros::spinOnce();
  }
}

void VideoPlayer::waitUntil(const ros::Time& time) {
  const auto due = pace_.due(time);
  for (auto next = Clock::now() + kClockPeriod; next < due && ros::ok(); next += kClockPeriod) {
    std::this_thread::sleep_until(next);
    output_.publishClock(pace_.at(next));
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
  const auto late = Clock::now() - pace_.due(time + ros::Duration(1.0 / source_->rate()));
  if (late > Clock::duration::zero()) pace_.delay(late);
}

}  // namespace laparoscope_servo
