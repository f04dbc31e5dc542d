// What the task PARALLEL knows, for rviz: the plane of the tissue about the foot of the perpendicular from the
// insertion point, its normal there, and where the middle of the image goes.
#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Core>
#include <string>

#include "laparoscope_servo/servo/parallel_figures.h"

namespace laparoscope_servo {

// In the frame of the insertion point. Where no normal is known, all are deleted.
visualization_msgs::MarkerArray planeMarkers(const std::string& insertion_point, const servo::ParallelFigures& figures);

}  // namespace laparoscope_servo
