// What is selected, as people write it: YAML (JSON is YAML), in a file or in a service call.
//
//   - {id: shaft, line: [[100, 50], [300, 80]]}                        its ends, px
//   - {id: rim, ellipse: {centre: [160, 120], radii: [40, 30], angle: 0.2}}
//   - {id: trocar, ellipse: [[120, 80], [140, 70], ...], arc: [0.5, 2.0], range: 10}
//   - {id: left dot, point: [80, 60], desired: [160, 120]}
//   - {id: outline, spline: [[20, 30], [60, 40], ...]}
//   - {id: tissue, corners: {region: [100, 50, 200, 150], count: 40}}  chosen in the image, or in the picture `stored`
//   - {id: liver, corners: {count: 60}, stored: /home/me/liver.png}
//   - {id: view, motion: [[100, 80], [300, 240]]}                      two corners of a region; []: all of the image
//   - {id: clamp, pose: [0.01, 0, 0.12, 0.1, -0.4, 0]}                 m and a rotation vector, rad: camera_T_object
#pragma once

#include <string>

#include "laparoscope_servo/features/feature_selection.h"

namespace laparoscope_servo {

// Throws std::invalid_argument with every error, each with the feature, its line in the text, the value and what was
// expected. Whether the tracker can use it is checked later: features::validate, and the image.
features::FeatureSelection parseSelection(const std::string& text);

// Of a file. Throws std::invalid_argument with the file's name in front, also when it cannot be read.
features::FeatureSelection readSelection(const std::string& file);

}  // namespace laparoscope_servo
