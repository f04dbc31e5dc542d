#include "laparoscope_servo/sim/tissue.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/geometry/sl3.h"

namespace laparoscope_servo::sim {

namespace {

constexpr double kMinDistance = 1e-4;  // m: at smaller distances nothing is visible

// Largest number of texels between two neighbouring samples, over the image's corners and centre.
double texelsPerSample(const Eigen::Matrix3d& texels_from_samples, const cv::Size& size) {
  const double right = size.width - 1.0, bottom = size.height - 1.0;
  double most = 0.0;
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(right, 0.0), Eigen::Vector2d(0.0, bottom),
                                   Eigen::Vector2d(right, bottom), Eigen::Vector2d(right / 2.0, bottom / 2.0)}) {
    const Eigen::Vector3d q = texels_from_samples * p.homogeneous();
    if (!(q.z() > 0.0)) continue;  // beyond the horizon
    Eigen::Matrix2d derivative;
    derivative =
        (texels_from_samples.topLeftCorner<2, 2>() - q.hnormalized() * texels_from_samples.bottomLeftCorner<1, 2>()) /
        q.z();
    most = std::max(most, derivative.jacobiSvd().singularValues()[0]);
  }
  return most;
}

cv::Matx33d toCv(const Eigen::Matrix3d& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

// The warp does not check the sign of the denominator: blackens the pixels whose rays point away from the plane, those
// with n'm <= 0.
void blackenBeyondHorizon(cv::Mat& image, const Eigen::RowVector3d& ray_dot_normal) {
  const auto at = [&](double u, double v) { return ray_dot_normal.dot(Eigen::RowVector3d(u, v, 1.0)); };
  const double right = image.cols - 1.0, bottom = image.rows - 1.0;
  if (std::min({at(0.0, 0.0), at(right, 0.0), at(0.0, bottom), at(right, bottom)}) > 0.0) return;
  image.forEach<cv::Vec3b>([&](cv::Vec3b& pixel, const int* position) {
    if (!(at(position[1], position[0]) > 0.0)) pixel = {0, 0, 0};
  });
}

}  // namespace

Plane planeSeenFrom(const Eigen::Isometry3d& base_T_camera, const Eigen::Isometry3d& base_T_tissue) {
  const Eigen::Isometry3d camera_T_tissue = base_T_camera.inverse() * base_T_tissue;
  const Eigen::Vector3d normal = camera_T_tissue.linear().col(2);
  return {normal, normal.dot(camera_T_tissue.translation())};
}

Eigen::Isometry3d placeTissue(const TissueConfig& config, const Eigen::Isometry3d& base_T_start_camera) {
  return base_T_start_camera * Eigen::Translation3d(0.0, 0.0, config.distance) *
         Eigen::AngleAxisd(config.tilt_x, Eigen::Vector3d::UnitX()) *
         Eigen::AngleAxisd(config.tilt_y, Eigen::Vector3d::UnitY());
}

Eigen::Matrix3d trueHomography(const geometry::PinholeCamera& camera, const Eigen::Isometry3d& base_T_tissue,
                               const Eigen::Isometry3d& base_T_reference, const Eigen::Isometry3d& base_T_current) {
  const Plane plane = planeSeenFrom(base_T_reference, base_T_tissue);
  if (!(plane.distance > 0.0)) throw std::invalid_argument("the reference camera is not in front of the tissue");
  const Eigen::Matrix3d h =
      geometry::fromPlane(base_T_current.inverse() * base_T_reference, plane.normal, plane.distance);
  return geometry::normaliseDeterminant(geometry::pixelsFromNormalised(h, camera));
}

Tissue::Tissue(const cv::Mat& texture, double width, const Eigen::Isometry3d& base_T_tissue)
    : width_(width), base_T_tissue_(base_T_tissue) {
  if (texture.empty() || texture.type() != CV_8UC3) {
    throw std::invalid_argument("the tissue's texture is empty or not of three channels with 8 bit each");
  }
  if (!(width > 0.0))
    throw std::invalid_argument("the tissue's width is " + std::to_string(width) + " m, expected > 0");
  pyramid_.push_back(texture.clone());
  while (std::min(pyramid_.back().cols, pyramid_.back().rows) > 8) {
    cv::Mat coarser;
    cv::pyrDown(pyramid_.back(), coarser);
    pyramid_.push_back(coarser);
  }
}

Eigen::Matrix3d Tissue::metresFromTexels() const {
  const double scale = width_ / pyramid_.front().cols;
  Eigen::Matrix3d m;
  m << scale, 0.0, -scale * (pyramid_.front().cols - 1.0) / 2.0,  //
      0.0, scale, -scale * (pyramid_.front().rows - 1.0) / 2.0,   //
      0.0, 0.0, 1.0;
  return m;
}

cv::Mat Tissue::view(const geometry::PinholeCamera& camera, const cv::Size& size, int supersampling,
                     const Eigen::Isometry3d& base_T_camera) const {
  const Plane plane = planeSeenFrom(base_T_camera, base_T_tissue_);
  if (!(plane.distance > kMinDistance)) return cv::Mat::zeros(size, CV_8UC3);

  const Eigen::Isometry3d camera_T_tissue = base_T_camera.inverse() * base_T_tissue_;
  Eigen::Matrix3d rays_from_metres;
  rays_from_metres << camera_T_tissue.linear().leftCols<2>(), camera_T_tissue.translation();
  // Sample k of a pixel lies at (k + 1/2) / s - 1/2 of it.
  const double s = supersampling;
  Eigen::Matrix3d pixels_from_samples;
  pixels_from_samples << 1.0 / s, 0.0, 0.5 / s - 0.5, 0.0, 1.0 / s, 0.5 / s - 0.5, 0.0, 0.0, 1.0;
  const Eigen::Matrix3d rays_from_samples = camera.inverseMatrix() * pixels_from_samples;
  // The inverse has a positive third component where the ray meets the plane in front of the camera.
  const Eigen::Matrix3d texels_from_samples =
      metresFromTexels().inverse() * rays_from_metres.inverse() * rays_from_samples;

  const cv::Size samples(size.width * supersampling, size.height * supersampling);
  const double density = texelsPerSample(texels_from_samples, samples);
  const int coarsest = static_cast<int>(pyramid_.size()) - 1;
  const int level = density > 1.0 ? std::min(coarsest, static_cast<int>(std::lround(std::log2(density)))) : 0;
  // pyrDown does not move the centre of the first pixel.
  const Eigen::Matrix3d level_from_samples =
      Eigen::Vector3d(std::ldexp(1.0, -level), std::ldexp(1.0, -level), 1.0).asDiagonal() * texels_from_samples;

  cv::Mat image;
  cv::warpPerspective(pyramid_[static_cast<std::size_t>(level)], image, toCv(level_from_samples), samples,
                      cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_REFLECT_101);
  blackenBeyondHorizon(image, plane.normal.transpose() * rays_from_samples);
  if (supersampling > 1) cv::resize(image, image, size, 0.0, 0.0, cv::INTER_AREA);
  return image;
}

}  // namespace laparoscope_servo::sim
