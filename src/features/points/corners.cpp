#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "features/points/affine_fit.h"
#include "features/points/point_image.h"
#include "laparoscope_servo/features/points.h"
#include "laparoscope_servo/image/image_type.h"

namespace laparoscope_servo::features {

namespace {

constexpr float kBlack = 16.0f;  // grey levels: the round border of a laparoscope's image, which does not move
constexpr int kSpare = 2;        // times as many candidates: not all of them can be told apart from their surroundings

// 255 where a whole window is usable.
cv::Mat1b wholeWindows(const PointImage& image, int window) {
  cv::Mat1b usable = image.usable() & (image.level(0) > kBlack) / 255;
  usable.row(0).setTo(0);
  usable.row(usable.rows - 1).setTo(0);
  usable.col(0).setTo(0);
  usable.col(usable.cols - 1).setTo(0);
  cv::erode(usable, usable, cv::getStructuringElement(cv::MORPH_RECT, {window, window}));
  return usable * 255;
}

}  // namespace

std::vector<Eigen::Vector2d> findCorners(const cv::Mat& image, const cv::Rect& region, int count,
                                         const PointsConfig& config) {
  image::checkType(image);
  const cv::Rect whole(cv::Point(0, 0), image.size());
  const cv::Rect wanted = region.empty() ? whole : region & whole;
  std::vector<Eigen::Vector2d> corners;
  if (wanted.empty() || count < 1) return corners;
  PointImage seen;
  seen.take(image, config.levels, config.saturation);
  cv::Mat1b mask(image.size(), static_cast<uchar>(0));
  wholeWindows(seen, config.window)(wanted).copyTo(mask(wanted));
  // Not all on the one spot with the most texture.
  const double distance = std::max(config.min_distance, 0.5 * std::sqrt(wanted.area() / static_cast<double>(count)));
  std::vector<cv::Point2f> candidates;
  cv::goodFeaturesToTrack(seen.level(0), candidates, kSpare * count, config.corner_quality, distance, mask,
                          config.window);  // the smaller eigenvalue of R, eq. (2)
  AffineFitter fitter(config);
  PointView view;
  for (const cv::Point2f& candidate : candidates) {
    if (static_cast<int>(corners.size()) == count) break;
    const Eigen::Vector2d place(candidate.x, candidate.y);
    if (!view.take(seen, place, config.window / 2)) continue;
    PointPose pose;
    pose.place = place;
    if (fitter.fit(view, seen, pose).reason == Reason::kNone) corners.push_back(place);
  }
  return corners;
}

}  // namespace laparoscope_servo::features
