#include "tracking/search/template_search.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "laparoscope_servo/geometry/sl3.h"
#include "laparoscope_servo/image/warp.h"

namespace laparoscope_servo::tracking {

namespace {

Eigen::Matrix3d translation(const Eigen::Vector2d& t) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m.topRightCorner<2, 1>() = t;
  return m;
}

}  // namespace

std::vector<Candidate> templateSearch(const cv::Mat1f& reference, const Eigen::Matrix3d& reference_T_patch,
                                      const cv::Mat1f& image, double scale, const geometry::Rectangle& roi,
                                      const Eigen::Matrix3d& last, int count) {
  // The ROI as `last` shows it, drawn into its bounding box.
  const geometry::Quadrilateral corners = geometry::apply(last, roi.corners());
  Eigen::Vector2d low = corners[0];
  Eigen::Vector2d high = corners[0];
  for (const Eigen::Vector2d& corner : corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const int width = static_cast<int>(std::ceil((high.x() - low.x()) / scale)) + 1;
  const int height = static_cast<int>(std::ceil((high.y() - low.y()) / scale)) + 1;
  std::vector<Candidate> candidates;
  if (!geometry::isConvex(corners) || width < 4 || height < 4 || width > image.cols || height > image.rows)
    return candidates;
  Eigen::Matrix3d image_T_box = Eigen::Matrix3d::Identity();
  image_T_box.topLeftCorner<2, 2>() *= scale;
  image_T_box.topRightCorner<2, 1>() = low;
  cv::Mat1f box(height, width);
  cv::Mat1f valid(height, width);
  const Eigen::Matrix3d patch_T_box = reference_T_patch.inverse() * last.inverse() * image_T_box;
  image::warpBilinear(reference, patch_T_box / patch_T_box(2, 2), box, valid);

  cv::Mat1f score;
  cv::matchTemplate(image, box, score, cv::TM_CCOEFF_NORMED);
  const Eigen::Vector2d first = low / scale;
  for (int k = 0; k < count; ++k) {
    double best = 0.0;
    cv::Point place;
    cv::minMaxLoc(score, nullptr, &best, nullptr, &place);
    if (!std::isfinite(best) || best <= 0.0) break;
    const Eigen::Vector2d shift = scale * (Eigen::Vector2d(place.x, place.y) - first);
    candidates.push_back({geometry::normaliseDeterminant(translation(shift) * last), best});
    const cv::Rect around(place.x - width / 4, place.y - height / 4, width / 2 + 1, height / 2 + 1);
    score(around & cv::Rect(0, 0, score.cols, score.rows)).setTo(-1.0f);
  }
  return candidates;
}

}  // namespace laparoscope_servo::tracking
