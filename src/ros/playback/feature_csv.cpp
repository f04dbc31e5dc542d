#include "ros/playback/feature_csv.h"

#include <cmath>
#include <string>

#include "ros/playback/csv_text.h"

namespace laparoscope_servo {

namespace {

std::string listed(const Eigen::VectorXd& numbers) {
  std::string text;
  for (Eigen::Index k = 0; k < numbers.size(); ++k) text += (text.empty() ? "" : " ") + exact(numbers[k]);
  return text;
}

std::string listed(const std::vector<Eigen::Vector2d>& points) {
  std::string text;
  for (const Eigen::Vector2d& point : points)
    text += (text.empty() ? "" : " ") + exact(point.x()) + ' ' + exact(point.y());
  return text;
}

}  // namespace

void writeFeatureCsvHeader(std::ostream& stream) {
  stream << "frame,stamp,state,processing_time,id,kind,feature_state,share,expected_error,parameters,deviations,outline"
            ",reason\n";
}

void writeFeatureCsvRows(std::ostream& stream, std::size_t frame, const ProcessedFeatures& processed) {
  const std::string image = std::to_string(frame) + ',' + exact(processed.header.stamp.toSec()) + ',' +
                            std::to_string(static_cast<int>(processed.result.state)) + ',' +
                            exact(processed.processing_time) + ',';
  if (processed.result.features.empty()) stream << image << ",,,,,,,," << quoted(processed.result.reason) << '\n';
  for (const features::TrackedFeature& feature : processed.result.features) {
    const Eigen::VectorXd deviations = feature.covariance.diagonal().cwiseSqrt();
    stream << image << quoted(feature.id) << ',' << features::kindName(feature.kind) << ','
           << static_cast<int>(feature.state) << ',' << exact(feature.share) << ',' << exact(feature.expected_error)
           << ',' << listed(feature.parameters) << ',' << listed(deviations) << ',' << listed(feature.outline) << ','
           << quoted(feature.reason) << '\n';
  }
}

}  // namespace laparoscope_servo
