#include "ros/recording/recorder.h"

#include <boost/make_shared.hpp>
#include <chrono>
#include <exception>
#include <filesystem>

#include "ros/common/clocks.h"
#include "ros/common/quiet_thread.h"
#include "ros/recording/session_facts.h"

namespace laparoscope_servo {

namespace {

constexpr double kLookPeriod = 1.0;        // s
constexpr std::uint32_t kQueue = 1000;     // messages of one topic in the subscriber's queue
constexpr std::uint32_t kImageQueue = 30;  // images in the subscriber's queue
constexpr double kMegabyte = 1e6;

}  // namespace

Recorder::Recorder(ros::NodeHandle node, ros::NodeHandle private_node, const RecorderConfig& config)
    : config_(config), node_(node), file_(config), diagnostics_(node, private_node, private_node.getNamespace()) {
  node.getParam("aesop/wire_log/file", wire_log_);
  const std::string image_topic = node.resolveName("image") + "/compressed";
  encoders_ = std::make_unique<ImageEncoders>(
      config.encoders, config.waiting_images, config.jpeg_quality,
      [this, image_topic](const sensor_msgs::CompressedImagePtr& image, const ros::Time& time) {
        add({image_topic, time, nullptr, sensor_msgs::CompressedImageConstPtr(image)});
      });
  thread_ = startQuietThread([this] { run(); });
  addSession();
  subscribers_.push_back(node.subscribe<sensor_msgs::Image>(
      "image", kImageQueue,
      [this](const sensor_msgs::ImageConstPtr& image) {
        const ros::Time now = ros::Time::now();
        if (!now.isZero()) encoders_->add(image, now);
      },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
  for (const std::string& topic : config.topics) subscribe(topic);
  diagnostics_.setHardwareID("none");
  diagnostics_.add("recording", this, &Recorder::diagnose);
  diagnostics_timer_ =
      node.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
}

Recorder::~Recorder() {
  subscribers_.clear();
  encoders_.reset();  // encodes the waiting images
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
  copyWireLog();
}

void Recorder::subscribe(const std::string& topic) {
  const std::string name = node_.resolveName(topic);
  ros::SubscribeOptions options;
  options.topic = name;
  options.queue_size = kQueue;
  options.md5sum = ros::message_traits::md5sum<topic_tools::ShapeShifter>();
  options.datatype = ros::message_traits::datatype<topic_tools::ShapeShifter>();
  using Event = ros::MessageEvent<topic_tools::ShapeShifter const>;
  options.helper = boost::make_shared<ros::SubscriptionCallbackHelperT<const Event&>>([this, name](const Event& event) {
    const ros::Time now = ros::Time::now();
    if (!now.isZero()) add({name, now, event.getConnectionHeaderPtr(), event.getConstMessage()});
  });
  subscribers_.push_back(node_.subscribe(options));
}

void Recorder::addSession() {
  const auto message = boost::make_shared<std_msgs::String>();
  XmlRpc::XmlRpcValue parameters;
  ros::param::get("/", parameters);
  message->data = sessionFacts(parameters);
  const auto header = boost::make_shared<ros::M_string>();
  (*header)["latching"] = "1";
  (*header)["callerid"] = ros::this_node::getName();
  (*header)["type"] = ros::message_traits::datatype<std_msgs::String>();
  (*header)["md5sum"] = ros::message_traits::md5sum<std_msgs::String>();
  (*header)["message_definition"] = ros::message_traits::definition<std_msgs::String>();
  ros::Time now = ros::Time::now();
  if (now.isZero()) now = ros::TIME_MIN;
  add({node_.resolveName("session"), now, header, std_msgs::StringConstPtr(message)});
}

void Recorder::add(Recorded recorded) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const double bytes = static_cast<double>(recorded.bytes());
    if (waiting_bytes_ + bytes > config_.waiting_data * kMegabyte) {
      ++told_.dropped;
      return;
    }
    waiting_bytes_ += bytes;
    waiting_.push_back(std::move(recorded));
  }
  changed_.notify_one();
}

void Recorder::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ends_ || !waiting_.empty()) {
    changed_.wait_for(lock, std::chrono::milliseconds(200), [this] { return ends_ || !waiting_.empty(); });
    std::deque<Recorded> batch;
    batch.swap(waiting_);
    lock.unlock();
    look(steadyNow());
    write(batch);
    lock.lock();
  }
  lock.unlock();
  try {
    file_.close();
  } catch (const std::exception& error) {
    ROS_ERROR_STREAM("recorder: " << error.what());
  }
}

