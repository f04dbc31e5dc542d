// Pictures of a printed board as a known camera would take them.
#pragma once

#include <cmath>
#include <functional>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace laparoscope_servo::test_support {

struct BoardCamera {
  cv::Size size{640, 480};
  cv::Mat k = (cv::Mat_<double>(3, 3) << 520, 0, 330, 0, 525, 235, 0, 0, 1);
  cv::Mat d = (cv::Mat_<double>(1, 5) << -0.2, 0.05, 0.001, -0.0005, 0.0);
};

// Whether a place is black, in squares from the board's upper left edge.
using BoardInk = std::function<bool(double, double)>;

inline bool chessboard(double u, double v) {
  return (static_cast<int>(std::floor(u)) + static_cast<int>(std::floor(v))) % 2 == 0;
}

// A board of 10 x 7 squares of 4 mm, white around it, at rotation `r` and translation `t` (m) of its first corner.
inline cv::Mat boardPicture(const BoardCamera& camera, const cv::Vec3d& r, const cv::Vec3d& t,
                            const BoardInk& ink = chessboard) {
  constexpr double kSquare = 0.004;
  cv::Matx33d rotation;
  cv::Rodrigues(r, rotation);
  // Ray of each pixel without its distortion, cut with the board's plane.
  std::vector<cv::Point2f> pixels;
  for (int y = 0; y < camera.size.height; ++y) {
    for (int x = 0; x < camera.size.width; ++x) pixels.emplace_back(static_cast<float>(x), static_cast<float>(y));
  }
  std::vector<cv::Point2f> rays;
  cv::undistortPoints(pixels, rays, camera.k, camera.d);
  cv::Mat picture(camera.size, CV_8UC1, cv::Scalar(110));
  const cv::Vec3d normal(rotation(0, 2), rotation(1, 2), rotation(2, 2));
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    const cv::Vec3d ray(rays[k].x, rays[k].y, 1.0);
    const cv::Vec3d point = rotation.t() * (ray * (normal.dot(t) / normal.dot(ray)) - t);
    const double u = point[0] / kSquare + 1.0;  // in squares from the board's edge
    const double v = point[1] / kSquare + 1.0;
    if (u < -1.0 || v < -1.0 || u > 11.0 || v > 8.0) continue;
    const bool inside = u >= 0.0 && v >= 0.0 && u < 10.0 && v < 7.0;
    const bool black = inside && ink(u, v);
    picture.at<std::uint8_t>(static_cast<int>(pixels[k].y), static_cast<int>(pixels[k].x)) = black ? 30 : 220;
  }
  cv::GaussianBlur(picture, picture, {3, 3}, 0.8);
  return picture;
}

// Twelve, in different places and tilts; `beyond`, m: the circle of the places, whose larger ones show a part of the
// board.
inline std::vector<cv::Mat> boardPictures(const BoardCamera& camera, const BoardInk& ink = chessboard,
                                          double beyond = 0.010) {
  std::vector<cv::Mat> pictures;
  for (int k = 0; k < 12; ++k) {
    const double angle = 2.0 * M_PI * k / 12.0;
    const cv::Vec3d r(0.5 * std::sin(angle), 0.5 * std::cos(angle), 0.1 * std::cos(3.0 * angle));
    const double far = 0.065 + 0.01 * (k % 3);
    pictures.push_back(boardPicture(
        camera, r, {-0.016 + beyond * std::cos(angle), -0.010 + 0.7 * beyond * std::sin(angle), far}, ink));
  }
  return pictures;
}

}  // namespace laparoscope_servo::test_support
