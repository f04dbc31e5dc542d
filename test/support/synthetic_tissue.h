// Images with known motion for tests: a smooth random texture in the colours of tissue, seen through a homography.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/geometry/sl3.h"

namespace laparoscope_servo::test {

// CV_8UC3, blue first. Contrast at several scales, so that each level of a pyramid has some.
inline cv::Mat tissue(const cv::Size& size, unsigned seed) {
  cv::RNG rng(seed);
  cv::Mat3f image(size, cv::Vec3f(70.0f, 80.0f, 150.0f));
  for (const double scale : {2.0, 5.0, 13.0}) {
    cv::Mat1f noise(size);
    cv::Mat1f hue(size);
    rng.fill(noise, cv::RNG::NORMAL, 0.0, 1.0);
    rng.fill(hue, cv::RNG::NORMAL, 0.0, 1.0);
    cv::GaussianBlur(noise, noise, cv::Size(), scale);
    cv::GaussianBlur(hue, hue, cv::Size(), scale);
    // A blur by s leaves white noise with a standard deviation of 1 / (2 sqrt(pi) s).
    const double contrast = 15.0 * 3.545 * scale;
    image.forEach([&](cv::Vec3f& pixel, const int* at) {
      const float n = static_cast<float>(contrast) * noise(at[0], at[1]);
      const float h = static_cast<float>(0.5 * contrast) * hue(at[0], at[1]);
      pixel += cv::Vec3f(n - 0.5f * h, n - h, 0.8f * n + h);
    });
  }
  cv::Mat result;
  image.convertTo(result, CV_8UC3);
  return result;
}

inline cv::Matx33d toMatx(const Eigen::Matrix3d& g) {
  cv::Matx33d m;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) m(r, c) = g(r, c);
  }
  return m;
}

// The scene seen so that its pixel p appears at g p; gain, bias and noise in grey levels.
inline cv::Mat view(const cv::Mat& scene, const Eigen::Matrix3d& g, double gain = 1.0, double bias = 0.0,
                    double noise = 0.0, unsigned seed = 1) {
  cv::Mat warped;
  cv::warpPerspective(scene, warped, toMatx(g), scene.size(), cv::INTER_CUBIC, cv::BORDER_REFLECT_101);
  cv::Mat exact;
  warped.convertTo(exact, CV_32FC(scene.channels()), gain, bias);
  if (noise > 0.0) {
    cv::Mat grain(exact.size(), exact.type());
    cv::RNG rng(seed);
    rng.fill(grain, cv::RNG::NORMAL, 0.0, noise);
    exact += grain;
  }
  cv::Mat result;
  exact.convertTo(result, scene.type());
  return result;
}

// A homography that moves the corners of `roi` by normal noise of `sigma` px, as in the ESM papers.
inline Eigen::Matrix3d randomHomography(const geometry::Rectangle& roi, double sigma, cv::RNG& rng) {
  geometry::Quadrilateral to = roi.corners();
  for (Eigen::Vector2d& corner : to) corner += Eigen::Vector2d(rng.gaussian(sigma), rng.gaussian(sigma));
  return geometry::fromCorners(roi.corners(), to);
}

// Of the ROI about its centre, which goes to `to`: first `tilted`, a homography about the origin, then zoomed and
// turned by `angle` [rad].
inline Eigen::Matrix3d zoomAndTurn(const geometry::Rectangle& roi, double zoom, double angle,
                                   const Eigen::Matrix3d& tilted, const Eigen::Vector2d& to) {
  Eigen::Matrix3d centre = Eigen::Matrix3d::Identity();
  centre.topRightCorner<2, 1>() << -roi.x - 0.5 * roi.width, -roi.y - 0.5 * roi.height;
  Eigen::Matrix3d g;
  g << zoom * std::cos(angle), -zoom * std::sin(angle), to.x(), zoom * std::sin(angle), zoom * std::cos(angle), to.y(),
      0, 0, 1;
  return geometry::normaliseDeterminant(g * tilted * centre);
}

}  // namespace laparoscope_servo::test
