// What the controller's inputs of features need beside the features' messages.
#pragma once

#include "laparoscope_servo/servo/controller.h"
#include "ros/controller/feature_camera.h"

namespace laparoscope_servo {

// Of 640 x 480 px.
inline FeatureCamera calibrated() {
  sensor_msgs::CameraInfo info;
  info.width = 640;
  info.height = 480;
  info.K = {500.0, 0.0, 310.0, 0.0, 500.0, 250.0, 0.0, 0.0, 1.0};
  info.P = {500.0, 0.0, 310.0, 0.0, 0.0, 500.0, 250.0, 0.0, 0.0, 0.0, 1.0, 0.0};
  FeatureCamera camera(false);
  camera.take(info);
  return camera;
}

inline servo::DepthInput depthOf(double d2) {
  servo::DepthInput depth;
  depth.problem.clear();
  depth.d2 = d2;
  return depth;
}

}  // namespace laparoscope_servo
