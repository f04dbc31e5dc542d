#include "laparoscope_servo/features/dots.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "features/dot_finder.h"
#include "laparoscope_servo/features/image_sequence.h"
#include "laparoscope_servo/features/selection_check.h"
#include "laparoscope_servo/features/tracked_feature.h"
#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/image_type.h"
#include "laparoscope_servo/parameters/table.h"
#include "laparoscope_servo/validation/error_report.h"

namespace laparoscope_servo::features {

namespace {

constexpr double kLeastSpread = 10.0;  // px, root mean square: dots nearer together do not tell growth and turn
constexpr double kLearn = 0.3;         // share of the looks that a new image adds to what is remembered
// Grey levels and their share, by which a dot that returns may differ from what it was.
constexpr double kReturnLevels = 10.0;
constexpr double kReturnShare = 0.25;

const DotsConfig& checked(const DotsConfig& config) {
  validation::throwErrors("dots", validate(config));
  return config;
}

std::string refused(const Eigen::Vector2d& point, const char* expected) {
  std::ostringstream text;
  text << "dot at (" << point.x() << ", " << point.y() << "), expected " << expected;
  return text.str();
}

struct Dot {
  explicit Dot(const StateConfig& config) : keeper(config) {}
  StateKeeper keeper;
  DotLooks looks;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  // where it is, or would be
  Eigen::Vector2d expected = Eigen::Vector2d::Zero();
  DotMeasurement measured;
  Reason reason = Reason::kNone;  // of the present image
};

bool near(double a, double b) {
  return std::abs(a - b) < kReturnShare * std::max(a, b) + kReturnLevels;
}

}  // namespace

void describe(parameters::Table& table, DotsConfig& c) {
  table.number("range", c.range, {2, 200}, "px", "how far a dot may be from where it is expected");
  table.number("min_contrast", c.min_contrast, {4, 255}, "grey levels", "between dot and background");
  table.number("min_radius", c.min_radius, {1.5, 100}, "px", "of a dot");
  table.number("max_radius", c.max_radius, {2, 200}, "px", "of a dot");
  table.number("max_area_change", c.max_area_change, {0.01, 2}, "", "from one image to the next, relative");
  table.number("max_roughness", c.max_roughness, {0.05, 10}, "px",
               "by which the outline may differ from an ellipse, in any of its twelve parts");
  table.number("max_error", c.max_error, {0.01, 20}, "px", "standard deviation expected of the centre");
  table.number("velocity_damping", c.velocity_damping, {0, 1}, "",
               "share of the last motion that is expected to go on");
  describe(table, c.state);
}

std::vector<std::string> validate(const DotsConfig& config) {
  std::vector<std::string> errors = parameters::errorsOf(config);
  if (!(config.min_radius < config.max_radius)) {
    errors.push_back("min_radius = " + std::to_string(config.min_radius) +
                     ", expected less than max_radius = " + std::to_string(config.max_radius));
  }
  return errors;
}

class DotTracker::Implementation {
 public:
  explicit Implementation(const DotsConfig& config) : config_(checked(config)), finder_(config) {}

  const DotsResult& select(const cv::Mat& image, double stamp, const std::vector<Eigen::Vector2d>& points) {
    image::checkImage(image, stamp);
    if (points.empty()) throw std::invalid_argument("0 dots, expected at least 1");
    std::vector<Dot> dots;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Eigen::Vector2d& point = points[k];
      Dot dot(config_.state);
      dot.measured = finder_.discover(image, point);
      if (!dot.measured.found) {
        throw RefusedFeature(k, refused(point,
                                        "a round dot there, whole in the image, of the radius and contrast that the "
                                        "parameters allow"));
      }
      for (const Dot& other : dots) {
        if (isSame(dot, other)) throw RefusedFeature(k, refused(point, "a dot that no other point is in"));
      }
      dot.looks = dot.measured.looks;
      dot.place = dot.measured.centre;
      dot.keeper.select(stamp);
      dots.push_back(dot);
    }
    dots_ = std::move(dots);
    sequence_.begin(image, stamp);
    velocity_.setZero();
    result_.dots.resize(dots_.size());
    result_.selected_now = true;
    tell();
    return result_;
  }

