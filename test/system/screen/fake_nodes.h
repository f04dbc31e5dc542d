// Tracker, controller and robot that say what a test wants them to say, and keep what the screen asks of them. Their
// callbacks run in the threads of an AsyncSpinner.
#pragma once

#include <laparoscope_servo/CheckRoi.h>
#include <laparoscope_servo/ControllerState.h>
#include <laparoscope_servo/FreezeImage.h>
#include <laparoscope_servo/Homography.h>
#include <laparoscope_servo/ListViews.h>
#include <laparoscope_servo/OperatingState.h>
#include <laparoscope_servo/ScopeVelocity.h>
#include <laparoscope_servo/SelectFeatures.h>
#include <laparoscope_servo/SelectRoi.h>
#include <laparoscope_servo/SelectTask.h>
#include <laparoscope_servo/StoredView.h>
#include <laparoscope_servo/TrackerState.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Empty.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <limits>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace laparoscope_servo::test_support {

class FakeNodes {
 public:
  // `space`: the namespace of the cart.
  explicit FakeNodes(const std::string& space = "") : node_(space) {
    tracker_.state = TrackerState::IDLE;
    tracker_.reason = "no region of interest selected";
    tracker_.width = 1280;
    tracker_.height = 720;
    controller_.state = ControllerState::IDLE;
    controller_.task = ControllerState::HOLD_VIEW;
    controller_.reason = "not engaged";
    robot_.state = "DISABLED";
    robot_.reason = "not enabled yet";
    thread_ = std::thread([this] { run(); });
  }
  ~FakeNodes() {
    ends_ = true;
    thread_.join();
  }

  template <class Change>
  void change(const Change& change) {
    const std::lock_guard<std::mutex> lock(mutex_);
    change(tracker_, controller_, robot_);
    changed_ = true;
  }
  void runCamera(bool runs) { camera_runs_ = runs; }
  // Of a service: "enable", "engage", "freeze", "region". Closed: its calls are answered only as far as they are
  // admitted.
  void close(const std::string& service) { setGate(service, 0); }
  void admit(const std::string& service, int calls) { setGate(service, calls); }
  void open(const std::string& service) { setGate(service, std::numeric_limits<int>::max()); }

  std::vector<sensor_msgs::RegionOfInterest> regions() const { return get(regions_); }
  std::vector<sensor_msgs::RegionOfInterest> frozenRegions() const { return get(frozen_regions_); }
  std::vector<std::string> stored() const { return get(stored_); }
  std::vector<std::string> recalled() const { return get(recalled_); }
  std::vector<std::string> tasks() const { return get(tasks_); }
  std::vector<std::string> keptViews() const { return get(kept_views_); }
  void refuseTasks(bool refuses) { refuses_tasks_ = refuses; }
  std::vector<bool> deadMan() const { return get(dead_man_words_); }
  std::vector<ScopeVelocity> manual() const { return get(manual_commands_); }
  void forget() {
    const std::lock_guard<std::mutex> lock(mutex_);
    regions_.clear();
    frozen_regions_.clear();
    stored_.clear();
    recalled_.clear();
    tasks_.clear();
    kept_views_.clear();
    checks = 0;
    dead_man_words_.clear();
    manual_commands_.clear();
    robot_stops = controller_stops = disables = disengages = enables = engages = freezes = freezes_answered = 0;
  }
  bool connected() const {
    return preview_.getNumSubscribers() > 0 && states_.getNumSubscribers() > 0 && command_.getNumSubscribers() > 0 &&
           robot_stop_.getNumPublishers() > 0 && controller_stop_.getNumPublishers() > 0 &&
           dead_man_.getNumPublishers() > 0 && manual_.getNumPublishers() > 0;
  }

  std::atomic<int> robot_stops{0}, controller_stops{0}, disables{0}, disengages{0}, enables{0}, checks{0}, freezes{0},
      freezes_answered{0}, engages{0};

