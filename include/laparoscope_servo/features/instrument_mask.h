// The instruments of a single image, as far as it shows them beyond doubt: for a region of tissue that is selected in
// it. model::InstrumentTracker follows them through a sequence, and needs several images for those that are less clear.
#pragma once

#include <opencv2/core.hpp>

namespace laparoscope_servo::features {

constexpr int kLeastInstrumentImage = 64;  // px, of an image's sides
// Of a shaft that is believed by one image, the contrast of both edges relative to the tissue's colour, and the share
// of its length that each edge is seen.
constexpr double kClearContrast = 0.75;
constexpr double kClearCoverage = 0.5;

// CV_8UC1 of the image's size, 255 where an instrument covers the tissue: grey shafts with two straight edges that
// enter through the border of the picture, and the wrist and jaws on them. Empty where none is found; where nothing can
// be told: an image that is not CV_8UC3, has less than kLeastInstrumentImage a side, or is grey for the most part, as
// outside of the body. `image`: as the camera sees it, with the lens's distortion. Keeps nothing, allocates.
cv::Mat instrumentMask(const cv::Mat& image);

}  // namespace laparoscope_servo::features
