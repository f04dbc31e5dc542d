// Regions of messages in Qt's form, and back.
#pragma once

#include <sensor_msgs/RegionOfInterest.h>

#include <QRect>
#include <cstdint>

namespace laparoscope_servo::screen {

// Bounds a side from a message, which may hold any value.
int side(std::uint32_t pixels);

QRect pixelsOf(const sensor_msgs::RegionOfInterest& roi);
sensor_msgs::RegionOfInterest messageOf(const QRect& pixels);

}  // namespace laparoscope_servo::screen
