#include "model/edge_field.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::model {

namespace {

constexpr double kSobel = 4.0;   // Sobel's answer to a step of one grey level
constexpr double kStrong = 2.0;  // of the least contrast: an edge begins there, and goes on down to the least

cv::Mat1b reducedGrey(const cv::Mat& image, const cv::Rect& area, int level) {
  const cv::Rect inside = area & cv::Rect({0, 0}, image.size());
  cv::Mat grey, whole, reduced;
  if (image.channels() == 3) {
    cv::cvtColor(image(inside), grey, cv::COLOR_BGR2GRAY);
  } else {
    grey = image(inside);
  }
  // The last grey level goes on outside, where it makes no edges.
  cv::copyMakeBorder(grey, whole, inside.y - area.y, area.br().y - inside.br().y, inside.x - area.x,
                     area.br().x - inside.br().x, cv::BORDER_REPLICATE);
  const double scale = 1.0 / (1 << level);
  cv::resize(whole, reduced, cv::Size(), scale, scale, cv::INTER_AREA);
  return reduced;
}

}  // namespace

// By the direction modulo 180 degrees. Any bin for one that is not finite: nothing lies at its place.
int EdgeField::bin(const Eigen::Vector2d& normal) {
  double angle = std::atan2(normal.y(), normal.x());
  if (angle < 0.0) angle += M_PI;
  const double at = angle / M_PI * kBins;
  return at < kBins ? static_cast<int>(at) : 0;
}

Eigen::Vector2d EdgeField::toField(const Eigen::Vector2d& pixel) const {
  return (pixel - Eigen::Vector2d(origin_.x - 0.5, origin_.y - 0.5)) * scale_ - Eigen::Vector2d(0.5, 0.5);
}

void EdgeField::compute(const cv::Mat& image, const cv::Rect& area, int level, double min_contrast) {
  origin_ = area.tl();
  scale_ = 1.0 / (1 << level);
  cv::Mat1b grey = reducedGrey(image, area, level);
  cv::GaussianBlur(grey, grey, cv::Size(3, 3), 0.8);
  cv::Mat1s dx, dy;
  cv::Sobel(grey, dx, CV_16S, 1, 0);
  cv::Sobel(grey, dy, CV_16S, 0, 1);
  cv::Mat1b edges;
  cv::Canny(dx, dy, edges, kSobel * min_contrast, kSobel * kStrong * min_contrast, true);
  std::array<cv::Mat1b, kBins> none;
  for (cv::Mat1b& m : none) m = cv::Mat1b(grey.size(), 255);
  for (int v = 0; v < edges.rows; ++v) {
    for (int u = 0; u < edges.cols; ++u) {
      if (edges(v, u) == 0) continue;
      double angle = std::atan2(static_cast<double>(dy(v, u)), static_cast<double>(dx(v, u)));
      if (angle < 0.0) angle += M_PI;
      // In its own bin, and in the one that is next nearest.
      const double at = angle / M_PI * kBins;
      const int own = static_cast<int>(at) % kBins;
      const int next = (own + (at - std::floor(at) < 0.5 ? kBins - 1 : 1)) % kBins;
      none[static_cast<std::size_t>(own)](v, u) = 0;
      none[static_cast<std::size_t>(next)](v, u) = 0;
    }
  }
  for (std::size_t k = 0; k < kBins; ++k) {
    cv::distanceTransform(none[k], distance_[k], cv::DIST_L2, cv::DIST_MASK_3);
    cv::min(distance_[k], kFarthest, distance_[k]);
  }
}

double EdgeField::distance(const Eigen::Vector2d& place, const Eigen::Vector2d& normal, double& slope) const {
  const cv::Mat1f& map = distance_[static_cast<std::size_t>(bin(normal))];
  slope = 0.0;
  const double x = place.x(), y = place.y();
  if (!(x >= 0.0 && y >= 0.0 && x < map.cols - 1.001 && y < map.rows - 1.001)) return kFarthest;
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const double a = x - i, b = y - j;
  const double p = map(j, i), q = map(j, i + 1), r = map(j + 1, i), s = map(j + 1, i + 1);
  slope = normal.x() * ((1.0 - b) * (q - p) + b * (s - r)) + normal.y() * ((1.0 - a) * (r - p) + a * (s - q));
  return (1.0 - b) * (p + a * (q - p)) + b * (r + a * (s - r));
}

}  // namespace laparoscope_servo::model
