// Decides which transforms from the network are accepted.
//
// Each frame has one publisher: the node named by the configuration, or, if none is named, the first one to publish the
// frame; and one connection of it, while that is open. Transforms of other publishers are refused and reported. So are
// impossible ones: non-finite numbers, invalid rotations, a frame with two parents, a frame that is both static and
// moving, stamps in the future, stamps that go back or that do not change while the content does.
//
// Static transforms are valid while their connection is open. While engaged they may not change: a new one is reported
// and waits until the controller is not engaged. No clock, no thread; time is an argument.
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>
#include <tf2/buffer_core.h>

#include <boost/shared_ptr.hpp>
#include <boost/weak_ptr.hpp>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace laparoscope_servo {

struct TransformGateConfig {
  std::string owner;                // full name of the node that publishes them; empty: the first publisher
  std::string parameter;            // name of the parameter that holds the owner, for texts
  std::vector<std::string> frames;  // frames in use, with all between them and the root
  double max_ahead = 0.25;          // s, by which a stamp may be ahead of ROS time
};

class TransformGate {
 public:
  // Identifies a connection by any object that exists once for it and is destroyed with it.
  using Connection = boost::shared_ptr<const void>;
  using Transforms = std::vector<geometry_msgs::TransformStamped>;

  explicit TransformGate(const TransformGateConfig& config);

  // `sender`: node name of the connection; `now`: ROS time; `steady_now`: s.
  void take(const Transforms& transforms, const std::string& sender, const Connection& connection, bool is_static,
            const ros::Time& now, double steady_now);

  // Call in every step: removes transforms of connections that are closed.
  void step(bool engaged, const ros::Time& now, double steady_now);

  // Call when ROS time jumped back: keeps only static transforms.
  void clear();

  // Marks `frame` as in use.
  void use(const std::string& frame);

  // The accepted transforms. A new object replaces it when transforms are removed, so get it for each use.
  std::shared_ptr<const tf2::BufferCore> buffer() const { return buffer_; }

  // Why the accepted transforms must not be used: the last transform of a frame in use was invalid, or it is undecided
  // which of two publishers is right. Empty: they may be used.
  std::string problem(double steady_now) const;
  // Which other nodes publish frames in use; empty: none.
  std::string complaint(double steady_now) const;
  // A static frame in use that has changed; returned once; empty: none.
  std::string takeChangedFrame();

  // Numbers of refused transforms since the start: of other nodes, for frames in use; and of the owner.
  std::uint64_t strange() const { return strange_; }
  std::uint64_t refused() const { return refused_; }

 private:
  struct Frame {
    geometry_msgs::TransformStamped transform;
    bool is_static = false;
    std::string sender;
    boost::weak_ptr<const void> connection;
    double heard = 0.0;  // s, steady
  };
  struct Stranger {
    std::string name;
    boost::weak_ptr<const void> connection;
    bool is_static = false;
    // it is undecided whether this publisher or the present one is right
    bool is_doubtful = false;
    double at = -std::numeric_limits<double>::infinity();  // s, steady
  };

  void takeOne(const geometry_msgs::TransformStamped& transform, const Frame& origin, const ros::Time& now);
  bool mayReplace(const Frame& known, const Frame& news) const;
  std::string nonsense(const Frame& news, const ros::Time& now) const;
  bool takesStamp(const Frame& known, const Frame& news);
  bool takesStatic(const Frame& news);
  void takeWaiting(const ros::Time& now, double steady_now);
  void believe(const Frame& news);
  void complain(const Frame& news, bool is_doubtful);
  bool isTold(const Stranger& stranger, double steady_now) const;
  std::string text(const std::string& frame, const Stranger& stranger) const;
  void rebuild();
  void findFramesInUse();
  bool isInUse(const std::string& frame) const { return in_use_.count(frame) != 0; }

  TransformGateConfig config_;
  std::shared_ptr<tf2::BufferCore> buffer_;
  bool engaged_ = false;
  std::map<std::string, Frame> frames_;                                  // by the child's name
  std::map<std::string, geometry_msgs::TransformStamped> known_static_;  // also those of closed connections
  std::map<std::string, Frame> waiting_;                                 // new static transforms, until not engaged
  std::map<std::string, std::string> nonsense_;                          // error texts of frames in use
  // the latest other publisher of each frame in use
  std::map<std::string, Stranger> strangers_;
  std::set<std::string> in_use_;
  std::string changed_;
  std::uint64_t strange_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace laparoscope_servo
