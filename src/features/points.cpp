#include "laparoscope_servo/features/points.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

#include "features/points/point_flow.h"
#include "features/points/point_image.h"
#include "features/points/point_motion.h"
#include "features/points/point_selection.h"
#include "features/points/tracked_point.h"
#include "laparoscope_servo/features/image_sequence.h"
#include "laparoscope_servo/features/tracked_feature.h"
#include "laparoscope_servo/image/image_type.h"
#include "laparoscope_servo/validation/error_report.h"

namespace laparoscope_servo::features {

namespace {

// Of the range of the search, standard deviation of a motion on which those that were found agree.
constexpr double kStray = 0.25;
constexpr int kSearches = 12;  // points that are looked for in one image, in turn

const PointsConfig& checked(const PointsConfig& config) {
  validation::throwErrors("points", validate(config));
  return config;
}

// Of the window that is followed from image to image: a smaller one than that which is compared with the first view.
int flowHalf(const PointsConfig& config) {
  return std::max(3, config.window / 3);
}

}  // namespace

class PointTracker::Implementation {
 public:
  explicit Implementation(const PointsConfig& config)
      : config_(checked(config)), comparer_(config), flow_(flowHalf(config)), shift_(config.window) {}

  const PointsResult& select(const cv::Mat& image, double stamp, const std::vector<PointGroup>& groups) {
    image::checkImage(image, stamp);
    PointImage now;
    now.take(image, config_.levels, config_.saturation);
    PointChoice choice = selectPoints(now, stamp, groups, config_, comparer_);
    now_ = std::move(now);
    points_ = std::move(choice.points);
    sources_ = std::move(choice.sources);
    const int count = static_cast<int>(points_.size());
    shift_.reserve(count);
    for (PointSource& source : sources_) source.motion.reserve(count);
    for (TrackedPoint& point : points_) {
      point.memory.keep(now_, point.pose.place, flowHalf(config_));
      if (!point.isSeen()) point.memory.forget();
    }
    sequence_.begin(image, stamp);
    turn_ = 0;
    result_.points.resize(points_.size());
    result_.selected_now = true;
    tell();
    return result_;
  }

  const PointsResult& track(const cv::Mat& image, double stamp, const std::optional<Eigen::Matrix3d>& motion) {
    const Reason ended = sequence_.judge(image, stamp);
    result_.selected_now = false;
    if (!points_.empty() && ended != Reason::kNone) forget(ended);
    if (points_.empty()) return result_;
    now_.take(image, config_.levels, config_.saturation);
    for (TrackedPoint& point : points_) point.begin();
    if (motion && motion->allFinite()) moveAll(*motion);
    settle();
    follow();
    lead();
    searchOthers();
    for (std::size_t source = 0; source < sources_.size(); ++source) refuseStrays(source);
    for (std::size_t source = 0; source < sources_.size(); ++source) recall(source, stamp);
    for (TrackedPoint& point : points_) step(point, stamp);
    sequence_.goOn(stamp);
    tell();
    return result_;
  }

  void reset() { forget(Reason::kReset); }
  const PointsResult& result() const { return result_; }

 private:
  void forget(Reason reason) {
    points_.clear();
    sources_.clear();
    result_.points.clear();
    result_.state = State::kIdle;
    result_.reason = reason;
  }

  // What else knows where all of them have gone.
  void moveAll(const Eigen::Matrix3d& motion) {
    for (TrackedPoint& point : points_) {
      PointPose moved;  // of the identity, so that its shape is the motion's alone
      moved.place = point.pose.place;
      placeBy(motion, point.pose.place, moved);
      point.pose.place = moved.place;
      point.pose.shape = moved.shape * point.pose.shape;
    }
  }

  // Those that have hardly moved since, or as is known, need not be followed: what moves beside them cannot lead them
  // astray.
  void settle() {
    for (TrackedPoint& point : points_) {
      if (point.memory.levels() == 0) continue;
      comparer_.compare(now_, point);
      point.followed = point.settled = point.isSeen();
    }
  }

  // From the last image to this one, the others that it showed; together they tell how windows turn and grow, and lead
  // the others.
  void follow() {
    shift_.clear();
    const int finest = std::min(1, now_.levels() - 1);  // the comparison with the first view does the rest
    for (TrackedPoint& point : points_) {
      const Eigen::Vector2d before = point.pose.place;
      if (point.settled) shift_.add(before, point.fit.pose.place);
      if (point.settled || point.memory.levels() == 0) continue;
      point.reason = Reason::kNotSeen;
      if (!flow_.follow(point.memory, now_, finest, point.pose.place)) continue;
      shift_.add(before, point.pose.place);
      point.reason = Reason::kNone;
      point.followed = true;
    }
    shift_.fit();
    for (TrackedPoint& point : points_) {
      if (point.settled) continue;
      point.pose.shape = shift_.linear() * point.pose.shape;
      if (point.isSeen()) {
        comparer_.compare(now_, point);
      } else {
        point.pose.place = shift_.apply(point.pose.place);
      }
    }
  }

  // Those that are seen tell where the others of their picture are: anew in each image, so that it does not drift.
  void lead() {
    for (std::size_t source = 0; source < sources_.size(); ++source) {
      PointMotion& motion = sources_[source].motion;
      motion.clear();
      for (const TrackedPoint& point : points_) {
        if (point.group == source && point.isSeen() && point.keeper.state() == State::kTracking)
          motion.add(point.view.place(), point.fit.pose.place);
      }
      sources_[source].leads = motion.count() >= static_cast<int>(kFewestPoints) && motion.fit();
    }
    for (TrackedPoint& point : points_) {
      const PointSource& source = sources_[point.group];
      if (point.isSeen() || !source.leads) continue;
      point.pose.place = source.motion.apply(point.view.place());
      point.pose.shape = source.motion.linear();
    }
  }

