// Whether the edges of a shaft, which are found by colour, are steps of brightness, too: the border between pale tissue
// and red tissue is none.
#pragma once

#include <opencv2/core.hpp>

#include "features/shafts/grey_map.h"
#include "features/shafts/shaft.h"
#include "laparoscope_servo/features/edge_config.h"

namespace laparoscope_servo::features {

constexpr double kStagesApart = 2.0;  // cells by which an edge by colour and the same edge by brightness may differ

// 0 to 2: how many of a shaft's edges the brightness of `image` (CV_8UC3, of which `map` is) shows. Allocates.
int brightEdges(const EdgeConfig& config, const cv::Mat& image, const GreyMap& map, const Shaft& shaft);

}  // namespace laparoscope_servo::features
