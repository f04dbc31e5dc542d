#include "feature_task.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace laparoscope_servo::test {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();
constexpr std::size_t kFewest = 10;  // points

// An object in the middle of the image, where FOLLOW keeps it: 121 x 121 px, less than 5 % of it.
std::string objectInTheMiddle(const std::string& /*picture*/) {
  return "[{id: object, motion: [[259, 179], [380, 300]]}]";
}

double offsetOfObject(const TrackedFeatures& features) {
  if (features.state != TrackedFeatures::TRACKING || features.features.size() != 1) return kUnknown;
  const std::vector<double>& outline = features.features[0].outline;
  if (outline.size() < 8) return kUnknown;
  double x = 0.0, y = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    x += outline[2 * k] / 4.0;
    y += outline[2 * k + 1] / 4.0;
  }
  return std::hypot(x - 319.5, y - 239.5);
}

std::string wholeView(const std::string& /*picture*/) {
  return "[{id: view, motion: []}]";
}

double offsetOfView(const TrackedFeatures& features) {
  if (features.state != TrackedFeatures::TRACKING || features.features.size() != 2) return kUnknown;
  const std::vector<double>& a = features.features[0].parameters;
  return a.size() < 2 ? kUnknown : std::hypot(a[0], a[1]);
}

std::string pointsOfThePicture(const std::string& picture) {
  return "[{id: tissue, corners: {region: [180, 120, 280, 240], count: 40}, stored: " + picture + "}]";
}

double offsetOfPoints(const TrackedFeatures& features) {
  std::vector<double> offsets;
  for (const TrackedFeature& point : features.features) {
    if (point.state != TrackedFeatures::TRACKING || point.parameters.size() != 2 || point.desired.size() != 2) continue;
    offsets.push_back(std::hypot(point.parameters[0] - point.desired[0], point.parameters[1] - point.desired[1]));
  }
  if (offsets.size() < kFewest) return kUnknown;
  std::sort(offsets.begin(), offsets.end());
  return offsets[offsets.size() / 2];
}

}  // namespace

const FeatureTask kFollowTask{"FOLLOW", "motion", "DominantMotion", objectInTheMiddle, offsetOfObject};
const FeatureTask kPointsTask{"POINTS", "points", "Points", pointsOfThePicture, offsetOfPoints};
const FeatureTask kParallelTask{"PARALLEL", "motion", "DominantMotion", wholeView, offsetOfView};

std::vector<std::string> FeatureTask::arguments() const {
  return {"standalone", std::string("laparoscope_servo/") + nodelet, std::string("__name:=") + node,
          "image:=relayed/image_raw", "camera_info:=relayed/camera_info"};
}

void keepPicture(const cv::Mat& picture, const std::string& file) {
  if (!cv::imwrite(file, picture)) throw std::runtime_error("cannot write " + file);
}

}  // namespace laparoscope_servo::test
