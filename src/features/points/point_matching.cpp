#include "laparoscope_servo/features/point_matching.h"

#include <algorithm>
#include <cstddef>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/version.hpp>

namespace laparoscope_servo::features {

namespace {

constexpr int kManyInliers = 30;  // from here on a fit of eight parameters is better than one of four
constexpr int kMaxTrials = 1000;

#if CV_VERSION_MAJOR * 10000 + CV_VERSION_MINOR * 100 + CV_VERSION_REVISION >= 40501
constexpr int kRobustMethod = cv::USAC_MAGSAC;
#else
constexpr int kRobustMethod = cv::RANSAC;
#endif

Eigen::Matrix3d toEigen(const cv::Mat& m) {
  Eigen::Matrix3d result = Eigen::Matrix3d::Identity();
  for (int r = 0; r < m.rows; ++r) {
    for (int c = 0; c < 3; ++c) result(r, c) = m.at<double>(r, c);
  }
  return result;
}

}  // namespace

// Nearest and second nearest of `b` for each point of `a`, and nearest the other way round.
std::vector<std::pair<int, int>> matchPoints(const DescribedPoints& a, const DescribedPoints& b, double max_ratio) {
  std::vector<std::pair<int, int>> matches;
  if (a.points.empty() || b.points.empty()) return matches;
  const cv::Mat1f distance = descriptorDistances(a, b);
  std::vector<int> back(static_cast<std::size_t>(distance.cols), -1);
  for (int j = 0; j < distance.rows; ++j) {
    const float* row = distance[j];
    for (int i = 0; i < distance.cols; ++i) {
      int& nearest = back[static_cast<std::size_t>(i)];
      if (nearest < 0 || row[i] < distance(nearest, i)) nearest = j;
    }
  }
  for (int j = 0; j < distance.rows; ++j) {
    const float* row = distance[j];
    const int nearest = static_cast<int>(std::min_element(row, row + distance.cols) - row);
    if (back[static_cast<std::size_t>(nearest)] != j) continue;
    const double farthest = row[nearest] / max_ratio;
    const auto rival = [&](const float& other) { return &other != row + nearest && !(farthest < other); };
    if (!std::any_of(row, row + distance.cols, rival)) matches.emplace_back(j, nearest);
  }
  return matches;
}

std::vector<AgreedMotion> agreedMotions(const std::vector<cv::Point2f>& from, const std::vector<cv::Point2f>& to,
                                        double inlier, int min_inliers) {
  std::vector<AgreedMotion> agreed;
  if (static_cast<int>(from.size()) < min_inliers) return agreed;
  const auto offer = [&](const cv::Mat& motion, const cv::Mat& agree, int at_least) {
    if (motion.empty() || agree.empty()) return;
    const int inliers = cv::countNonZero(agree);
    if (inliers >= at_least) agreed.push_back({toEigen(motion), inliers});
  };
  cv::Mat agree;
  const cv::Mat similarity = cv::estimateAffinePartial2D(from, to, agree, cv::RANSAC, inlier, kMaxTrials, 0.99);
  offer(similarity, agree, min_inliers);
  if (static_cast<int>(from.size()) < kManyInliers) return agreed;
  const cv::Mat homography = cv::findHomography(from, to, kRobustMethod, inlier, agree, kMaxTrials, 0.99);
  offer(homography, agree, std::max(min_inliers, kManyInliers));
  return agreed;
}

}  // namespace laparoscope_servo::features