 private:
  template <class Value>
  Value get(const Value& value) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return value;
  }
  void setGate(const std::string& service, int calls) {
    const std::lock_guard<std::mutex> lock(mutex_);
    gates_[service] = calls;
  }
  // Blocks a service's thread.
  void pass(const std::string& service) {
    const auto admitted = [&] {
      const std::lock_guard<std::mutex> lock(mutex_);
      const auto gate = gates_.find(service);
      if (gate != gates_.end() && gate->second == 0) return false;
      if (gate != gates_.end()) --gate->second;
      return true;
    };
    while (!admitted() && !ends_ && ros::ok()) ros::WallDuration(0.01).sleep();
  }
  template <class Message, class Value>
  ros::Subscriber keep(const std::string& topic, std::vector<Value>& kept, Value (*of)(const Message&)) {
    return node_.subscribe<Message>(topic, 1000, [this, &kept, of](const boost::shared_ptr<const Message>& message) {
      const std::lock_guard<std::mutex> lock(mutex_);
      kept.push_back(of(*message));
    });
  }
  ros::ServiceServer trigger(const std::string& name, const std::function<void()>& act) {
    return node_.advertiseService<std_srvs::Trigger::Request, std_srvs::Trigger::Response>(
        name, [act](std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
          act();
          response.success = 1;
          return true;
        });
  }

  void run() {
    int turn = 0;
    for (ros::WallRate rate(25.0); !ends_ && ros::ok(); rate.sleep()) {
      const std::lock_guard<std::mutex> lock(mutex_);
      const ros::Time now = ros::Time::now();
      if (camera_runs_) preview(now, ++turn);
      command_.publish(ScopeVelocity());
      robot_.header.stamp = now;
      operating_.publish(robot_);
      if (changed_.exchange(false) || turn % 25 == 0) {
        states_.publish(tracker_);
        controller_states_.publish(controller_);
      }
    }
  }

  void preview(const ros::Time& stamp, int turn) {
    Homography homography;
    homography.header.stamp = stamp;
    homography.state = Homography::IDLE;
    homographies_.publish(homography);
    preview_.publish(picture(stamp, turn));
  }
  static sensor_msgs::Image picture(const ros::Time& stamp, int turn) {
    sensor_msgs::Image image;
    image.header.stamp = stamp;
    image.width = 640;
    image.height = 360;
    image.encoding = "bgr8";
    image.step = 3 * image.width;
    image.data.resize(std::size_t{image.step} * image.height);
    for (std::size_t k = 0; k < image.data.size(); k += 3) {
      image.data[k] = 60;
      image.data[k + 1] = static_cast<std::uint8_t>(70 + turn % 8);
      image.data[k + 2] = 180;
    }
    return image;
  }

  ros::NodeHandle node_;
  mutable std::mutex mutex_;
  TrackerState tracker_;
  ControllerState controller_;
  OperatingState robot_;
  std::atomic<bool> changed_{true}, camera_runs_{true}, refuses_tasks_{false}, ends_{false};
  std::vector<sensor_msgs::RegionOfInterest> regions_, frozen_regions_;
  std::vector<std::string> stored_, recalled_, tasks_, kept_views_;
  std::map<std::string, int> gates_;  // calls that are still admitted
  std::vector<bool> dead_man_words_;
  std::vector<ScopeVelocity> manual_commands_;

  ros::Publisher preview_ = node_.advertise<sensor_msgs::Image>("tracker/preview", 2);
  ros::Publisher homographies_ = node_.advertise<Homography>("tracker/homography", 10);
  ros::Publisher states_ = node_.advertise<TrackerState>("tracker/state", 10, true);
  ros::Publisher controller_states_ = node_.advertise<ControllerState>("controller/state", 10, true);
  ros::Publisher command_ = node_.advertise<ScopeVelocity>("servo_command", 10);
  ros::Publisher operating_ = node_.advertise<OperatingState>("aesop/operating_state", 10, true);
  ros::Subscriber robot_stop_ =
      node_.subscribe<std_msgs::Empty>("aesop/stop", 100, [this](const std_msgs::EmptyConstPtr&) { ++robot_stops; });
  ros::Subscriber controller_stop_ = node_.subscribe<std_msgs::Empty>(
      "controller/stop", 100, [this](const std_msgs::EmptyConstPtr&) { ++controller_stops; });
  ros::Subscriber dead_man_ = keep<std_msgs::Bool, bool>("dead_man", dead_man_words_,
                                                         [](const std_msgs::Bool& word) { return word.data != 0; });
  ros::Subscriber manual_ = keep<ScopeVelocity, ScopeVelocity>("controller/manual", manual_commands_,
                                                               [](const ScopeVelocity& command) { return command; });
  ros::ServiceServer enable_ = trigger("aesop/enable", [this] {
    ++enables;
    pass("enable");
  });
  ros::ServiceServer disable_ = trigger("aesop/disable", [this] { ++disables; });
  ros::ServiceServer engage_ = node_.advertiseService<std_srvs::SetBool::Request, std_srvs::SetBool::Response>(
      "controller/engage", [this](std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
        ++(request.data == 0 ? disengages : engages);
        if (request.data != 0) pass("engage");
        response.success = 1;
        return true;
      });
  ros::ServiceServer select_task_ = node_.advertiseService<SelectTask::Request, SelectTask::Response>(
      "controller/select_task", [this](SelectTask::Request& request, SelectTask::Response& response) {
        const std::lock_guard<std::mutex> lock(mutex_);
        tasks_.push_back(request.task);
        response.success = static_cast<std::uint8_t>(!refuses_tasks_);
        if (refuses_tasks_) response.message = "no task '" + request.task + "' here";
        if (!refuses_tasks_) controller_.task = request.task;
        changed_ = true;
        return true;
      });
  ros::ServiceServer keep_view_ = node_.advertiseService<SelectFeatures::Request, SelectFeatures::Response>(
      "motion/select_features", [this](SelectFeatures::Request& request, SelectFeatures::Response& response) {
        const std::lock_guard<std::mutex> lock(mutex_);
        kept_views_.push_back(request.selection);
        response.success = 1;
        return true;
      });
  // Takes what is 100 px wide or more; otherwise 100 px would do.
  ros::ServiceServer select_ = node_.advertiseService<SelectRoi::Request, SelectRoi::Response>(
      "tracker/select_roi", [this](SelectRoi::Request& request, SelectRoi::Response& response) {
        {
          const std::lock_guard<std::mutex> lock(mutex_);
          regions_.push_back(request.roi);
        }
        pass("region");
        response.success = static_cast<std::uint8_t>(request.roi.width >= 100);
        return true;
      });
  ros::ServiceServer check_ = node_.advertiseService<CheckRoi::Request, CheckRoi::Response>(
      "tracker/check_roi", [this](CheckRoi::Request& request, CheckRoi::Response& response) {
        ++checks;
        response.success = static_cast<std::uint8_t>(request.roi.width >= 100);
        if (response.success) return true;
        response.message = "ROI is too small, expected at least 100 px";
        response.proposal = request.roi;
        response.proposal.width = 100;
        return true;
      });
  ros::ServiceServer freeze_ = node_.advertiseService<FreezeImage::Request, FreezeImage::Response>(
      "tracker/freeze_image", [this](FreezeImage::Request&, FreezeImage::Response& response) {
        ++freezes;
        pass("freeze");
        ++freezes_answered;
        response.success = 1;
        response.preview = picture(ros::Time(5.0), 3);
        response.width = 1280;
        response.height = 720;
        return true;
      });
  ros::ServiceServer select_frozen_ = node_.advertiseService<CheckRoi::Request, CheckRoi::Response>(
      "tracker/select_frozen_roi", [this](CheckRoi::Request& request, CheckRoi::Response& response) {
        const std::lock_guard<std::mutex> lock(mutex_);
        frozen_regions_.push_back(request.roi);
        response.success = static_cast<std::uint8_t>(request.stamp == ros::Time(5.0));
        return true;
      });
  ros::ServiceServer view(const std::string& name, std::vector<std::string>& names) {
    return node_.advertiseService<StoredView::Request, StoredView::Response>(
        name, [this, &names](StoredView::Request& request, StoredView::Response& response) {
          const std::lock_guard<std::mutex> lock(mutex_);
          names.push_back(request.name);
          response.success = 1;
          return true;
        });
  }
  ros::ServiceServer store_ = view("tracker/store_view", stored_);
  ros::ServiceServer recall_ = view("tracker/recall_view", recalled_);
  ros::ServiceServer list_ = node_.advertiseService<ListViews::Request, ListViews::Response>(
      "tracker/list_views", [this](ListViews::Request& request, ListViews::Response& response) {
        for (const std::string& name : stored()) {
          StoredViewInfo info;
          info.name = name;
          info.width = 1280;
          info.height = 720;
          if (request.thumbnails) info.thumbnail = picture(ros::Time(1.0), 1);
          response.views.push_back(info);
        }
        return true;
      });
  std::thread thread_;
};

}  // namespace laparoscope_servo::test_support