  const DotsResult& track(const cv::Mat& image, double stamp, const std::optional<Eigen::Matrix3d>& motion) {
    const Reason ended = sequence_.judge(image, stamp);
    result_.selected_now = false;
    if (!dots_.empty() && ended != Reason::kNone) forget(ended);
    if (dots_.empty()) return result_;
    expect(stamp, motion);
    for (Dot& dot : dots_) look(image, dot);
    keepApart();
    measureMotion(stamp);
    for (Dot& dot : dots_) step(dot, stamp);
    sequence_.goOn(stamp);
    tell();
    return result_;
  }

  void reset() { forget(Reason::kReset); }
  const DotsResult& result() const { return result_; }

 private:
  static double radius(const DotLooks& looks) { return std::sqrt(looks.area / M_PI); }

  static bool isSame(const Dot& a, const Dot& b) {
    return (a.measured.centre - b.measured.centre).norm() < 0.5 * (radius(a.measured.looks) + radius(b.measured.looks));
  }

  void forget(Reason reason) {
    dots_.clear();
    result_.dots.clear();
    result_.state = State::kIdle;
    result_.reason = reason;
  }

  void expect(double stamp, const std::optional<Eigen::Matrix3d>& motion) {
    Eigen::Vector2d shift = config_.velocity_damping * (stamp - sequence_.stamp()) * velocity_;
    if (!(shift.norm() <= config_.range)) shift.setZero();
    for (Dot& dot : dots_) {
      dot.expected = dot.place + shift;
      if (!motion || !motion->allFinite()) continue;
      const Eigen::Vector2d moved = geometry::apply(*motion, dot.place);
      if (moved.allFinite()) dot.expected = moved;
    }
  }

  void look(const cv::Mat& image, Dot& dot) {
    dot.measured = finder_.find(image, dot.expected, dot.looks);
    dot.reason = Reason::kNone;
    if (!dot.measured.found) {
      dot.reason = Reason::kNotSeen;
    } else if (!(worst(dot.measured.covariance) <= config_.max_error)) {
      dot.reason = Reason::kUncertain;
    } else if (dot.keeper.state() != State::kTracking && !(near(dot.measured.looks.level, dot.looks.level) &&
                                                           near(dot.measured.looks.background, dot.looks.background))) {
      dot.reason = Reason::kJump;
    }
  }

  // Of two that found the same one it is that of the dot that was seen before, else of the one that expected it nearer.
  void keepApart() {
    for (std::size_t i = 0; i < dots_.size(); ++i) {
      for (std::size_t j = i + 1; j < dots_.size(); ++j) {
        Dot &a = dots_[i], &b = dots_[j];
        if (a.reason != Reason::kNone || b.reason != Reason::kNone || !isSame(a, b)) continue;
        const bool a_tracks = a.keeper.state() == State::kTracking, b_tracks = b.keeper.state() == State::kTracking;
        const bool a_nearer = (a.measured.centre - a.expected).norm() <= (b.measured.centre - b.expected).norm();
        Dot& loser = a_tracks != b_tracks ? (a_tracks ? b : a) : (a_nearer ? b : a);
        loser.reason = Reason::kTaken;
      }
    }
  }

