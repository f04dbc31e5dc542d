#include "screen/features/feature_result.h"

#include <algorithm>
#include <cmath>

#include "screen/region_message.h"

namespace laparoscope_servo::screen {

namespace {

// More could not be told apart in a picture, and would hold up the screen.
constexpr std::size_t kMostFeatures = 200;
constexpr std::size_t kMostPoints = 2000;  // of an outline
constexpr double kFarAway = 1e5;           // px

bool isDrawable(double pixel) {
  return std::abs(pixel) < kFarAway;  // also false for NaN
}

QPolygonF outlineOf(const std::vector<double>& numbers) {
  QPolygonF outline;
  for (std::size_t k = 0; k + 1 < numbers.size() && k < 2 * kMostPoints; k += 2) {
    if (!isDrawable(numbers[k]) || !isDrawable(numbers[k + 1])) return {};
    outline << QPointF(numbers[k], numbers[k + 1]);
  }
  return outline;
}

FeatureFact factOf(const TrackedFeature& message) {
  FeatureFact fact;
  fact.id = message.id;
  fact.kind = message.kind;
  fact.state = message.state;
  fact.parameters = message.parameters;
  const auto finite = [](double value) { return std::isfinite(value); };
  if (message.covariance.size() == message.parameters.size() * message.parameters.size() &&
      std::all_of(message.covariance.begin(), message.covariance.end(), finite))
    fact.covariance = message.covariance;
  fact.expected_error = message.expected_error;
  fact.radius = message.radius;
  fact.outline = outlineOf(message.outline);
  return fact;
}

}  // namespace

std::shared_ptr<const FeatureResult> featureResult(const TrackedFeatures& message) {
  auto result = std::make_shared<FeatureResult>();
  result->stamp = static_cast<std::int64_t>(message.header.stamp.toNSec());
  result->frame = message.header.frame_id;
  result->image = {side(message.width), side(message.height)};
  result->state = message.state;
  result->reason = message.reason;
  const std::size_t count = std::min(message.features.size(), kMostFeatures);
  result->features.reserve(count);
  for (std::size_t k = 0; k < count; ++k) result->features.push_back(factOf(message.features[k]));
  return result;
}

}  // namespace laparoscope_servo::screen
