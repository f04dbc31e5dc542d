#include "tracking/search/feature_search.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/version.hpp>
#include <opencv2/imgproc.hpp>

#include "laparoscope_servo/geometry/sl3.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kCells = 8;          // the image's features are spread over as many rows and columns of cells
constexpr int kSurplus = 4;        // how many times the features wanted are detected, to spread them
constexpr int kFastThreshold = 5;  // grey levels: tissue has little contrast
constexpr float kOctaveStep = 1.2f;
constexpr int kOctaves = 4;
constexpr int kEdge = 16;         // px, of the downscaled image: nothing is detected nearer to its border
constexpr int kGrowBright = 3;    // px, of the downscaled image
constexpr double kInlier = 4.0;   // px, of the downscaled image
constexpr int kManyInliers = 30;  // from here on eight parameters are better determined than four
constexpr int kMaxTrials = 1000;

#if CV_VERSION_MAJOR * 10000 + CV_VERSION_MINOR * 100 + CV_VERSION_REVISION >= 40501
constexpr int kRobustMethod = cv::USAC_MAGSAC;
#else
constexpr int kRobustMethod = cv::RANSAC;
#endif

// One channel, the weights' mixture brought into the range of 8 bits: negative weights would leave it.
cv::Mat1b oneChannel(const cv::Mat& image, const image::ChannelWeights& weights) {
  if (image.channels() == 1) return image;
  double low = 0.0;
  double high = 0.0;
  for (const float w : weights) (w < 0.0f ? low : high) += w;
  const double range = std::max(high - low, 1e-6);
  const cv::Matx14f mixture(static_cast<float>(weights[0] / range), static_cast<float>(weights[1] / range),
                            static_cast<float>(weights[2] / range), static_cast<float>(-255.0 * low / range));
  cv::Mat1b grey;
  cv::transform(image, grey, mixture);
  return grey;
}

// The strongest of each cell, so that an instrument does not take all of them.
void spreadOut(std::vector<cv::KeyPoint>& points, const cv::Size& size, int count) {
  std::vector<std::vector<cv::KeyPoint>> cells(kCells * kCells);
  for (const cv::KeyPoint& point : points) {
    const int row = std::clamp(static_cast<int>(point.pt.y * kCells / static_cast<float>(size.height)), 0, kCells - 1);
    const int column =
        std::clamp(static_cast<int>(point.pt.x * kCells / static_cast<float>(size.width)), 0, kCells - 1);
    cells[row * kCells + column].push_back(point);
  }
  points.clear();
  for (std::vector<cv::KeyPoint>& cell : cells) {
    cv::KeyPointsFilter::retainBest(cell, std::max(1, count / (kCells * kCells)));
    points.insert(points.end(), cell.begin(), cell.end());
  }
}

cv::Size downscaled(const cv::Size& size, double scale) {
  return {std::max(1, cvRound(size.width / scale)), std::max(1, cvRound(size.height / scale))};
}

Eigen::Matrix3d toEigen(const cv::Mat& m) {
  Eigen::Matrix3d result = Eigen::Matrix3d::Identity();
  for (int r = 0; r < m.rows; ++r) {
    for (int c = 0; c < 3; ++c) result(r, c) = m.at<double>(r, c);
  }
  return result;
}

// Raw points to rectified ones; those that the lens cannot have shown are dropped.
void rectify(const image::Lens& lens, Features& features) {
  int kept = 0;
  for (std::size_t k = 0; k < features.points.size(); ++k) {
    const auto p = lens.toRectified(Eigen::Vector2d(features.points[k].x, features.points[k].y));
    if (!p) continue;
    features.points[kept] = cv::Point2f(static_cast<float>(p->x()), static_cast<float>(p->y()));
    if (kept != static_cast<int>(k))
      features.descriptors.row(static_cast<int>(k)).copyTo(features.descriptors.row(kept));
    ++kept;
  }
  features.points.resize(kept);
  if (!features.descriptors.empty()) features.descriptors.resize(kept);
}

}  // namespace

FeatureSearch::FeatureSearch(const TrackerConfig& config, std::shared_ptr<const image::Lens> lens)
    : config_(config.search),
      saturation_(config.esm.saturation),
      max_area_ratio_(config.quality.max_area_ratio),
      lens_(std::move(lens)),
      many_(cv::ORB::create(kSurplus * config_.max_features, kOctaveStep, kOctaves, kEdge, 0, 2, cv::ORB::HARRIS_SCORE,
                            31, kFastThreshold)),
      few_(cv::ORB::create(config_.max_features / 2, kOctaveStep, kOctaves, kEdge, 0, 2, cv::ORB::HARRIS_SCORE, 31,
                           kFastThreshold)) {}

bool FeatureSearch::plausible(const Eigen::Matrix3d& g, const geometry::Rectangle& roi) const {
  if (!g.allFinite() || !(g.determinant() > 0.0)) return false;
  const geometry::Quadrilateral corners = geometry::apply(g, roi.corners());
  if (!geometry::isConvex(corners)) return false;
  const double ratio = geometry::signedArea(corners) / geometry::signedArea(roi.corners());
  return std::max(ratio, 1.0 / ratio) <= max_area_ratio_;
}

