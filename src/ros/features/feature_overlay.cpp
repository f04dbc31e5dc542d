#include "ros/features/feature_overlay.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "laparoscope_servo/motion/motion_model.h"
#include "ros/tracker/overlay.h"

namespace laparoscope_servo {

namespace {

using features::State;

const cv::Scalar kRed(0, 0, 255);
const cv::Scalar kYellow(0, 255, 255);
constexpr double kMagnified = 5.0;  // arrows of a field of motion, from image to image
const cv::Scalar kGreen(80, 255, 80);
const cv::Scalar kWhite(255, 255, 255);
const cv::Scalar kBlack(0, 0, 0);
constexpr double kSiteSpacing = 9.0;  // px between sites that are drawn, for lines of 2 px: their largest dots just fit
constexpr int kShift = 4;             // OpenCV draws in 1/16 px
constexpr double kFarAway = 1e5;      // px: further points are not drawn, since fixed-point coordinates would overflow

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

// A dot, larger the more the fit believed the site, a cross where it did not. Of sites closer together than can be seen
// one is drawn.
void drawSites(cv::Mat& canvas, const std::vector<features::TrackedSite>& sites, int thickness) {
  const double unit = 0.5 * thickness;
  const features::TrackedSite* last = nullptr;
  for (const features::TrackedSite& site : sites) {
    if (last != nullptr && (site.point - last->point).norm() < kSiteSpacing * unit) continue;
    const std::vector<cv::Point> at = drawable({site.point});
    if (at.empty()) continue;
    last = &site;
    const auto length = [unit](double px) { return static_cast<int>(std::lround(px * unit * (1 << kShift))); };
    if (site.weight > 0.0) {
      const int radius = length(1.2 + 2.3 * std::min(site.weight, 1.0));
      cv::circle(canvas, at[0], radius + length(1.0), kBlack, cv::FILLED, cv::LINE_AA, kShift);
      cv::circle(canvas, at[0], radius, kGreen, cv::FILLED, cv::LINE_AA, kShift);
      continue;
    }
    const cv::Point arm(length(3.0), length(3.0)), other(arm.x, -arm.y);
    for (const auto& [colour, width] : {std::pair(kBlack, thickness + 1), {kWhite, std::max(1, thickness / 2)}}) {
      cv::line(canvas, at[0] - arm, at[0] + arm, colour, width, cv::LINE_AA, kShift);
      cv::line(canvas, at[0] - other, at[0] + other, colour, width, cv::LINE_AA, kShift);
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
  drawSites(canvas, feature.sites, thickness);
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
