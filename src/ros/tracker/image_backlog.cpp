#include "ros/tracker/image_backlog.h"

#include <algorithm>

namespace laparoscope_servo {

namespace {

constexpr double kCatchesUp = 0.5;  // share of the period

}  // namespace

void ImageBacklog::Recent::add(double value) {
  values[count % kRemembered] = value;
  ++count;
}

double ImageBacklog::Recent::median() const {
  const std::size_t size = std::min(count, kRemembered);
  if (size == 0) return 0.0;
  std::array<double, kRemembered> sorted = values;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(size / 2);
  std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(size));
  return *middle;
}

bool ImageBacklog::takes(const ros::Time& stamp, double waited) {
  const double period = stamp.toSec() - last_.toSec();  // ros::Duration throws beyond 68 years
  if (!last_.isZero() && period > 0.0) periods_.add(period);
  last_ = stamp;
  const double usual = periods_.median();
  if (!(usual > 0.0)) return true;  // stamps that tell nothing: who refuses them has to see the image
  return !(waited > usual) || !(durations_.median() > kCatchesUp * usual);
}

void ImageBacklog::took(double duration) {
  durations_.add(duration);
}

}  // namespace laparoscope_servo
