// Checks whether a JPEG is complete.
#pragma once

#include <string>

namespace laparoscope_servo {

bool isJpeg(const std::string& bytes);
// Whether the end marker follows the image, also after several scans; that of an embedded preview is ignored. Bytes
// after it do not matter.
bool hasJpegEnd(const std::string& bytes);

}  // namespace laparoscope_servo
