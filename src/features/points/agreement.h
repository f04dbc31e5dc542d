// Which part of a window looks as it did: by cells, each against its own texture.
#pragma once

#include <vector>

#include "features/points/window.h"

namespace laparoscope_servo::features {

// 0 to 1: of the window's cells that have texture in the first view `view` and are valid in both, the share whose
// residuals `residuals` (grey levels, in the order of the window's pixels) are small against that texture. A strong
// edge elsewhere in the window does not hide a cell that differs, and flat cells, which agree with anything flat, have
// no say. 0 where no cell has one.
double agreeingShare(const Window& view, const Window& now, const std::vector<float>& residuals);

}  // namespace laparoscope_servo::features
