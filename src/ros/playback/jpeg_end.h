// Whether a JPEG is all there.
#pragma once

#include <string>

namespace laparoscope_servo {

bool isJpeg(const std::string& bytes);
// Whether the marker of the end comes behind the image, also behind several scans; that of a preview inside does not
// count. What follows it does not matter.
bool hasJpegEnd(const std::string& bytes);

}  // namespace laparoscope_servo
