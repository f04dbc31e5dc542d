// Tracks a curve - a line, an ellipse, a spline - through a sequence of images, by its edges.
//
// Images are 8 bit, grey (CV_8UC1) or blue-green-red (CV_8UC3), all of one size and type; times are seconds, from the
// images' stamps. The tracker keeps no clock and no global state: the same images give the same results. It is not
// thread-safe, and does not allocate while tracking.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "laparoscope_servo/features/edge_config.h"
#include "laparoscope_servo/features/edge_fit.h"
#include "laparoscope_servo/features/feature_state.h"
#include "laparoscope_servo/features/image_sequence.h"

namespace laparoscope_servo::features {

template <class C>
struct CurveResult {
  State state = State::kIdle;
  Reason reason = Reason::kNothingSelected;  // why the state is not TRACKING
  C curve;                                   // TRACKING: as seen; SEARCHING and LOST: where it is expected
  double share = 0.0;                        // of its sites in the image, those that agree with it
  double sigma = 0.0;                        // px, robust standard deviation of the edges about it
  // px along the normal, standard deviation at its worst site, of a spline at the worst one that agrees; infinite
  // unless TRACKING.
  double expected_error = 0.0;
  bool selected_now = false;
};

// What all kinds of curve share: the image's checks, expectation by velocity, and the states.
class CurveTrackerBase {
 protected:
  explicit CurveTrackerBase(const EdgeConfig& config);

  void checkSelection(const cv::Mat& image, double stamp) const;
  [[noreturn]] static void refuse(const EdgeReport& report);
  // False: the image was not for this tracker, which is IDLE now if it was not before.
  bool accepts(const cv::Mat& image, double stamp);
  void start(const cv::Mat& image, double stamp);
  // The motion of the last two images that showed the curve, as far as it is expected to go on until `stamp`.
  Eigen::Matrix3d drift(double stamp) const;
  void measureVelocity(const Curve& before, const Curve& now, double stamp);
  void stopVelocity() { velocity_.setZero(); }
  // px: a larger jump is a surprise.
  double surprise() const;
  void noteJump(double jump);

  EdgeConfig config_;
  EdgeFit fit_;
  StateKeeper keeper_;
  ImageSequence sequence_;

 private:
  Eigen::Vector2d velocity_ = Eigen::Vector2d::Zero();  // px/s
  double tracked_stamp_ = 0.0;
  double usual_jump_ = 0.0;
  std::vector<Site> sites_before_, sites_now_;
};

template <class C>
class CurveTracker : public CurveTrackerBase {
 public:
  // Throws std::invalid_argument that lists every error of the configuration.
  explicit CurveTracker(const EdgeConfig& config = {}) : CurveTrackerBase(config) {}

  // Fits `curve`, which may be off by `range` px, to the image, and takes what is found for the curve to be tracked.
  // Throws std::invalid_argument, with what was found and what was expected, when the image shows no such edge; the
  // tracker then goes on as before.
  const CurveResult<C>& select(const cv::Mat& image, double stamp, const C& curve, double range = 6.0) {
    checkSelection(image, stamp);
    C found = curve;
    EdgeFit fit(config_);
    const EdgeReport report = fit.learn(image, found, range);
    if (report.reason != Reason::kNone) refuse(report);
    fit_ = std::move(fit);
    start(image, stamp);
    found.settle(fit_.findings(), fit_.covariance(), 0.0);
    home_ = last_ = found;
    result_.selected_now = true;
    tell(report, found);
    return result_;
  }

  // Processes the next image. A stamp before the last one, or an image of another size or type than the selection's,
  // resets to IDLE, with the reason. `motion`: takes pixels of the last image to pixels of this one, where something
  // else knows it; one that is no homography is ignored. A curve that was lost is found again within config's range of
  // where it was seen last, moved on by `motion`, and only if it looks as it did. The result lasts until the next call.
  const CurveResult<C>& track(const cv::Mat& image, double stamp,
                              const std::optional<Eigen::Matrix3d>& motion = std::nullopt) {
    result_.selected_now = false;
    if (!accepts(image, stamp)) return idle();
    const bool tracking = keeper_.state() == State::kTracking;
    expect(tracking, stamp, motion);
    now_ = expected_;
    EdgeReport report = fit_.fit(image, expected_, now_, config_.range, !tracking, surprise());
    if (report.reason == Reason::kNone && !(now_.change(home_) <= 1.0 + config_.max_change)) {
      report.reason = Reason::kShape;
    }
    keeper_.step(report.reason, stamp);
    if (keeper_.state() == State::kTracking) {
      now_.settle(fit_.findings(), fit_.covariance(), stamp - sequence_.stamp());
      if (tracking) {
        measureVelocity(last_, now_, stamp);
        noteJump(fit_.jump());
      } else {
        start(image, stamp);
      }
      fit_.remember();
      home_ = last_ = now_;
    } else {
      stopVelocity();
      // What is not confirmed yet is looked for where it was; what failed, where the curve was seen last.
      last_ = report.reason == Reason::kNone ? now_ : home_;
    }
    sequence_.goOn(stamp);
    tell(report, last_);
    return result_;
  }

  // Forgets the curve.
  void reset() {
    keeper_.reset(Reason::kReset);
    idle();
  }

  const CurveResult<C>& result() const { return result_; }
  // Of the curve's parameters, of the last image in which the state was TRACKING.
  const Eigen::MatrixXd& covariance() const { return fit_.covariance(); }
  // Each site of the last image.
  const std::vector<SiteFinding>& findings() const { return fit_.findings(); }

 private:
  void expect(bool tracking, double stamp, const std::optional<Eigen::Matrix3d>& motion) {
    expected_ = last_;
    if (motion && motion->allFinite()) {
      expected_.transform(*motion);
      C home = home_;
      home.transform(*motion);
      if (expected_.isSound() && home.isSound()) {
        home_ = home;
        return;
      }
      expected_ = last_;
    }
    if (tracking) expected_.transform(drift(stamp));
  }

  const CurveResult<C>& idle() {
    result_.state = keeper_.state();
    result_.reason = keeper_.reason();
    result_.share = result_.sigma = 0.0;
    result_.expected_error = std::numeric_limits<double>::infinity();
    return result_;
  }

  void tell(const EdgeReport& report, const C& curve) {
    result_.state = keeper_.state();
    result_.reason = keeper_.reason();
    result_.curve = curve;
    result_.share = report.share;
    result_.sigma = report.sigma;
    result_.expected_error =
        result_.state == State::kTracking ? report.expected_error : std::numeric_limits<double>::infinity();
  }

  C home_;      // where the curve was seen last, moved on by what else knows the motion
  C last_;      // where it was, by the last image
  C expected_;  // in the present image
  C now_;
  CurveResult<C> result_;
};

}  // namespace laparoscope_servo::features
