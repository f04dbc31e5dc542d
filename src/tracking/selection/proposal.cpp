#include "tracking/selection/proposal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "tracking/align/region_aligner.h"
#include "tracking/roi_check.h"
#include "tracking/search/coarse_image.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr int kMostPixels = 250000;  // of the coarse image: texture of 2 px of a 1080p image still shows
constexpr int kSaturated = 250;      // grey levels
constexpr std::array<double, 4> kScales = {1.0, 1.25, 1.6, 2.0};
constexpr double kFurthest = 1.5;  // sides of the region, a shift
constexpr int kShifts = 6;         // of a side, in each direction
constexpr int kMostAsked = 5;
constexpr double kMoreTexture = 2.0;  // of what was not enough, is looked for next
// Of min_texture, what noise may do in a region that is proposed. Of 92 regions on eight films the 60 in which it did
// less than this were held for a second in 42 cases, the others in 15 of 32.
constexpr double kClearly = 0.3;
constexpr double kMostCovered = 0.05;  // share of a region

struct Candidate {
  geometry::Rectangle roi;
  double difference;  // from what was wanted: its shift in sides of the region, and how often it is doubled
  double texture;
};

// Sums of products of the gradient over any box, and of what is covered.
class Texture {
 public:
  Texture(const cv::Mat& image, const cv::Mat& covered, const image::Lens* lens) : lens_(lens) {
    const CoarseImage coarse = coarseImage(image, coarseScale(image.size(), kMostPixels), image::kLuma, kSaturated);
    scale_ = coarse.scale;
    cv::Mat1f dx, dy;
    cv::Sobel(coarse.grey, dx, CV_32F, 1, 0, 1, 0.5);
    cv::Sobel(coarse.grey, dy, CV_32F, 0, 1, 1, 0.5);
    dx.setTo(0.0f, coarse.usable == 0);
    dy.setTo(0.0f, coarse.usable == 0);
    if (!covered.empty()) {
      cv::Mat1b hidden;
      cv::resize(covered != 0, hidden, coarse.grey.size(), 0, 0, cv::INTER_NEAREST);
      cv::integral(hidden, hidden_, CV_64F);
      cv::dilate(hidden, hidden, cv::Mat());  // its border is no texture of the tissue
      dx.setTo(0.0f, hidden);
      dy.setTo(0.0f, hidden);
    }
    cv::integral(dx.mul(dx), xx_, CV_64F);
    cv::integral(dx.mul(dy), xy_, CV_64F);
    cv::integral(dy.mul(dy), yy_, CV_64F);
  }

  // In the direction in which there is least; 0 outside the image.
  double in(const geometry::Rectangle& roi) const {
    const cv::Rect box = coarseBox(roi);
    const double xx = sum(xx_, box), xy = sum(xy_, box), yy = sum(yy_, box);
    return 0.5 * (xx + yy - std::hypot(xx - yy, 2.0 * xy));
  }
  // Share of it.
  double coveredIn(const geometry::Rectangle& roi) const {
    const cv::Rect box = coarseBox(roi);
    return hidden_.empty() || box.empty() ? 0.0 : sum(hidden_, box) / (255.0 * box.area());
  }

 private:
  cv::Rect coarseBox(const geometry::Rectangle& roi) const {
    const cv::Rect seen = image::seenBox(lens_, roi.corners(), 0.0);
    const cv::Rect coarse(cv::Point(seen.x / scale_, seen.y / scale_),
                          cv::Point((seen.x + seen.width) / scale_, (seen.y + seen.height) / scale_));
    return coarse & cv::Rect(0, 0, xx_.cols - 1, xx_.rows - 1);
  }
  static double sum(const cv::Mat1d& integral, const cv::Rect& box) {
    return integral(box.br()) - integral(box.y, box.x + box.width) - integral(box.y + box.height, box.x) +
           integral(box.tl());
  }

  const image::Lens* lens_;
  int scale_ = 1;
  cv::Mat1d xx_, xy_, yy_;
  cv::Mat1d hidden_;  // empty: nothing is covered
};

std::vector<Candidate> candidates(const geometry::Rectangle& wanted, const cv::Rect& whole, const Texture& texture) {
  std::vector<Candidate> found;
  for (const double scale : kScales) {
    for (int i = -kShifts; i <= kShifts; ++i) {
      for (int j = -kShifts; j <= kShifts; ++j) {
        const double right = kFurthest * i / kShifts, down = kFurthest * j / kShifts;  // sides
        geometry::Rectangle roi;
        roi.width = std::floor(scale * wanted.width);
        roi.height = std::floor(scale * wanted.height);
        roi.x = std::floor(wanted.x + right * wanted.width - 0.5 * (roi.width - wanted.width));
        roi.y = std::floor(wanted.y + down * wanted.height - 0.5 * (roi.height - wanted.height));
        if (!(roi.x >= whole.x && roi.y >= whole.y && roi.x + roi.width <= whole.br().x &&
              roi.y + roi.height <= whole.br().y))
          continue;
        if (texture.coveredIn(roi) > kMostCovered) continue;
        found.push_back({roi, std::hypot(right, down) + std::log2(scale), texture.in(roi)});
      }
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Candidate& a, const Candidate& b) { return a.difference < b.difference; });
  return found;
}

}  // namespace

std::optional<geometry::Rectangle> proposeRegion(const cv::Mat& image, const cv::Mat& covered,
                                                 const geometry::Rectangle& wanted, const image::Lens* lens,
                                                 const std::function<bool(const geometry::Rectangle&)>& would_do) {
  const cv::Rect whole =
      lens != nullptr ? image::rectifiedBox(*lens, image.size()) : cv::Rect(cv::Point(0, 0), image.size());
  const Texture texture(image, covered, lens);
  double too_little = texture.in(wanted);
  int asked = 0;
  for (const Candidate& candidate : candidates(wanted, whole, texture)) {
    if (!(candidate.texture > kMoreTexture * too_little)) continue;
    if (would_do(candidate.roi)) return candidate.roi;
    if (++asked == kMostAsked) break;
    too_little = candidate.texture;
  }
  return std::nullopt;
}

std::optional<geometry::Rectangle> proposeRegion(const cv::Mat& image, const geometry::Rectangle& wanted,
                                                 const TrackerConfig& config,
                                                 const std::shared_ptr<const image::Lens>& lens) {
  checkImage(image);
  if (!(wanted.width >= 1.0 && wanted.height >= 1.0) ||
      !std::isfinite(wanted.x + wanted.y + wanted.width + wanted.height))
    throw std::invalid_argument("the ROI is too small, expected at least 1 px in width and height, and finite numbers");
  geometry::Rectangle least = wanted;
  least.width = std::max<double>(wanted.width, config.min_roi_side);
  least.height = std::max<double>(wanted.height, config.min_roi_side);
  TrackerConfig clearly = config;
  clearly.min_texture *= kClearly;
  RegionAligner aligner(clearly, lens);
  const SelectionMask selectable(image, cv::Mat());
  return proposeRegion(image, selectable.mask(), least, lens.get(), [&](const geometry::Rectangle& roi) {
    try {
      takeReference(image, roi, selectable, clearly, lens.get(), aligner);
      return true;
    } catch (const std::invalid_argument&) {
      return false;
    }
  });
}

}  // namespace laparoscope_servo::tracking
