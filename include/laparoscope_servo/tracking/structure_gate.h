// Which areas of the aligned region do not look like the reference, whatever their colour: an occluder of tissue, smoke, blood.
//
// Works after ESM on the warped patch: the image, brought to the reference's light by gain and bias, must differ from the
// reference by less than two unrelated patches of the same contrast would.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "laparoscope_servo/image/area_grid.h"

namespace laparoscope_servo::tracking {

struct LightModel {
  double gain = 1.0;  // gain * image + bias = reference
  double bias = 0.0;  // grey levels
};

// Per area: the variance of (gain * image + bias - reference) over the mean variance of both plus that of the noise, as
// standard deviation `sigma` [grey levels] per pixel of the difference. 0 for equal patches, about 2 for unrelated ones, about
// 2/3 where there is nothing but noise. Pixels with valid = 0 do not count; NaN where less than half of an area is valid.
void structureDissimilarity(const cv::Mat1f& image, const cv::Mat1f& reference, const cv::Mat1f& valid, const LightModel& light,
                            double sigma, const image::AreaGrid& grid, std::vector<float>& dissimilarity);

// Areas above this are occluded: for two patches of equal contrast it is a correlation of 0.5.
constexpr float kMaxDissimilarity = 1.0f;

}  // namespace laparoscope_servo::tracking
