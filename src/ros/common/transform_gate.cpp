#include "ros/common/transform_gate.h"

#include <Eigen/Core>
#include <cmath>
#include <utility>

#include "ros/common/eigen_messages.h"
#include "ros/common/input_owner.h"

namespace laparoscope_servo {

namespace {

constexpr std::size_t kMostFrames = 1000;  // an arm has ten
constexpr double kFarthest = 1000.0;       // m: larger than any distance in a room
constexpr double kRotationError = 1e-3;    // tolerance of a quaternion's length: published ones are rounded, not scaled
constexpr double kSilent = 2.0;            // s: after this time of silence another publisher may take over a frame
constexpr double kTold = 2.0;              // s, for which another publisher is reported
constexpr double kStill = 1e-6;            // m, and tolerance of a quaternion's elements, for equal transforms

std::string stripped(const std::string& frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

Eigen::Vector4d rotation(const geometry_msgs::Transform& t) {
  return {t.rotation.x, t.rotation.y, t.rotation.z, t.rotation.w};
}

bool isSame(const geometry_msgs::TransformStamped& a, const geometry_msgs::TransformStamped& b) {
  if (a.header.frame_id != b.header.frame_id) return false;
  if (!(fromMessage(a.transform.translation) - fromMessage(b.transform.translation)).isZero(kStill)) return false;
  const Eigen::Vector4d p = rotation(a.transform), q = rotation(b.transform);
  return (p - q).isZero(kStill) || (p + q).isZero(kStill);
}

}  // namespace

TransformGate::TransformGate(const TransformGateConfig& config) : config_(config) {
  for (std::string& frame : config_.frames) frame = stripped(frame);
  rebuild();
  findFramesInUse();
}

void TransformGate::use(const std::string& frame) {
  if (isInUse(stripped(frame)) || config_.frames.size() >= kMostFrames) return;
  config_.frames.push_back(stripped(frame));
  findFramesInUse();
}

void TransformGate::take(const Transforms& transforms, const std::string& sender, const Connection& connection,
                         bool is_static, const ros::Time& now, double steady_now) {
  Frame news;
  news.is_static = is_static;
  news.sender = sender;
  news.connection = connection;
  news.heard = steady_now;
  for (const geometry_msgs::TransformStamped& transform : transforms) takeOne(transform, news, now);
}

void TransformGate::takeOne(const geometry_msgs::TransformStamped& transform, const Frame& origin,
                            const ros::Time& now) {
  Frame news = origin;
  news.transform = transform;
  std::string& child = news.transform.child_frame_id;
  std::string& parent = news.transform.header.frame_id;
  child = stripped(child);
  parent = stripped(parent);
  if (!config_.owner.empty() && news.sender != config_.owner) {
    if (isInUse(child)) complain(news, false);
    return;
  }
  auto known = frames_.find(child);
  if (known != frames_.end() && mayReplace(known->second, news)) {
    frames_.erase(known);
    rebuild();
    known = frames_.end();
  }
  const bool is_known = known != frames_.end();
  if (is_known && known->second.connection.lock() != news.connection.lock()) {
    if (!isInUse(child)) return;
    complain(news, true);
    if (news.is_static) waiting_[child] = news;
    return;
  }
  std::string wrong = nonsense(news, now);
  if (wrong.empty() && is_known && known->second.transform.header.frame_id != parent) {
    wrong = "has two parents, " + known->second.transform.header.frame_id + " and " + parent;
  }
  if (wrong.empty() && is_known && known->second.is_static != news.is_static) wrong = "is static, and moves";
  if (!wrong.empty()) {
    ++refused_;
    if (isInUse(child)) nonsense_[child] = "tf frame " + child + ' ' + wrong;
    return;
  }
  nonsense_.erase(child);
  if (news.is_static ? takesStatic(news) : !is_known || takesStamp(known->second, news)) believe(news);
}

// Whether the frame's connection is gone, or it is silent while not engaged.
bool TransformGate::mayReplace(const Frame& known, const Frame& news) const {
  const auto connection = known.connection.lock();
  if (!connection) return true;
  return connection != news.connection.lock() && !engaged_ && !known.is_static && news.heard - known.heard > kSilent;
}

std::string TransformGate::nonsense(const Frame& news, const ros::Time& now) const {
  const geometry_msgs::TransformStamped& t = news.transform;
  if (t.header.frame_id.empty() || t.header.frame_id == t.child_frame_id) return "has no parent";
  if (!fromMessage(t.transform.translation).allFinite() || !rotation(t.transform).allFinite()) return "is not finite";
  if (!(fromMessage(t.transform.translation).norm() <= kFarthest)) return "is further away than anything in a room";
  if (!(std::abs(rotation(t.transform).norm() - 1.0) <= kRotationError)) {
    return "has a rotation that is none: its quaternion is not of length 1";
  }
  if (news.is_static) return "";
  if (t.header.stamp.isZero()) return "moves, and has no stamp";
  if (t.header.stamp.toSec() - now.toSec() > config_.max_ahead) {
    return "is stamped in the future, compare the clocks of the machines";
  }
  return "";
}

bool TransformGate::takesStamp(const Frame& known, const Frame& news) {
  const ros::Time& last = known.transform.header.stamp;
  const ros::Time& stamp = news.transform.header.stamp;
  if (stamp > last) return true;
  if (stamp == last && isSame(known.transform, news.transform)) return false;  // a repetition
  ++refused_;
  // Earlier stamps are accepted only after a silence and while not engaged: a recording has then begun again.
  if (engaged_ || !(news.heard - known.heard > kSilent)) return false;
  clear();
  return true;
}

bool TransformGate::takesStatic(const Frame& news) {
  const std::string& child = news.transform.child_frame_id;
  const auto known = known_static_.find(child);
  const bool is_changed = known != known_static_.end() && !isSame(known->second, news.transform);
  if (is_changed && isInUse(child)) changed_ = child;
  if (!is_changed || !engaged_) return true;
  ++refused_;
  waiting_[child] = news;
  return false;
}

void TransformGate::believe(const Frame& news) {
  const std::string& child = news.transform.child_frame_id;
  const auto known = frames_.find(child);
  const bool is_new = known == frames_.end();
  if (is_new && frames_.size() >= kMostFrames) {
    ++refused_;
    return;
  }
  if (!news.is_static && engaged_ && known_static_.count(child) != 0) {  // the frame was static at engaging
    ++refused_;
    changed_ = child;
    return;
  }
  if (news.is_static) {
    if (known_static_.size() < kMostFrames || known_static_.count(child) != 0) known_static_[child] = news.transform;
    waiting_.erase(child);
  } else {
    known_static_.erase(child);
  }
  frames_[child] = news;
  buffer_->setTransform(news.transform, news.sender, news.is_static);
  if (is_new) findFramesInUse();
}

void TransformGate::step(bool engaged, const ros::Time& now, double steady_now) {
  engaged_ = engaged;
  bool is_gone = false;
  for (auto frame = frames_.begin(); frame != frames_.end();) {
    const bool expired = frame->second.connection.expired();
    is_gone = is_gone || expired;
    frame = expired ? frames_.erase(frame) : std::next(frame);
  }
  if (is_gone) rebuild();
  if (!engaged_) takeWaiting(now, steady_now);
}

void TransformGate::takeWaiting(const ros::Time& now, double steady_now) {
  for (auto waiting = waiting_.begin(); waiting != waiting_.end();) {
    Frame news = waiting->second;
    news.heard = steady_now;
    const auto known = frames_.find(waiting->first);
    const bool is_due = known == frames_.end() || known->second.connection.lock() == news.connection.lock() ||
                        mayReplace(known->second, news);
    if (!is_due && !news.connection.expired()) {
      ++waiting;
      continue;
    }
    waiting = waiting_.erase(waiting);
    if (!news.connection.expired()) takeOne(news.transform, news, now);
  }
}

void TransformGate::clear() {
  for (auto frame = frames_.begin(); frame != frames_.end();) {
    frame = frame->second.is_static ? std::next(frame) : frames_.erase(frame);
  }
  rebuild();
}

// Static transforms cannot be removed from a tf2 buffer, so a new buffer is built.
void TransformGate::rebuild() {
  buffer_ = std::make_shared<tf2::BufferCore>();
  for (const auto& frame : frames_) {
    buffer_->setTransform(frame.second.transform, frame.second.sender, frame.second.is_static);
  }
}

void TransformGate::findFramesInUse() {
  in_use_.clear();
  for (std::string frame : config_.frames) {
    while (in_use_.insert(frame).second) {
      const auto known = frames_.find(frame);
      if (known == frames_.end()) break;
      frame = known->second.transform.header.frame_id;
    }
  }
}

void TransformGate::complain(const Frame& news, bool is_doubtful) {
  ++strange_;
  Stranger& stranger = strangers_[news.transform.child_frame_id];
  if (stranger.name != news.sender) stranger.name = news.sender;
  stranger.connection = news.connection;
  stranger.is_static = news.is_static;
  stranger.is_doubtful = is_doubtful;
  stranger.at = news.heard;
}

// A static transform is sent once but stays in the buffers of other listeners, so it is reported while its connection
// is open.
bool TransformGate::isTold(const Stranger& stranger, double steady_now) const {
  return stranger.is_static ? !stranger.connection.expired() : steady_now - stranger.at <= kTold;
}

std::string TransformGate::text(const std::string& frame, const Stranger& stranger) const {
  const std::string begin = "tf frame " + frame + " of " + shownName(stranger.name) + " is refused, ";
  if (!stranger.is_doubtful)
    return begin + "only that of " + config_.owner + " counts (parameter " + config_.parameter + ')';
  const auto known = frames_.find(frame);
  const std::string other = known == frames_.end() ? "another" : shownName(known->second.sender);
  if (!config_.owner.empty()) return begin + "another process of this name publishes it, too";
  return begin + other + " publishes it, too: name the one that counts (parameter " + config_.parameter + ')';
}

std::string TransformGate::problem(double steady_now) const {
  for (const auto& nonsense : nonsense_) {
    if (isInUse(nonsense.first)) return nonsense.second;
  }
  for (const auto& stranger : strangers_) {
    if (stranger.second.is_doubtful && isTold(stranger.second, steady_now)) {
      return text(stranger.first, stranger.second);
    }
  }
  return "";
}

std::string TransformGate::complaint(double steady_now) const {
  for (const auto& stranger : strangers_) {
    if (isTold(stranger.second, steady_now)) return text(stranger.first, stranger.second);
  }
  return "";
}

std::string TransformGate::takeChangedFrame() {
  return std::exchange(changed_, {});
}

}  // namespace laparoscope_servo