  // The similarity of those that are seen, from the last image to this one, leads those that are not.
  void measureMotion(double stamp) {
    double count = 0.0, square = 0.0, dot_product = 0.0, cross = 0.0;
    Eigen::Vector2d before = Eigen::Vector2d::Zero(), now = before;
    for (const Dot& dot : dots_) {
      if (!isSeen(dot)) continue;
      count += 1.0;
      before += dot.place;
      now += dot.measured.centre;
    }
    const double passed = stamp - sequence_.stamp();
    velocity_.setZero();
    if (count > 0.0) {
      before /= count;
      now /= count;
      if (passed > 0.0) velocity_ = (now - before) / passed;
    }
    for (const Dot& dot : dots_) {
      if (!isSeen(dot)) continue;
      const Eigen::Vector2d p = dot.place - before, q = dot.measured.centre - now;
      square += p.squaredNorm();
      dot_product += p.dot(q);
      cross += p.x() * q.y() - p.y() * q.x();
    }
    Eigen::Matrix2d turn = Eigen::Matrix2d::Identity();
    if (square > count * kLeastSpread * kLeastSpread) {
      turn << dot_product / square, -cross / square, cross / square, dot_product / square;
    }
    for (Dot& dot : dots_) {
      if (dot.reason == Reason::kNone) continue;
      dot.place = count > 0.0 ? Eigen::Vector2d(now + turn * (dot.place - before)) : dot.expected;
    }
  }

  static bool isSeen(const Dot& dot) { return dot.reason == Reason::kNone && dot.keeper.state() == State::kTracking; }

  void step(Dot& dot, double stamp) {
    dot.keeper.step(dot.reason, stamp);
    if (dot.reason != Reason::kNone) return;
    dot.place = dot.measured.centre;
    if (dot.keeper.state() != State::kTracking) return;
    const DotLooks& now = dot.measured.looks;
    dot.looks.level += kLearn * (now.level - dot.looks.level);
    dot.looks.background += kLearn * (now.background - dot.looks.background);
    dot.looks.area += kLearn * (now.area - dot.looks.area);
    dot.looks.flatness += kLearn * (now.flatness - dot.looks.flatness);
  }

  static double worst(const Eigen::Matrix2d& covariance) {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
    solver.computeDirect(covariance, Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0.0, solver.eigenvalues()[1]));
  }

  void tell() {
    result_.state = State::kTracking;
    result_.reason = Reason::kNone;
    for (std::size_t i = 0; i < dots_.size(); ++i) {
      const Dot& dot = dots_[i];
      DotResult& told = result_.dots[i];
      told.state = dot.keeper.state();
      told.reason = dot.keeper.reason();
      told.centre = dot.place;
      const bool tracks = told.state == State::kTracking;
      told.covariance = dot.measured.covariance;
      if (!tracks) setUnknown(told.covariance);
      told.expected_error = tracks ? worst(dot.measured.covariance) : std::numeric_limits<double>::infinity();
      told.area = dot.looks.area;
      told.level = dot.looks.level;
      told.background = dot.looks.background;
      if (static_cast<int>(told.state) > static_cast<int>(result_.state)) {
        result_.state = told.state;
        result_.reason = told.reason;
      }
    }
  }

  DotsConfig config_;
  DotFinder finder_;
  std::vector<Dot> dots_;
  Eigen::Vector2d velocity_ = Eigen::Vector2d::Zero();  // px/s
  ImageSequence sequence_;
  DotsResult result_;
};

DotTracker::DotTracker(const DotsConfig& config) : implementation_(std::make_unique<Implementation>(config)) {}
DotTracker::~DotTracker() = default;
DotTracker::DotTracker(DotTracker&&) noexcept = default;
DotTracker& DotTracker::operator=(DotTracker&&) noexcept = default;

const DotsResult& DotTracker::select(const cv::Mat& image, double stamp, const std::vector<Eigen::Vector2d>& points) {
  return implementation_->select(image, stamp, points);
}

const DotsResult& DotTracker::track(const cv::Mat& image, double stamp, const std::optional<Eigen::Matrix3d>& motion) {
  return implementation_->track(image, stamp, motion);
}

void DotTracker::reset() {
  implementation_->reset();
}

const DotsResult& DotTracker::result() const {
  return implementation_->result();
}

}  // namespace laparoscope_servo::features
