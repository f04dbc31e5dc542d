// The distortion of a lens, with the models and the order of coefficients of sensor_msgs/CameraInfo (and OpenCV).
//
// Rectified pixels are those of an ideal pinhole camera, as in image_proc's image_rect; raw pixels are the image's own.
// A rectified pixel p is the ray R^-1 P^-1 p of the camera; the model moves that ray's point (x, y, 1), and K takes it
// to its raw pixel. Homographies of a plane hold between rectified pixels only.
//
// The models are polynomials in the distance from the axis, which are not monotonic far out: they would show one point
// of the scene twice. Points outside the field, in which the map is one to one, have no raw pixel.
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <optional>

#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::image {

enum class Distortion {
  kPlumbBob,            // k1, k2, p1, p2, k3
  kRationalPolynomial,  // k1, k2, p1, p2, k3, k4, k5, k6
  kEquidistant,         // k1, k2, k3, k4, of the angle from the axis: a fisheye
};

struct LensParameters {
  Distortion distortion = Distortion::kPlumbBob;
  std::array<double, 8> coefficients{};                    // in the order above, the rest 0
  geometry::PinholeCamera raw;                             // K
  geometry::PinholeCamera rectified;                       // P, its left 3x3 block
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  // R: rays of the camera to rays of the rectified one
};

// A part of the raw image at a coarser scale: its pixel (0, 0) lies on the raw pixel `origin`, and is `scale` raw
// pixels wide.
struct RawWindow {
  cv::Point origin;
  double scale = 1.0;
};

// The lens in single precision, for the loops over the pixels of one window.
struct LensLoop {
  bool equidistant = false;
  float k[6] = {};  // coefficients of the numerator, then of the denominator; equidistant: the first four
  float p1 = 0.0f, p2 = 0.0f;
  float fx = 0.0f, fy = 0.0f, cx = 0.0f, cy = 0.0f;  // px of the window
  float field = 0.0f;                                // largest x^2 + y^2
};

// Numerators and denominator of a projective map along a row of pixels: their values at the row's first pixel, and
// their increments.
struct ProjectiveRow {
  float u0, u1;
  float v0, v1;
  float w0, w1;
};

class Lens {
 public:
  // Throws std::invalid_argument, with the value and what was expected, for a camera or coefficients that are not
  // finite, a matrix that is no rotation, and a model that is not one to one even on the axis.
  explicit Lens(const LensParameters& parameters);

  // Convert pixels; empty outside the field, and behind the camera. toRectified solves the model by iterations, to 1e-9
  // of the focal length.
  std::optional<Eigen::Vector2d> toRaw(const Eigen::Vector2d& rectified) const;
  std::optional<Eigen::Vector2d> toRectified(const Eigen::Vector2d& raw) const;

  // Takes rectified pixels to rays, (x, y) after division by the third component.
  const Eigen::Matrix3d& raysFromRectified() const { return rays_; }
  LensLoop loop(const RawWindow& window) const;

  // The field's border, as the largest x^2 + y^2 of a ray; at most that of 88 degrees off the axis.
  double field() const { return field_; }
  const LensParameters& parameters() const { return parameters_; }

 private:
  Eigen::Vector2d distort(const Eigen::Vector2d& point) const;
  Eigen::Matrix2d derivative(const Eigen::Vector2d& point) const;
  double radial(double q) const;
  double findField() const;
  double undistortedRadius(double distorted) const;

  LensParameters parameters_;
  Eigen::Matrix3d rays_;
  Eigen::Matrix3d rectified_from_rays_;
  double field_ = 0.0;
};

// Whether both map all pixels alike.
bool operator==(const Lens& a, const Lens& b);
inline bool operator!=(const Lens& a, const Lens& b) {
  return !(a == b);
}

// Pixels of the window at which the rays along `row` are seen: (u[i], v[i]) for the row's pixel first + i; NaN if there
// is none. The row is that of raysFromRectified() * g, for a g that takes its pixels to rectified ones. Within 0.001 px
// of toRaw, for focal lengths and windows of up to 4000 px.
void locateRaw(const LensLoop& lens, const ProjectiveRow& row, int first, int count, float* u, float* v);

// The part of the raw image that shows the rectified quadrilateral, grown by `margin` (raw px) in every direction, not
// cut to any image; empty when none of it is in the field. The corners have to be finite.
cv::Rect rawBox(const Lens& lens, const geometry::Quadrilateral& rectified, double margin);

// rawBox(), or without a lens (null) the box around the corners themselves.
cv::Rect seenBox(const Lens* lens, const geometry::Quadrilateral& corners, double margin);

// Box of the rectified pixels that a raw image of `size` shows, at most twice its width and height.
cv::Rect rectifiedBox(const Lens& lens, const cv::Size& size);

// The rectified pixel of each raw one in `box`, to a quarter of a pixel, interpolated between nodes every few pixels.
// Far outside any image if there is none.
cv::Mat2f rectifiedMap(const Lens& lens, const cv::Rect& box);

// Draws a mask of the ROI's pixels into the image: result(v, u) = mask at the pixel that `g` takes to pixel
// `window`.tl() + (u, v) of the raw image; 0 if there is none. Without a lens (null) g takes the mask's pixels to those
// of the image itself.
void drawMask(const cv::Mat1b& mask, const Eigen::Matrix3d& g, const Lens* lens, const cv::Rect& window,
              cv::Mat1b& result);

}  // namespace laparoscope_servo::image
