#include "ros/tracker/overlay.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

namespace laparoscope_servo {

namespace {

using tracking::State;

const cv::Scalar kBlue(255, 0, 0);
const cv::Scalar kRed(0, 0, 255);
const cv::Scalar kWhite(255, 255, 255);
const cv::Scalar kBlack(0, 0, 0);
constexpr int kBentPieces = 16;   // pieces in which an edge is drawn, since a lens bends it
constexpr int kShift = 4;         // OpenCV draws in 1/16 px
constexpr double kFarAway = 1e5;  // px: further points are not drawn, since fixed-point coordinates would overflow

// The quadrilateral's outline in the image, each edge in `pieces`. Empty if a point cannot be drawn.
std::vector<cv::Point> drawable(const geometry::Quadrilateral& corners, const image::Lens* lens, int pieces) {
  std::vector<cv::Point> points;
  for (int k = 0; k < 4; ++k) {
    for (int piece = 0; piece < pieces; ++piece) {
      Eigen::Vector2d p = corners[k] + static_cast<double>(piece) / pieces * (corners[(k + 1) % 4] - corners[k]);
      if (lens != nullptr) {
        const auto raw = lens->toRaw(p);
        if (!raw) return {};
        p = *raw;
      }
      if (!(p.array().abs() < kFarAway).all()) return {};  // also for NaN
      points.emplace_back(static_cast<int>(std::lround(p.x() * (1 << kShift))),
                          static_cast<int>(std::lround(p.y() * (1 << kShift))));
    }
  }
  return points;
}

void drawQuadrilateral(cv::Mat& canvas, const geometry::Quadrilateral& corners, const image::Lens* lens,
                       const cv::Scalar& colour, int thickness) {
  const std::vector<cv::Point> points = drawable(corners, lens, lens != nullptr ? kBentPieces : 1);
  if (!points.empty()) cv::polylines(canvas, points, true, colour, thickness, cv::LINE_AA, kShift);
}

// The edges of the area's pixels, half a pixel around their centres.
geometry::Quadrilateral areaCorners(const tracking::TrackResult& result, int row, int column) {
  const geometry::Rectangle& roi = result.roi;
  const double left = roi.x - 0.5 + roi.width * column / result.areas.columns;
  const double right = roi.x - 0.5 + roi.width * (column + 1) / result.areas.columns;
  const double top = roi.y - 0.5 + roi.height * row / result.areas.rows;
  const double bottom = roi.y - 0.5 + roi.height * (row + 1) / result.areas.rows;
  return {Eigen::Vector2d(left, top), Eigen::Vector2d(right, top), Eigen::Vector2d(right, bottom),
          Eigen::Vector2d(left, bottom)};
}

void drawOccludedAreas(cv::Mat& canvas, const tracking::TrackResult& result, const image::Lens* lens) {
  const tracking::AreaReport& areas = result.areas;
  cv::Mat mask;
  for (int row = 0; row < areas.rows; ++row) {
    for (int column = 0; column < areas.columns; ++column) {
      const std::size_t index = static_cast<std::size_t>(row) * areas.columns + column;
      if (index >= areas.occluded.size() || !areas.occluded[index]) continue;
      const std::vector<cv::Point> points =
          drawable(geometry::apply(result.g, areaCorners(result, row, column)), lens, 1);
      if (points.empty()) continue;
      if (mask.empty()) mask = cv::Mat::zeros(canvas.size(), CV_8UC1);
      cv::fillConvexPoly(mask, points, cv::Scalar(255), cv::LINE_8, kShift);
    }
  }
  if (mask.empty()) return;
  cv::Mat blended;
  cv::addWeighted(canvas, 0.5, cv::Mat(canvas.size(), CV_8UC3, kBlue), 0.5, 0.0, blended);
  blended.copyTo(canvas, mask);
}

void drawState(cv::Mat& canvas, const tracking::TrackResult& result) {
  std::string text = tracking::stateName(result.state);
  if (result.state != State::kIdle) {
    text += "  visible " + std::to_string(std::lround(100.0 * result.visible_fraction)) + " %";
  }
  if (!result.reason.empty()) text += "  " + result.reason;
  drawCaption(canvas, text);
}

}  // namespace

cv::Mat canvasOf(const cv::Mat& image) {
  cv::Mat canvas;
  if (image.channels() == 1) {
    cv::cvtColor(image, canvas, cv::COLOR_GRAY2BGR);
  } else {
    canvas = image.clone();
  }
  return canvas;
}

void drawText(cv::Mat& canvas, const std::string& text, const cv::Point& left_bottom, double size) {
  const int thickness = std::max(1, static_cast<int>(std::lround(size * 1.5)));
  cv::putText(canvas, text, left_bottom, cv::FONT_HERSHEY_SIMPLEX, size, kBlack, 3 * thickness, cv::LINE_AA);
  cv::putText(canvas, text, left_bottom, cv::FONT_HERSHEY_SIMPLEX, size, kWhite, thickness, cv::LINE_AA);
}

void drawCaption(cv::Mat& canvas, const std::string& text) {
  const double size = std::max(0.35, canvas.rows / 900.0);
  drawText(canvas, text, cv::Point(static_cast<int>(12 * size), static_cast<int>(32 * size)), size);
}

cv::Mat drawOverlay(const cv::Mat& image, const tracking::TrackResult& result, const image::Lens* lens) {
  cv::Mat canvas = canvasOf(image);
  if (result.state != State::kIdle) {
    const int thickness = std::max(2, canvas.cols / 640);
    const bool shown = result.state != State::kLost;
    if (shown) drawOccludedAreas(canvas, result, lens);
    drawQuadrilateral(canvas, result.roi.corners(), lens, kBlue, thickness);
    if (shown) {
      const int line = result.state == State::kTracking ? thickness : 1;
      drawQuadrilateral(canvas, geometry::apply(result.g, result.roi.corners()), lens, kRed, line);
    }
  }
  drawState(canvas, result);
  return canvas;
}

}  // namespace laparoscope_servo
