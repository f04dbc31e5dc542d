// Stands in for the tf of the robot's node: base -> end_effector moves, at 40 Hz from a thread of its own; the scope on
// it, the camera and the insertion point are static. Tests make it tell nonsense.
#pragma once

#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace laparoscope_servo {

inline geometry_msgs::TransformStamped fakeTransform(const std::string& parent, const std::string& child, double z) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.header.stamp = ros::Time::now();
  transform.transform.translation.z = z;
  transform.transform.rotation.w = 1.0;
  return transform;
}

class FakeScope {
 public:
  using Change = std::function<void(geometry_msgs::TransformStamped&, int step)>;

  FakeScope() {
    makeStatic({});
    thread_ = std::thread([this] {
      for (int step = 0; !end_; ++step) {
        publish(step);
        std::this_thread::sleep_for(std::chrono::milliseconds(25));
      }
    });
  }
  ~FakeScope() { end(); }

  void end() {
    end_ = true;
    if (thread_.joinable()) thread_.join();
  }

  // What is done to the moving transform before it is sent; false in `speak`: nothing is sent.
  void change(const Change& change, bool speak = true) {
    const std::lock_guard<std::mutex> lock(mutex_);
    change_ = change;
    speak_ = speak;
  }

  // Sends the static ones anew, the one of this child changed.
  void makeStatic(const std::function<void(geometry_msgs::TransformStamped&)>& change, const std::string& child = "") {
    // d2 is 0.1 m: the camera is at the base's origin, the insertion point behind it.
    std::vector<geometry_msgs::TransformStamped> all{fakeTransform("end_effector", "scope_tip", 0.3),
                                                     fakeTransform("scope_tip", "laparoscope_optical", 0.0),
                                                     fakeTransform("aesop_base", "insertion_point", -0.1)};
    all.back().transform.rotation.x = 1.0;  // its z axis points out of the body
    all.back().transform.rotation.w = 0.0;
    for (geometry_msgs::TransformStamped& transform : all) {
      if (transform.child_frame_id == child) change(transform);
    }
    static_broadcaster_.sendTransform(all);
  }

 private:
  void publish(int step) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!speak_) return;
    geometry_msgs::TransformStamped moving = fakeTransform("aesop_base", "end_effector", -0.3);
    if (change_) change_(moving, step);
    broadcaster_.sendTransform(moving);
  }

  tf2_ros::TransformBroadcaster broadcaster_;
  tf2_ros::StaticTransformBroadcaster static_broadcaster_;
  std::mutex mutex_;
  Change change_;
  bool speak_ = true;
  std::atomic<bool> end_{false};
  std::thread thread_;
};

// What becomes of a transform that is wrong by as much.
inline void shift(geometry_msgs::TransformStamped& transform, double x, double y, double z) {
  transform.transform.translation.x += x;
  transform.transform.translation.y += y;
  transform.transform.translation.z += z;
}

inline void turn(geometry_msgs::TransformStamped& transform, double angle) {
  auto& q = transform.transform.rotation;
  const double c = std::cos(0.5 * angle), s = std::sin(0.5 * angle);  // about its own y axis
  const auto p = q;
  q.w = p.w * c - p.y * s;
  q.x = p.x * c - p.z * s;
  q.y = p.y * c + p.w * s;
  q.z = p.z * c + p.x * s;
}

}  // namespace laparoscope_servo