// Checks the disk, and updates the figures for diagnostics.
void Recorder::look(double now) {
  if (now < next_look_) return;
  next_look_ = now + kLookPeriod;
  const std::string problem = file_.look();
  if (!problem.empty()) file_.close();  // closes it while there is still space for its index
  if (problem.empty() == stands_still_) {
    stands_still_ = !problem.empty();
    if (problem.empty()) ROS_INFO("recorder: it goes on");
    if (!problem.empty()) ROS_ERROR_STREAM("recorder: nothing is recorded: " << problem);
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  told_.problem = problem;
  told_.free = file_.freeMegabytes();
  told_.file = file_.name();
  told_.files = file_.files();
  told_.bytes = file_.bytes();
}

void Recorder::write(std::deque<Recorded>& batch) {
  for (const Recorded& recorded : batch) {
    std::string problem = file_.problem();
    if (problem.empty()) {
      try {
        file_.write(recorded);
      } catch (const std::exception& error) {
        problem = error.what();
        ROS_ERROR_STREAM_THROTTLE(5.0, "recorder: " << problem);
      }
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_bytes_ -= static_cast<double>(recorded.bytes());
    ++(problem.empty() ? told_.written : told_.unwritten);
    if (!problem.empty()) told_.problem = problem;
  }
}

void Recorder::diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const ImageEncoders::Counts images = encoders_->counts();
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::uint64_t dropped = told_.dropped + told_.unwritten + images.dropped;
  if (!told_.problem.empty()) {
    status.summary(DiagnosticStatus::ERROR, "nothing is recorded: " + told_.problem);
  } else if (images.refused > 0) {
    status.summary(DiagnosticStatus::WARN, "images that cannot be recorded: " + images.refusal);
  } else if (dropped > 0) {
    status.summary(DiagnosticStatus::WARN, "something was dropped");
  } else {
    status.summary(DiagnosticStatus::OK, "recording");
  }
  status.add("file", told_.file);
  status.add("files", told_.files);
  status.addf("written [MB]", "%.1f", static_cast<double>(told_.bytes) / kMegabyte);
  status.addf("free on the disk [MB]", "%.0f", told_.free);
  status.addf("waiting for the disk [MB]", "%.1f", waiting_bytes_ / kMegabyte);
  status.addf("last encoding [ms]", "%.1f", 1e3 * images.time);
  status.add("messages written", told_.written);
  status.add("images dropped: no encoder was free", images.dropped);
  status.add("messages dropped: the disk was too slow", told_.dropped);
  status.add("messages not written", told_.unwritten);
  status.add("images that cannot be encoded", images.refused);
}

void Recorder::copyWireLog() const {
  if (wire_log_.empty() || file_.name().empty()) return;
  std::error_code error;
  for (const std::string& name : {wire_log_, wire_log_ + ".1"}) {
    if (!std::filesystem::exists(name, error)) continue;
    const std::string target = file_.name() + ".wire" + name.substr(wire_log_.size());
    std::filesystem::copy_file(name, target, std::filesystem::copy_options::overwrite_existing, error);
    if (error) ROS_ERROR_STREAM("recorder: '" << name << "' cannot be copied: " << error.message());
  }
}

}  // namespace laparoscope_servo
