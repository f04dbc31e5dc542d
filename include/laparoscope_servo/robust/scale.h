// Constants of robust estimation, for normal noise (Marchand and Chaumette 2004, appendix).
#pragma once

namespace laparoscope_servo::robust {

// Tuning constants of Tukey's and Huber's weights, in standard deviations, for 95 % efficiency.
constexpr double kTukey = 4.6851;
constexpr double kHuber = 1.345;
// Ratio of the standard deviation to the median of magnitudes.
constexpr double kMadToSigma = 1.4826;
// Ratio of the median length of a vector in the plane to the standard deviation of each of its components.
constexpr double kRayleighMedian = 1.1774;

}  // namespace laparoscope_servo::robust
