#include "tracking/roi_check.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "laparoscope_servo/image/image_type.h"
#include "laparoscope_servo/tracking/external_masks.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr double kMostBeyond = 0.5;        // share of a ROI that may lie beyond the endoscope's field of view
constexpr double kMostOnInstrument = 0.5;  // the same, that an instrument covers

// Every pixel of the border, through the lens: what is one to one takes the inside of the border to the inside. False
// for NaN.
bool shows(const cv::Mat& image, const geometry::Rectangle& roi, const image::Lens& lens) {
  const double longest_side = 65536.0;
  if (!(roi.width <= longest_side && roi.height <= longest_side)) return false;
  const auto seen = [&](double x, double y) {
    const auto raw = lens.toRaw(Eigen::Vector2d(x, y));
    return raw && raw->x() >= 0.0 && raw->y() >= 0.0 && raw->x() <= image.cols - 1.0 && raw->y() <= image.rows - 1.0;
  };
  const double right = roi.x + roi.width - 1.0;
  const double bottom = roi.y + roi.height - 1.0;
  for (double x = roi.x; x <= right; x += 1.0) {
    if (!seen(x, roi.y) || !seen(x, bottom)) return false;
  }
  for (double y = roi.y; y <= bottom; y += 1.0) {
    if (!seen(roi.x, y) || !seen(right, y)) return false;
  }
  return std::isfinite(right) && std::isfinite(bottom);
}

bool shows(const cv::Mat& image, const geometry::Rectangle& roi) {
  return roi.x >= 0.0 && roi.y >= 0.0 && roi.x + roi.width <= image.cols && roi.y + roi.height <= image.rows;
}

std::string text(const geometry::Rectangle& roi) {
  std::ostringstream text;
  text << "ROI x=" << roi.x << " y=" << roi.y << " width=" << roi.width << " height=" << roi.height;
  return text.str();
}

}  // namespace

void checkImage(const cv::Mat& image) {
  if (image.empty()) throw std::invalid_argument("image is empty, expected at least one pixel");
  image::checkType(image);
}

geometry::Rectangle checkedRoi(const cv::Mat& image, const geometry::Rectangle& roi, int min_side,
                               const image::Lens* lens) {
  const std::string name = text(roi);
  const std::string size = std::to_string(image.cols) + " x " + std::to_string(image.rows);
  if (!(roi.width >= min_side) || !(roi.height >= min_side)) {
    throw std::invalid_argument(name + " is too small, expected at least " + std::to_string(min_side) +
                                " px in width and height");
  }
  const geometry::Rectangle whole{std::floor(roi.x), std::floor(roi.y), std::floor(roi.width), std::floor(roi.height)};
  if (!(lens != nullptr ? shows(image, whole, *lens) : shows(image, whole))) {
    throw std::invalid_argument(name + " is not inside the image of " + size + " px" +
                                (lens != nullptr ? ", as its lens shows it: the ROI is in rectified pixels" : ""));
  }
  return whole;
}

void checkWithinField(const geometry::Rectangle& roi, const image::FieldMask& field, const image::Lens* lens) {
  const double beyond = field.shareBeyond(image::seenBox(lens, roi.corners(), 0.0));
  if (beyond <= kMostBeyond) return;
  std::ostringstream message;
  message.precision(2);
  message << text(roi) << " lies beyond the picture's border, where it is black, by " << 100.0 * beyond
          << " %, expected at most " << 100.0 * kMostBeyond << " %";
  throw std::invalid_argument(message.str());
}

void checkClearOfInstruments(const geometry::Rectangle& roi, const cv::Mat& instruments, const image::Lens* lens) {
  geometry::Quadrilateral corners = roi.corners();
  for (Eigen::Vector2d& corner : corners) {
    if (lens != nullptr) corner = lens->toRaw(corner).value_or(corner);
  }
  const double share = coveredShare(instruments, corners);
  if (share <= kMostOnInstrument) return;
  std::ostringstream message;
  message << text(roi) << " lies on an instrument by " << std::lround(100.0 * share) << " %, expected at most "
          << 100.0 * kMostOnInstrument << " %";
  throw std::invalid_argument(message.str());
}

double checkedCornerError(RegionAligner& aligner, double max_error) {
  const ReferenceTexture texture = aligner.referenceTexture();
  if (texture.corner_error <= max_error) return texture.corner_error;
  std::ostringstream message;
  message.precision(3);
  message << text(aligner.roi()) << " has too little texture: " << texture.noise
          << " grey levels of noise would move a corner by " << texture.corner_error << " px, expected at most "
          << max_error;
  throw std::invalid_argument(message.str());
}

void checkTellingBlocks(const RegionAligner& aligner) {
  const BlockMatching& blocks = aligner.blocks();
  if (!blocks.hasRoom() || blocks.blocks() >= kTellingBlocks) return;
  std::ostringstream message;
  message << text(aligner.roi()) << " has too little texture: " << blocks.blocks() << " of "
          << BlockMatching::kMostBlocks << " pieces differ from what surrounds them, expected at least "
          << kTellingBlocks;
  throw std::invalid_argument(message.str());
}

double takeReference(const cv::Mat& image, const geometry::Rectangle& wanted, const SelectionMask& selectable,
                     const TrackerConfig& config, const image::Lens* lens, RegionAligner& aligner) {
  const geometry::Rectangle roi = checkedRoi(image, wanted, config.min_roi_side, lens);
  selectable.check(roi, lens);
  aligner.setMask(selectable.mask());
  aligner.setReference(image, roi);
  const double error = checkedCornerError(aligner, config.min_texture);
  checkTellingBlocks(aligner);
  return error;
}

double takeReference(const cv::Mat& image, const geometry::Rectangle& wanted, const cv::Mat& mask,
                     const TrackerConfig& config, const image::Lens* lens, RegionAligner& aligner) {
  checkImage(image);
  image::checkMask(mask, image);
  return takeReference(image, wanted, SelectionMask(image, mask), config, lens, aligner);
}

}  // namespace laparoscope_servo::tracking
