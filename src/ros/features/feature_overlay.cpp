#include "ros/features/feature_overlay.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "laparoscope_servo/motion/motion_model.h"
#include "ros/tracker/overlay.h"

namespace laparoscope_servo {

namespace {

using features::State;

const cv::Scalar kRed(0, 0, 255);
const cv::Scalar kYellow(0, 255, 255);
constexpr double kMagnified = 5.0;  // arrows of a field of motion, from image to image
constexpr int kShift = 4;           // OpenCV draws in 1/16 px
constexpr double kFarAway = 1e5;    // px: further points are not drawn, since fixed-point coordinates would overflow

// Empty if a point cannot be drawn.
std::vector<cv::Point> drawable(const std::vector<Eigen::Vector2d>& outline) {
  std::vector<cv::Point> points;
  for (const Eigen::Vector2d& p : outline) {
    if (!(p.array().abs() < kFarAway).all()) return {};  // also for NaN
    points.emplace_back(static_cast<int>(std::lround(p.x() * (1 << kShift))),
                        static_cast<int>(std::lround(p.y() * (1 << kShift))));
  }
  return points;
}

void tint(cv::Mat& canvas, const cv::Mat& mask) {
  if (mask.size() != canvas.size()) return;
  cv::Mat blue;
  cv::addWeighted(canvas, 0.5, cv::Mat(canvas.size(), canvas.type(), cv::Scalar(255, 0, 0)), 0.5, 0.0, blue);
  blue.copyTo(canvas, mask);
}

void drawField(cv::Mat& canvas, const features::TrackedFeature& feature, int thickness) {
  motion::MotionField field;
  field.a.head(feature.parameters.size()) = feature.parameters;
  field.centre = Eigen::Vector2d(0.5 * (canvas.cols - 1), 0.5 * (canvas.rows - 1));
  const double step = canvas.cols / 12.0;
  for (double v = 0.5 * step; v < canvas.rows; v += step) {
    for (double u = 0.5 * step; u < canvas.cols; u += step) {
      const Eigen::Vector2d from(u, v);
      const std::vector<cv::Point> line = drawable({from, from + kMagnified * field.at(from)});
      if (line.empty()) continue;
      cv::arrowedLine(canvas, line[0], line[1], kRed, thickness, cv::LINE_AA, kShift, 0.3);
    }
  }
}

void drawFeature(cv::Mat& canvas, const features::TrackedFeature& feature, int thickness) {
  const std::vector<cv::Point> points = drawable(feature.outline);
  if (points.empty()) return;
  const bool seen = feature.state == State::kTracking;
  const cv::Scalar& colour = seen ? kRed : kYellow;
  const int line = seen ? thickness : 1;
  if (points.size() == 1) {
    cv::circle(canvas, points.front(), 3 * thickness << kShift, colour, line, cv::LINE_AA, kShift);
  } else {
    cv::polylines(canvas, points, false, colour, line, cv::LINE_AA, kShift);
  }
  // At its end, or where it is furthest to the right, where the text hides least of it.
  const cv::Point at =
      *std::max_element(points.begin(), points.end(), [](const cv::Point& a, const cv::Point& b) { return a.x < b.x; });
  const double size = std::max(0.35, canvas.rows / 1200.0);
  const int width = cv::getTextSize(feature.id, cv::FONT_HERSHEY_SIMPLEX, size, thickness, nullptr).width;
  const int left = std::clamp((at.x >> kShift) + 4 * thickness, 0, std::max(0, canvas.cols - width));
  drawText(canvas, feature.id, cv::Point(left, at.y >> kShift), size);
}

}  // namespace

cv::Mat drawFeatures(const cv::Mat& image, const features::TrackedFeatures& tracked, const cv::Mat& mask) {
  cv::Mat canvas = canvasOf(image);
  const int thickness = std::max(2, canvas.cols / 640);
  const auto isMotion = [](const auto& feature) { return feature.kind == features::FeatureKind::kMotion; };
  // The last one of a tracker is that from image to image.
  const auto motion = std::find_if(tracked.features.rbegin(), tracked.features.rend(), isMotion);
  if (motion != tracked.features.rend() && motion->state == State::kTracking) {
    tint(canvas, mask);
    drawField(canvas, *motion, thickness);
  }
  std::size_t seen = 0;
  for (const features::TrackedFeature& feature : tracked.features) {
    if (feature.state == State::kTracking) ++seen;
    if (feature.state == State::kTracking || feature.state == State::kSearching)
      drawFeature(canvas, feature, thickness);
  }
  std::string text = features::stateName(tracked.state);
  if (!tracked.features.empty()) text += "  " + std::to_string(seen) + " of " + std::to_string(tracked.features.size());
  if (!tracked.reason.empty()) text += "  " + tracked.reason;
  drawCaption(canvas, text);
  return canvas;
}

}  // namespace laparoscope_servo
