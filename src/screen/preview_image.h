// Converts the tracker's preview to a Qt image.
#pragma once

#include <sensor_msgs/Image.h>

#include <QImage>

namespace laparoscope_servo::screen {

// RGB32, a copy; null unless the message is a complete mono8 or bgr8 image, as the tracker publishes.
QImage previewImage(const sensor_msgs::Image& message);

}  // namespace laparoscope_servo::screen