Features FeatureSearch::draw(const cv::Mat& image, const cv::Point& first, const cv::Mat1b& mask, double scale,
                             const image::ChannelWeights& weights, int count, bool spread) {
  Features features;
  const cv::Size size = downscaled(image.size(), scale);
  if (std::min(size.width, size.height) <= 2 * kEdge) return features;
  cv::Mat small;
  if (scale > 1.0) {
    cv::resize(image, small, size, 0.0, 0.0, cv::INTER_AREA);
  } else {
    small = image;
  }
  cv::Mat1b usable;
  cv::inRange(small, cv::Scalar::all(0), cv::Scalar::all(saturation_ - 1), usable);  // highlights move with the lamp
  cv::erode(usable, usable, cv::Mat(), cv::Point(-1, -1), kGrowBright);
  if (!mask.empty()) {
    cv::Mat1b wanted;
    cv::resize(mask, wanted, size, 0.0, 0.0, cv::INTER_NEAREST);
    usable &= wanted;
  }
  const cv::Mat1b grey = oneChannel(small, weights);
  std::vector<cv::KeyPoint> points;
  if (spread) {
    many_->detect(grey, points, usable);
    spreadOut(points, size, count);
    many_->compute(grey, points, features.descriptors);
  } else {
    few_->detectAndCompute(grey, usable, points, features.descriptors);
  }
  const double sx = static_cast<double>(image.cols) / size.width;
  const double sy = static_cast<double>(image.rows) / size.height;
  features.points.reserve(points.size());
  for (const cv::KeyPoint& point : points) {
    features.points.emplace_back(static_cast<float>((point.pt.x + 0.5) * sx - 0.5 + first.x),
                                 static_cast<float>((point.pt.y + 0.5) * sy - 0.5 + first.y));
  }
  if (lens_) rectify(*lens_, features);
  return features;
}

void FeatureSearch::describe(Keyframe& view, const geometry::Rectangle& roi, double scale,
                             const image::ChannelWeights& weights) {
  // Where the crop shows what can be trusted of the ROI.
  Eigen::Matrix3d from_roi = Eigen::Matrix3d::Identity();
  from_roi.topRightCorner<2, 1>() << roi.x, roi.y;
  cv::Mat1b mask;
  image::drawMask(view.trusted, view.g * from_roi, lens_.get(), cv::Rect(view.first, view.crop.size()), mask);
  view.features = draw(view.crop, view.first, mask, scale, weights, config_.max_features / 2, false);
  view.described = true;
}

std::vector<FeatureCandidate> FeatureSearch::find(const cv::Mat& image, const image::ChannelWeights& weights,
                                                  Keyframes& keyframes) {
  std::vector<FeatureCandidate> found;
  if (keyframes.count() == 0) return found;
  const double scale = std::max(1.0, std::sqrt(static_cast<double>(image.total()) / config_.max_pixels));
  const Features seen = draw(image, cv::Point(0, 0), cv::Mat1b(), scale, weights, config_.max_features, true);
  if (static_cast<int>(seen.points.size()) < config_.min_inliers) return found;
  std::vector<int> asked = {0};
  if (keyframes.count() > 1) asked.push_back(1 + turn_++ % (keyframes.count() - 1));
  for (const int k : asked) {
    Keyframe& view = keyframes.at(k);
    if (!view.described) describe(view, keyframes.roi(), scale, weights);
    match(view, keyframes.roi(), seen, scale, found);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.inliers > b.inliers; });
  return found;
}

void FeatureSearch::match(const Keyframe& view, const geometry::Rectangle& roi, const Features& seen, double scale,
                          std::vector<FeatureCandidate>& found) const {
  if (static_cast<int>(view.features.points.size()) < config_.min_inliers) return;
  const cv::BFMatcher matcher(cv::NORM_HAMMING);
  std::vector<std::vector<cv::DMatch>> forth;
  std::vector<cv::DMatch> back;
  matcher.knnMatch(view.features.descriptors, seen.descriptors, forth, 2);
  matcher.match(seen.descriptors, view.features.descriptors, back);
  std::vector<cv::Point2f> from, to;
  for (const std::vector<cv::DMatch>& pair : forth) {
    if (pair.size() < 2 || !(pair[0].distance < config_.max_ratio * pair[1].distance)) continue;
    if (back[pair[0].trainIdx].trainIdx != pair[0].queryIdx) continue;
    from.push_back(view.features.points[pair[0].queryIdx]);
    to.push_back(seen.points[pair[0].trainIdx]);
  }
  if (static_cast<int>(from.size()) < config_.min_inliers) return;
  const auto offer = [&](const cv::Mat& motion, const cv::Mat& agree, int at_least) {
    if (motion.empty() || agree.empty()) return;
    const int inliers = cv::countNonZero(agree);
    const Eigen::Matrix3d g = toEigen(motion) * view.g;
    if (inliers >= at_least && plausible(g, roi)) found.push_back({geometry::normaliseDeterminant(g), inliers});
  };
  // Four parameters hold where few matches would let eight run away; what they miss of the tilt, the alignment mends.
  cv::Mat agree;
  const cv::Mat similarity =
      cv::estimateAffinePartial2D(from, to, agree, cv::RANSAC, kInlier * scale, kMaxTrials, 0.99);
  offer(similarity, agree, config_.min_inliers);
  if (static_cast<int>(from.size()) < kManyInliers) return;
  const cv::Mat homography = cv::findHomography(from, to, kRobustMethod, kInlier * scale, agree, kMaxTrials, 0.99);
  offer(homography, agree, kManyInliers);
}

}  // namespace laparoscope_servo::tracking
