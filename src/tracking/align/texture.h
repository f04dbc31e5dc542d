// How much of what an image shows is texture, and how much is the camera's noise.
#pragma once

#include <opencv2/core.hpp>

namespace laparoscope_servo::tracking {

// Standard deviation [grey levels] of the noise of a plane: white noise is estimated in blocks, by a filter that takes
// out what is linear or a saddle (Immerkaer 1996), and the lower quartile of the blocks counts, as texture adds to it.
// 0 for a plane of less than 3 pixels in a direction. `mask`: CV_8UC1 of the plane's size, or empty; blocks in which it
// is not 0 do not count, as there is no noise beyond a round picture's border, unless there are no others.
double noiseOf(const cv::Mat1f& plane, const cv::Mat& mask = cv::Mat());

// Per pixel, 0 to 1: which share of the mean square of the gradient around it, both directions together, is more than
// noise has by chance. `noise`: what noise has on average [grey levels^2].
cv::Mat1f textureShare(const cv::Mat1f& plane, double noise);

}  // namespace laparoscope_servo::tracking
