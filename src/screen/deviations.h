// How much of a covariance the screen shows, in the picture and in space.
#pragma once

namespace laparoscope_servo::screen {

constexpr double kDeviations = 2.0;  // standard deviations to either side

}  // namespace laparoscope_servo::screen
