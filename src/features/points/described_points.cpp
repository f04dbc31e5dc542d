#include "laparoscope_servo/features/described_points.h"

#include <algorithm>
#include <opencv2/core/version.hpp>
#include <opencv2/features2d.hpp>
#include <vector>

namespace laparoscope_servo::features {

namespace {

constexpr int kLeastSide = 16;  // px: smaller images have no points
constexpr int kLayers = 3;      // layers of an octave

#if CV_VERSION_MAJOR * 10000 + CV_VERSION_MINOR * 100 >= 40400
constexpr int kNorm = cv::NORM_L2;
constexpr double kContrast = 0.005;  // an eighth of OpenCV's default, since tissue has little contrast

// Computing descriptors takes most of the time, so weak points are dropped before it. SIFT's own limit applies before
// the mask and would keep highlights.
void detect(const cv::Mat1b& grey, const cv::Mat1b& mask, int count, std::vector<cv::KeyPoint>& points,
            cv::Mat& descriptors) {
  const auto sift = cv::SIFT::create(0, kLayers, kContrast);
  sift->detect(grey, points, mask);
  cv::KeyPointsFilter::retainBest(points, count);
  sift->compute(grey, points, descriptors);
}
#else
constexpr int kNorm = cv::NORM_HAMMING;
constexpr float kResponse = 1e-5f;  // a hundredth of OpenCV's default

void detect(const cv::Mat1b& grey, const cv::Mat1b& mask, int count, std::vector<cv::KeyPoint>& points,
            cv::Mat& descriptors) {
  const auto akaze = cv::AKAZE::create(cv::AKAZE::DESCRIPTOR_MLDB, 0, 3, kResponse, kLayers, kLayers);
  akaze->detect(grey, points, mask);
  cv::KeyPointsFilter::retainBest(points, count);
  akaze->compute(grey, points, descriptors);
}
#endif

}  // namespace

cv::Mat1f descriptorDistances(const DescribedPoints& a, const DescribedPoints& b) {
  cv::Mat distances;
  cv::batchDistance(a.descriptors, b.descriptors, distances, -1, cv::noArray(), kNorm);
  cv::Mat1f result;
  distances.convertTo(result, CV_32F);
  return result;
}

DescribedPoints drawPoints(const cv::Mat1b& grey, const cv::Mat1b& mask, int count) {
  DescribedPoints drawn;
  if (std::min(grey.cols, grey.rows) < kLeastSide) return drawn;
  std::vector<cv::KeyPoint> points;
  detect(grey, mask, count, points, drawn.descriptors);
  drawn.points.reserve(points.size());
  for (const cv::KeyPoint& point : points) drawn.points.push_back(point.pt);
  return drawn;
}

}  // namespace laparoscope_servo::features
