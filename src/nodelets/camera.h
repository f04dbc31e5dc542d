// The nodelet laparoscope_servo/Camera: see ros/camera/camera_driver.h.
#pragma once

#include <nodelet/nodelet.h>

#include <memory>

#include "ros/camera/camera_driver.h"

namespace laparoscope_servo::nodelets {

class Camera : public nodelet::Nodelet {
 private:
  void onInit() override;

  std::unique_ptr<CameraDriver> driver_;
};

}  // namespace laparoscope_servo::nodelets
