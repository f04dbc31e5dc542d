// How old the images of this camera usually become before the next one comes: by its period, its delay, and the time
// that its tracker takes.
//
// An image that becomes older is the first sign of a camera that falls silent, or whose stamps go slower than time:
// long before it is too old by any bound that has to hold for slow cameras as well.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace laparoscope_servo::servo {

class UsualAge {
 public:
  // Takes the image taken at `image_time`, of which the controller heard at `arrival`, both in s on one clock. A call
  // with the last time is ignored, since it is the same image.
  void take(double image_time, double arrival);

  // Share of the speed, 0 to 1, for an image of this age [s]; 1 while what is usual is not known. NaN: 0.
  double share(double age) const;

  void restart();

 private:
  static constexpr std::size_t kKept = 32;

  struct Image {
    double age = 0.0;     // s, that it had when the next one came
    double period = 0.0;  // s, from its arrival to that of the next one
  };
  struct Last {
    double image_time;
    double arrival;
  };
  void know();

  std::array<Image, kKept> images_{};
  std::size_t count_ = 0;  // of all that were taken
  std::optional<Last> last_;
  double usual_ = 0.0;   // s, age that most images do not reach
  double period_ = 0.0;  // s
};

}  // namespace laparoscope_servo::servo
