#include "laparoscope_servo/features/instrument_mask.h"

#include <cmath>

#include "features/shafts/bright_edges.h"
#include "features/shafts/shaft_finder.h"
#include "features/shafts/silhouette.h"

namespace laparoscope_servo::features {

namespace {

constexpr double kTissue = 0.25;  // units of S0 cos H / mean: a picture that usually has less shows no tissue
// Less than kClearCoverage will do where the shaft is grey throughout and long, by the picture's diagonal.
constexpr double kFilled = 0.9;
constexpr double kLong = 0.2;

bool isBeyondDoubt(const cv::Mat& image, const GreyMap& map, const Shaft& shaft) {
  if (!shaft.seen[0] || !shaft.seen[1] || !(shaft.clarity >= kClearContrast)) return false;
  const double diagonal = std::hypot(map.columns(), map.rows());
  if (!(shaft.coverage >= kClearCoverage || (shaft.fill >= kFilled && shaft.length >= kLong * diagonal))) return false;
  return brightEdges(EdgeConfig(), image, map, shaft) > 0;
}

}  // namespace

cv::Mat instrumentMask(const cv::Mat& image) {
  if (image.type() != CV_8UC3 || image.cols < kLeastInstrumentImage || image.rows < kLeastInstrumentImage) return {};
  GreyMap map;
  map.compute(image);
  image::FieldOfView view;
  view.compute(map.level());
  const GreyLevels levels = greyLevels(map, view);
  if (!(levels.usual >= kTissue)) return {};
  ShaftFinder finder;
  cv::Mat1b mask;
  for (const Shaft& shaft : finder.find(map, view, levels)) {
    if (!isBeyondDoubt(image, map, shaft)) continue;
    if (mask.empty()) mask = cv::Mat1b::zeros(image.size());
    Silhouette silhouette;
    silhouette.grow(map, view, levels.threshold, shaft);
    silhouette.draw(map, levels.threshold, shaft, map.step(), mask);  // cells of the border are grey in part
  }
  return mask;
}

}  // namespace laparoscope_servo::features
