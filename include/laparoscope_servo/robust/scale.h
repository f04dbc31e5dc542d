// Constants of robust estimation, for normal noise (Marchand and Chaumette 2004, appendix).
#pragma once

namespace laparoscope_servo::robust {

// Of Tukey's and of Huber's weights, in standard deviations: 95 % efficiency.
constexpr double kTukey = 4.6851;
constexpr double kHuber = 1.345;
// The standard deviation over the median of magnitudes.
constexpr double kMadToSigma = 1.4826;
// The median length of a vector of the plane over the standard deviation of each of its components.
constexpr double kRayleighMedian = 1.1774;

}  // namespace laparoscope_servo::robust
