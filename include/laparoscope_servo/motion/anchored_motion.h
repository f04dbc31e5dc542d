// How the view has moved since one image, the anchor: the motions from image to image one after the other (eq. (10) of
// Marchand and Chaumette (2004), for the whole field), corrected by the anchor itself wherever enough of it is in view,
// so that it does not drift. A view that was left by a motion that could be followed is found again when it comes back.
//
// Images, stamps and errors as for DominantMotion. Does not allocate once two images have been processed.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "laparoscope_servo/motion/dominant_motion.h"

namespace laparoscope_servo::motion {

struct AnchoredResult {
  // TRACKING: g is known. SEARCHING, LOST: the chain is broken, the anchor is looked for. IDLE: no image yet.
  features::State state = features::State::kIdle;
  features::Reason reason = features::Reason::kNothingSelected;
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();  // pixels of the anchor to those of this image, determinant 1
  MotionField field;                                // whose flow that is, about the image's centre
  // Of field.a; infinite variances unless TRACKING.
  Eigen::Matrix<double, 8, 8> covariance = Eigen::Matrix<double, 8, 8>::Zero();
  double expected_error = 0.0;  // px, standard deviation at the worst corner; infinite unless TRACKING
  double share = 0.0;           // of the gradient energy of the anchor, that follows; 0 unless anchored
  bool anchored = false;        // this image was compared with the anchor, else g is by integration alone
  double since_anchored = 0.0;  // s, since the last image that was
  double in_view = 0.0;         // share of the anchor that is in this image, 0 to 1
};

class AnchoredMotion {
 public:
  // Throws std::invalid_argument that lists every error of the configuration.
  explicit AnchoredMotion(const MotionConfig& config = {});
  AnchoredMotion(AnchoredMotion&&) noexcept;
  AnchoredMotion& operator=(AnchoredMotion&&) noexcept;
  ~AnchoredMotion();

  // Takes this image for the anchor.
  const AnchoredResult& begin(const cv::Mat& image, double stamp, const cv::Mat& mask = cv::Mat());
  // The first image is the anchor, and so is one after a jump back of time, or of another size or type.
  const AnchoredResult& track(const cv::Mat& image, double stamp,
                              const std::optional<Eigen::Matrix3d>& motion = std::nullopt,
                              const cv::Mat& mask = cv::Mat());
  void reset();

  const AnchoredResult& result() const;
  // From the last image to this one, and which parts of it follow: as those of DominantMotion.
  const MotionResult& step() const;
  const cv::Mat1b& support() const;
  cv::Size cellSize() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace laparoscope_servo::motion
