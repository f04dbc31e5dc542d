#include "servo/safety/usual_age.h"

#include <algorithm>
#include <cmath>

namespace laparoscope_servo::servo {

namespace {

constexpr std::size_t kLeast = 8;  // images
// Share of the images that become no older than what is usual. One that comes late now and then, or is dropped, changes
// nothing; and stamps that lose a share s of the time are s * (1 - kMost) * 32 periods later than that, 3.2 at a half.
constexpr double kMost = 0.8;
// Periods beyond what is usual from which on the scope is slower, and at which it stands. Derived: an image that is
// missing is noticed one period after it was due, and a quarter is what a tracker may differ by.
constexpr double kSlower = 0.25, kStands = 1.25;
constexpr double kShortest = 0.02;  // s, least period: that of commands at 50 Hz

}  // namespace

void UsualAge::restart() {
  count_ = 0;
  last_.reset();
}

void UsualAge::take(double image_time, double arrival) {
  if (!std::isfinite(image_time) || !std::isfinite(arrival)) return;
  if (last_ && image_time == last_->image_time) return;
  if (last_) {
    const Image image{arrival - last_->image_time, arrival - last_->arrival};
    // A clock that has jumped, or a pause: nothing of this camera's.
    if (!(image.age >= 0.0 && image.age < 1.0 && image.period >= 0.0)) {
      restart();
    } else {
      images_[count_++ % kKept] = image;
      know();
    }
  }
  last_ = Last{image_time, arrival};
}

void UsualAge::know() {
  const std::size_t count = std::min(count_, kKept);
  std::array<double, kKept> ages{}, periods{};
  for (std::size_t k = 0; k < count; ++k) {
    ages[k] = images_[k].age;
    periods[k] = images_[k].period;
  }
  const auto quantile = [count](std::array<double, kKept>& values, double share) {
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(count - 1));
    std::nth_element(values.begin(), place, values.begin() + static_cast<std::ptrdiff_t>(count));
    return *place;
  };
  usual_ = quantile(ages, kMost);
  period_ = std::max(kShortest, quantile(periods, 0.5));
}

double UsualAge::share(double age) const {
  if (count_ < kLeast) return 1.0;
  const double left = (usual_ + kStands * period_ - age) / ((kStands - kSlower) * period_);
  return left > 0.0 ? std::min(1.0, left) : 0.0;
}

}  // namespace laparoscope_servo::servo
