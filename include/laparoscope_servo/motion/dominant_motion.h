// The dominant motion from each image to the next: section IV.A of Marchand and Chaumette (2004). What moves otherwise,
// covers, shines or is dark is left out, as long as the greater part of the texture moves as the model says.
//
// Images are 8 bit, grey (CV_8UC1) or blue-green-red (CV_8UC3), at least 64 px in width and height; times are seconds,
// from the images' stamps. No clock, no global state: the same images give the same results. Does not allocate once two
// images have been processed. Not thread-safe.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "laparoscope_servo/features/feature_state.h"
#include "laparoscope_servo/motion/motion_config.h"
#include "laparoscope_servo/motion/motion_model.h"

namespace laparoscope_servo::motion {

struct MotionResult {
  features::State state = features::State::kIdle;  // IDLE: no image before this one
  features::Reason reason = features::Reason::kNothingSelected;
  // Pixels of the last image to those of this one, determinant 1. TRACKING: as seen; else as expected.
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  // The same as eq. (8) about the image's centre, by image: its unit of time is `interval`.
  MotionField field;
  // Of field.a; rows that the model does not have are 0. Infinite variances unless TRACKING.
  Eigen::Matrix<double, 8, 8> covariance = Eigen::Matrix<double, 8, 8>::Zero();
  double interval = 0.0;        // s, between the two images
  double gain = 1.0;            // gain * image + offset looks like the last image
  double offset = 0.0;          // grey levels
  double sigma = 0.0;           // grey levels, robust standard deviation of what is left between the two
  double usable = 0.0;          // share of the image, or of the region, that was left by highlights, darkness and mask
  double share = 0.0;           // of the gradient energy, that follows the motion, 0 to 1
  double expected_error = 0.0;  // px, standard deviation at the worst corner; infinite unless TRACKING
  int iterations = 0;
  // In this image: where the region is; without one the image's corners.
  geometry::Quadrilateral region{};
};

class MotionSequence;

class DominantMotion {
 public:
  // Throws std::invalid_argument that lists every error of the configuration.
  explicit DominantMotion(const MotionConfig& config = {});
  DominantMotion(DominantMotion&&) noexcept;
  DominantMotion& operator=(DominantMotion&&) noexcept;
  ~DominantMotion();

  // Begins with this image, in place of what was. `region`: px, whose motion is wanted. It goes along with its motion,
  // and is compared with this image, so that it does not drift; once an image does not show it, only that finds it
  // again. None: all of the image. Throws std::invalid_argument for an image that it cannot use, and for a region that
  // is not in the image or has less than 48 px in width or height; it then goes on as before.
  const MotionResult& begin(const cv::Mat& image, double stamp,
                            const std::optional<geometry::Rectangle>& region = std::nullopt,
                            const cv::Mat& mask = cv::Mat());

  // The motion to the next image. The first image begins. `motion`: from the last image to this one, as another source
  // expects it. `mask`: CV_8UC1 of the image's size, what is not 0 is left out; empty: nothing is. A stamp before the
  // last one, or an image of another size or type, begins anew, without a region, with the reason. Throws
  // std::invalid_argument for an image, a mask or a stamp that cannot be used, and goes on as if they had not come.
  const MotionResult& track(const cv::Mat& image, double stamp,
                            const std::optional<Eigen::Matrix3d>& motion = std::nullopt,
                            const cv::Mat& mask = cv::Mat());

  void reset();

  const MotionResult& result() const;  // of the last call
  // Which parts of the last image but one follow the motion, a pixel for each of cellSize() px of it, from
  // supportOrigin() on, which is (0, 0) without a region: 255 follows, 0 something else moves there or covers it, 128
  // shows nothing. Empty before there are two images.
  const cv::Mat1b& support() const;
  cv::Size cellSize() const;
  cv::Point supportOrigin() const;

 private:
  std::unique_ptr<MotionSequence> sequence_;
};

}  // namespace laparoscope_servo::motion
