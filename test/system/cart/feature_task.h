// Tasks of the cart that go by a tracker of features: who tracks, what is selected where the scope has to be, and how
// far it is from there.
#pragma once

#include <laparoscope_servo/TrackedFeatures.h>

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace laparoscope_servo::test {

struct FeatureTask {
  const char* task;     // as select_task names it
  const char* node;     // which has its parameters in config/NODE.yaml, and says NODE/features
  const char* nodelet;  // without the package
  // Text for select_features. `picture`: file with what the camera shows there.
  std::string (*selection)(const std::string& picture);
  // px, from where the features have to be; infinite while they are not tracked.
  double (*offset)(const TrackedFeatures& features);

  std::vector<std::string> arguments() const;  // of its process
};

extern const FeatureTask kFollowTask, kPointsTask;

// Keeps a picture for the selection.
void keepPicture(const cv::Mat& picture, const std::string& file);

}  // namespace laparoscope_servo::test
