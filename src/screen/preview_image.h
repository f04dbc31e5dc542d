// The tracker's preview as Qt draws it.
#pragma once

#include <sensor_msgs/Image.h>

#include <QImage>

namespace laparoscope_servo::screen {

// RGB32, a copy; null for a message that is not what the tracker sends: mono8 or bgr8, with all its data.
QImage previewImage(const sensor_msgs::Image& message);

}  // namespace laparoscope_servo::screen
