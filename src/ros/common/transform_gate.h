// Decides which transforms that come over the network are believed.
//
// Each frame has one publisher: the node that the configuration names, or, where it names none, the one that was first
// to publish the frame; and of it one connection, as long as that lives. What anybody else says of a frame is left out
// and told. So is what cannot be: numbers that are not finite, rotations that are none, a frame with two parents, one
// that is static and moving, stamps from the future, stamps that go back or that stand while the content changes.
//
// Static transforms last as long as the connection that brought them. While engaged they may not change: another one
// is told and waits until nobody is engaged. Plain logic: no clock, no thread; time is an argument.
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
  std::string owner;                // the one node that publishes them, its full name; empty: whoever is the first
  std::string parameter;            // that names it, for what is told
  std::vector<std::string> frames;  // in use: these, and all between them and the root
  double max_ahead = 0.25;          // s, of a stamp to ROS time
};

class TransformGate {
 public:
  // Anything of which there is one object per connection, which dies with it.
  using Connection = boost::shared_ptr<const void>;
  using Transforms = std::vector<geometry_msgs::TransformStamped>;

  explicit TransformGate(const TransformGateConfig& config);

  // `sender`: the name that came with the connection; `now`: ROS time; `steady_now`: s.
  void take(const Transforms& transforms, const std::string& sender, const Connection& connection, bool is_static,
            const ros::Time& now, double steady_now);

  // To be called in every step of whoever relies on it: forgets what came over connections that are gone.
  void step(bool engaged, const ros::Time& now, double steady_now);

  // ROS time jumped back: only what is static holds.
  void clear();

  // `frame` is in use from now on.
  void use(const std::string& frame);

  // What is believed. Another object after something was forgotten: ask again each time.
  std::shared_ptr<const tf2::BufferCore> buffer() const { return buffer_; }

  // Why what is believed must not be relied on: the newest word about a frame in use was nonsense, or nobody can tell
  // which of two publishers is right. Empty: nothing.
  std::string problem(double steady_now) const;
  // Who else publishes frames in use; empty: nobody.
  std::string complaint(double steady_now) const;
  // A static frame in use that is another one than it was, once; empty: none.
  std::string takeChangedFrame();

  // Transforms since the start: of others than the owner, about frames in use; and what was not believed of the
  // owner's.
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
    bool is_doubtful = false;                              // nobody can tell whether this one is right or the other
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
  std::map<std::string, geometry_msgs::TransformStamped> known_static_;  // also of connections that are gone
  std::map<std::string, Frame> waiting_;                                 // static, until they may be taken
  std::map<std::string, std::string> nonsense_;                          // in words, of frames in use
  std::map<std::string, Stranger> strangers_;                            // the latest, of each frame in use
  std::set<std::string> in_use_;
  std::string changed_;
  std::uint64_t strange_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace laparoscope_servo
