#include "screen/fact_keeper.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "screen/features/feature_result.h"
#include "screen/preview_image.h"
#include "screen/region_message.h"

namespace laparoscope_servo::screen {

namespace {

constexpr std::size_t kKept = 64;  // results: one second at 60 Hz, longer than the delay of a preview

std::int64_t nanoseconds(const ros::Time& time) {
  return static_cast<std::int64_t>(time.toNSec());
}

Result resultOf(const Homography& homography) {
  Result result;
  result.stamp = nanoseconds(homography.header.stamp);
  result.reference_stamp = nanoseconds(homography.reference_stamp);
  result.state = homography.state;
  std::copy(homography.g.begin(), homography.g.end(), result.g.begin());
  std::copy(homography.corners.begin(), homography.corners.end(), result.corners.begin());
  result.visible_fraction = homography.visible_fraction;
  result.calibrated = homography.has_intrinsics != 0;
  return result;
}

bool samePicture(const QImage& a, const QImage& b) {
  if (a.size() != b.size()) return false;
  for (int row = 0; row < a.height(); ++row) {
    if (std::memcmp(a.constScanLine(row), b.constScanLine(row), 4 * static_cast<std::size_t>(a.width())) != 0)
      return false;
  }
  return true;
}

template <class Value>
void keep(std::deque<Value>& values, const Value& value) {
  values.push_back(value);
  if (values.size() > kKept) values.pop_front();
}

template <class Value>
std::optional<Value> at(const std::deque<Value>& values, std::int64_t stamp) {
  for (auto value = values.rbegin(); value != values.rend(); ++value) {
    if (value->stamp == stamp) return *value;
  }
  return std::nullopt;
}

}  // namespace

void FactKeeper::take(const sensor_msgs::Image& preview, double age, double now) {
  show(
      preview, [] { return QSize(); }, age, now);
}

void FactKeeper::take(const std::string& tracker, const sensor_msgs::Image& preview, double age, double now) {
  show(
      preview, [&] { return features_.imageOf(tracker); }, age, now);
}

void FactKeeper::show(const sensor_msgs::Image& preview, const std::function<QSize()>& original, double age,
                      double now) {
  const QImage image = previewImage(preview);
  if (image.isNull()) return;  // the last picture stays, and its age grows
  const std::lock_guard<std::mutex> lock(mutex_);
  Picture& picture = facts_.picture;
  if (picture.image.isNull() || !samePicture(picture.image, image)) picture.changed_at = now;
  picture.image = image;
  picture.original = original();
  picture.stamp = nanoseconds(preview.header.stamp);
  picture.arrived_at = now;
  picture.age_at_arrival = std::isfinite(age) ? age : 0.0;
  match();
}

void FactKeeper::takeRecorded(const Homography& homography) {
  const Result result = resultOf(homography);
  const std::lock_guard<std::mutex> lock(mutex_);
  keep(recorded_, result);
  if (result.stamp == facts_.picture.stamp) match();
}

void FactKeeper::take(const Homography& homography, double delay, double now) {
  const Result result = resultOf(homography);
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool region = homography.state != Homography::IDLE;
  const auto ofRegion = [region](double value) { return region ? value : std::numeric_limits<double>::quiet_NaN(); };
  history_.add(now, homography.state == Homography::TRACKING, ofRegion(homography.zncc),
               ofRegion(homography.corner_error), ofRegion(homography.visible_fraction), delay);
  facts_.tracker.result_at = now;
  keep(results_, result);
  if (result.stamp == facts_.picture.stamp) match();
}

void FactKeeper::take(const AreaSelection& message) {
  Areas areas;
  areas.stamp = nanoseconds(message.header.stamp);
  if (message.occluded.size() == std::size_t{message.rows} * message.columns) {
    areas.rows = message.rows;
    areas.columns = message.columns;
    areas.covered.assign(message.occluded.begin(), message.occluded.end());
    if (message.cause.size() == message.occluded.size()) areas.cause = message.cause;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  keep(areas_, areas);
  if (areas.stamp == facts_.picture.stamp) match();
}

void FactKeeper::match() {
  facts_.result = at(results_, facts_.picture.stamp);
  facts_.areas = at(areas_, facts_.picture.stamp);
  facts_.recorded = at(recorded_, facts_.picture.stamp);
  features_.match(facts_.picture.stamp);
}

bool FactKeeper::take(const std::string& tracker, const TrackedFeatures& message, double now) {
  const std::shared_ptr<const FeatureResult> result = featureResult(message);
  const std::lock_guard<std::mutex> lock(mutex_);
  features_.take(tracker, result, now);
  return result->stamp == facts_.picture.stamp;
}

void FactKeeper::setFeatureTrackers(const std::vector<std::pair<std::string, bool>>& connected) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const auto& [tracker, is_connected] : connected) features_.setConnected(tracker, is_connected);
}

void FactKeeper::take(const TrackerState& state, double now) {
  constexpr std::uint32_t kLargest = 1u << 20;
  const std::lock_guard<std::mutex> lock(mutex_);
  TrackerFacts& tracker = facts_.tracker;
  tracker.heard_at = now;
  tracker.state = state.state;
  tracker.reason = state.reason;
  tracker.view = state.view;
  const bool sane = state.width <= kLargest && state.height <= kLargest;
  tracker.width = sane ? static_cast<int>(state.width) : 0;
  tracker.height = sane ? static_cast<int>(state.height) : 0;
  tracker.reference_stamp = nanoseconds(state.reference_stamp);
  std::copy(state.region.begin(), state.region.end(), tracker.region.begin());
  tracker.proposal = pixelsOf(state.proposal);
}

void FactKeeper::take(const ControllerState& state) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ControllerFacts& controller = facts_.controller;
  controller.state = state.state;
  controller.task = state.task;
  controller.reason = state.reason;
  controller.caution = state.caution;
  controller.engaged = state.engaged != 0;
}

void FactKeeper::takeCommand(double now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  facts_.controller.heard_at = now;
}

void FactKeeper::take(const OperatingState& state, double now) {
  const std::lock_guard<std::mutex> lock(mutex_);
  facts_.robot.heard_at = now;
  facts_.robot.state = state.state;
  facts_.robot.reason = state.reason;
}

void FactKeeper::take(const Answer& answer) {
  const std::lock_guard<std::mutex> lock(mutex_);
  facts_.answer = answer;
}

void FactKeeper::change(const std::function<void(Facts&)>& change) {
  const std::lock_guard<std::mutex> lock(mutex_);
  change(facts_);
}

std::vector<MinuteHistory::Step> FactKeeper::minute(double now) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return history_.steps(now);
}

Facts FactKeeper::facts() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  Facts facts = facts_;
  facts.features = features_.facts();
  return facts;
}

}  // namespace laparoscope_servo::screen
