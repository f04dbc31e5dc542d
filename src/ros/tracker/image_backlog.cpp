#include "ros/tracker/image_backlog.h"

#include <algorithm>
#include <vector>

#include "laparoscope_servo/robust/median.h"

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
  std::vector<double> known(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(size));
  return robust::median(known);
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
