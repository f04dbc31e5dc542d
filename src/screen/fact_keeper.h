// Collects the messages of the nodes; thread-safe. Matches tracker results to preview images by stamp.
#pragma once

#include <laparoscope_servo/AreaSelection.h>
#include <laparoscope_servo/ControllerState.h>
#include <laparoscope_servo/Homography.h>
#include <laparoscope_servo/OperatingState.h>
#include <laparoscope_servo/TrackedFeatures.h>
#include <laparoscope_servo/TrackerState.h>
#include <sensor_msgs/Image.h>

#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "screen/facts.h"
#include "screen/features/feature_keeper.h"
#include "screen/minute_history.h"

namespace laparoscope_servo::screen {

class FactKeeper {
 public:
  // `age`: s, of the image by its stamp on arrival; 0 if the clocks cannot be compared.
  void take(const sensor_msgs::Image& preview, double age, double now);
  // As above, of a tracker of features, where no region tracker runs.
  void take(const std::string& tracker, const sensor_msgs::Image& preview, double age, double now);
  // `delay`: s, since the image's stamp; NaN if the clocks cannot be compared.
  void take(const Homography& homography, double delay, double now);
  // Of the replay of a recorded case: what was said then.
  void takeRecorded(const Homography& homography);
  void take(const AreaSelection& areas);
  void take(const TrackerState& state, double now);
  void take(const ControllerState& state);
  void takeCommand(double now);
  void take(const OperatingState& state, double now);
  // Returns true if they are of the picture's own image. `tracker`: name of the node.
  bool take(const std::string& tracker, const TrackedFeatures& features, double now);
  void setFeatureTrackers(const std::vector<std::pair<std::string, bool>>& connected);
  void take(const Answer& answer);
  void change(const std::function<void(Facts&)>& change);

  Facts facts() const;
  std::vector<MinuteHistory::Step> minute(double now) const;

 private:
  void match();
  void show(const sensor_msgs::Image& preview, const std::function<QSize()>& original, double age, double now);

  mutable std::mutex mutex_;
  Facts facts_;
  MinuteHistory history_;
  std::deque<Result> results_;
  std::deque<Result> recorded_;
  std::deque<Areas> areas_;
  FeatureKeeper features_;
};

}  // namespace laparoscope_servo::screen
