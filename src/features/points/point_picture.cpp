#include "features/points/point_picture.h"

#include <algorithm>
#include <cstddef>
#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::features {

namespace {

// As the search of the region tracker has them by default, chosen by bench_search.
constexpr int kMaxPixels = 120000;  // the level that is used has fewer, down to a quarter
constexpr int kMaxPoints = 600;
constexpr double kMaxRatio = 0.85;
constexpr int kMinInliers = 8;
constexpr double kInlier = 4.0;  // px of the reduced picture
constexpr int kGrow = 3;         // px of the reduced picture: highlights move with the lamp

}  // namespace

PointPicture::Reduced PointPicture::reduce(const PointImage& image) {
  int l = 0;
  while (l + 1 < image.levels() && image.level(l).total() > kMaxPixels) ++l;
  Reduced reduced;
  reduced.scale = 1 << l;
  image.level(l).convertTo(reduced.grey, CV_8U);
  cv::resize(image.usable(), reduced.usable, reduced.grey.size(), 0.0, 0.0, cv::INTER_NEAREST);
  cv::erode(reduced.usable, reduced.usable, cv::Mat(), cv::Point(-1, -1), kGrow);
  return reduced;
}

DescribedPoints PointPicture::describe(const Reduced& reduced) {
  DescribedPoints points = drawPoints(reduced.grey, reduced.usable, kMaxPoints);
  for (cv::Point2f& point : points.points) point *= reduced.scale;
  return points;
}

PointPicture::PointPicture(const PointImage& picture) : reduced_(reduce(picture)) {}

std::vector<AgreedMotion> PointPicture::find(const PointImage& image) {
  if (!described_) described_ = describe(reduced_);
  const Reduced reduced = reduce(image);
  const DescribedPoints seen = describe(reduced);
  std::vector<cv::Point2f> from, to;
  for (const auto& [known, found] : matchPoints(*described_, seen, kMaxRatio)) {
    from.push_back(described_->points[static_cast<std::size_t>(known)]);
    to.push_back(seen.points[static_cast<std::size_t>(found)]);
  }
  std::vector<AgreedMotion> motions = agreedMotions(from, to, kInlier * reduced.scale, kMinInliers);
  std::stable_sort(motions.begin(), motions.end(), [](const auto& a, const auto& b) { return a.inliers > b.inliers; });
  return motions;
}

}  // namespace laparoscope_servo::features
