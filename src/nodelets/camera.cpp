#include "nodelets/camera.h"

#include <exception>
#include <pluginlib/class_list_macros.hpp>
#include <stdexcept>

#include "ros/common/network_exposure.h"
#include "ros/common/parameters.h"

namespace laparoscope_servo::nodelets {

// Exceptions must not leave onInit(): they would end the nodelet manager with all its nodelets.
void Camera::onInit() {
  try {
    ParameterReader reader(parametersOf(getPrivateNodeHandle()), getPrivateNodeHandle().getNamespace());
    CameraConfig config;
    reader.readAll(config);
    if (!reader.errors().empty()) throw std::runtime_error(reader.report());
    driver_ = std::make_unique<CameraDriver>(getNodeHandle(), getPrivateNodeHandle(), config);
    warnOfExposure();
  } catch (const std::exception& error) {
    NODELET_ERROR("the camera does not start: %s", error.what());
  }
}

}  // namespace laparoscope_servo::nodelets

PLUGINLIB_EXPORT_CLASS(laparoscope_servo::nodelets::Camera, nodelet::Nodelet)