  void searchOthers() {
    int left = kSearches;
    const std::size_t count = points_.size(), first = turn_;
    for (std::size_t k = 0; k < count && left > 0; ++k) {
      TrackedPoint& point = points_[(first + k) % count];
      if (point.isSeen()) continue;
      const Reason before = point.reason;
      comparer_.look(now_, point);
      if (!point.isSeen() && point.followed) point.reason = before;  // why it was lost
      if (--left == 0) turn_ = (first + k + 1) % count;
    }
  }

  // What was found, and is not TRACKING yet, has to move as the others do: one place that is alike by chance may be
  // anywhere, and several are nowhere together.
  void refuseStrays(std::size_t source) {
    PointMotion& motion = sources_[source].motion;
    motion.clear();
    std::size_t all = 0;
    for (const TrackedPoint& point : points_) {
      if (point.group != source) continue;
      ++all;
      if (point.isSeen()) motion.add(point.view.place(), point.fit.pose.place);
    }
    const int needed = all < kFewestPoints ? 1 : static_cast<int>(kFewestPoints);
    const bool known = motion.count() >= needed && motion.fit() && motion.sigma() <= kStray * config_.search_range;
    int index = 0;
    for (TrackedPoint& point : points_) {
      if (point.group != source || !point.isSeen()) continue;
      const bool agrees = known && motion.agrees(index);
      ++index;
      if (agrees || (point.followed && point.keeper.state() == State::kTracking)) continue;
      point.reason = Reason::kNotSeen;
      if (!point.followed) point.pose = point.expected;
    }
  }

  void recall(std::size_t source, double stamp) {
    std::size_t all = 0, seen = 0;
    for (const TrackedPoint& point : points_) {
      if (point.group != source) continue;
      ++all;
      if (point.isSeen()) ++seen;
    }
    const std::size_t enough = std::min(kFewestPoints, all);
    PointSource& from = sources_[source];
    if (seen >= enough || !(config_.recall_period > 0.0) || stamp < from.recall_at) return;
    from.recall_at = stamp + config_.recall_period;
    const std::vector<AgreedMotion> motions = from.picture.find(now_);
    if (motions.empty()) return;
    const std::vector<TrackedPoint> before = points_;
    for (const AgreedMotion& agreed : motions) {
      if (lookBy(agreed.motion, source, now_, comparer_, points_) >= enough) return;
      points_ = before;
    }
  }

  void step(TrackedPoint& point, double stamp) {
    // Found again in the image that lost it: that has to be confirmed, too.
    if (point.isSeen() && !point.followed && point.keeper.state() == State::kTracking)
      point.keeper.step(Reason::kNotSeen, stamp);
    point.keeper.step(point.reason, stamp);
    if (!point.isSeen()) return point.memory.forget();
    point.pose = point.fit.pose;
    point.memory.keep(now_, point.pose.place, flowHalf(config_));
  }

  void tell() {
    result_.state = State::kTracking;
    result_.reason = Reason::kNone;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const TrackedPoint& point = points_[i];
      PointResult& told = result_.points[i];
      told.state = point.keeper.state();
      told.reason = point.keeper.reason();
      told.place = point.pose.place;
      told.shape = point.pose.shape;
      const bool tracks = told.state == State::kTracking;
      told.covariance = point.fit.covariance;
      if (!tracks) setUnknown(told.covariance);
      told.expected_error = tracks ? point.fit.expected_error : std::numeric_limits<double>::infinity();
      told.gain = point.pose.gain;
      told.offset = point.pose.offset;
      told.correlation = point.isSeen() ? point.fit.correlation : 0.0;
      told.share = point.isSeen() ? point.fit.share : 0.0;
      if (static_cast<int>(told.state) > static_cast<int>(result_.state)) {
        result_.state = told.state;
        result_.reason = told.reason;
      }
    }
  }

  PointsConfig config_;
  PointComparer comparer_;
  PointFlow flow_;
  PointImage now_;
  std::vector<TrackedPoint> points_;
  std::vector<PointSource> sources_;
  PointMotion shift_;     // from the last image to this one
  std::size_t turn_ = 0;  // the point that is looked for next
  ImageSequence sequence_;
  PointsResult result_;
};

PointTracker::PointTracker(const PointsConfig& config) : implementation_(std::make_unique<Implementation>(config)) {}
PointTracker::~PointTracker() = default;
PointTracker::PointTracker(PointTracker&&) noexcept = default;
PointTracker& PointTracker::operator=(PointTracker&&) noexcept = default;

const PointsResult& PointTracker::select(const cv::Mat& image, double stamp, const std::vector<PointGroup>& groups) {
  return implementation_->select(image, stamp, groups);
}

const PointsResult& PointTracker::track(const cv::Mat& image, double stamp,
                                        const std::optional<Eigen::Matrix3d>& motion) {
  return implementation_->track(image, stamp, motion);
}

void PointTracker::reset() {
  implementation_->reset();
}

const PointsResult& PointTracker::result() const {
  return implementation_->result();
}

}  // namespace laparoscope_servo::features
