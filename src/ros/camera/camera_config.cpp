#include "ros/camera/camera_config.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace laparoscope_servo {

namespace {

bool isFileName(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(),
                                      [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
}

}  // namespace

void describe(parameters::Table& table, CameraConfig& c) {
  table.text("device", c.device, "of Video4Linux; or a video file, or an address that ffmpeg understands");
  table.number("width", c.width, {0, 16384}, "px", "requested from the device; 0: its own");
  table.number("height", c.height, {0, 16384}, "px", "requested from the device; 0: its own");
  table.number("rate", c.rate, {0, 1000}, "Hz", "requested from the device; 0: its own");
  table.text("pixel_format", c.pixel_format, "requested from the device, e.g. MJPG or YUYV; empty: its own")
      .accepting("four letters or nothing", [](const std::string& t) { return t.empty() || t.size() == 4; });
  table.text("name", c.name, "of the calibration: camera_info/NAME.yaml in ROS_HOME or ~/.ros")
      .accepting("letters, digits, _ and -", isFileName);
  table.text("calibration", c.calibration, "file of the calibration, which must exist; empty: by the name");
  table.text("frame_id", c.frame_id, "of the images");
  table.choice("bayer", c.bayer, {"none", "rggb", "bggr", "gbrg", "grbg"},
               "colour filter of a device with raw pictures, which are converted to colour");
  table.choice("interlacing", c.interlacing, {"none", "upper", "lower"},
               "the lines of one half picture are kept, those between are interpolated");
  table.number("delay", c.delay, {0, 2}, "s", "delay of camera and grabber, subtracted from the stamps");
  table.number("max_silence", c.max_silence, {0.1, 60}, "s", "without a picture: an error in diagnostics");
  table.number("retry_period", c.retry_period, {0.1, 60}, "s", "between two attempts to open a device that is gone");
}

std::vector<std::string> validate(const CameraConfig& config) {
  std::vector<std::string> errors = parameters::errorsOf(config);
  if ((config.width == 0) != (config.height == 0))
    errors.push_back("width = " + std::to_string(config.width) + ", height = " + std::to_string(config.height) +
                     ", expected both or none to be 0");
  return errors;
}

std::string calibrationFile(const std::string& name) {
  const char* ros_home = std::getenv("ROS_HOME");
  const char* home = std::getenv("HOME");
  const std::string folder = ros_home != nullptr ? ros_home : std::string(home != nullptr ? home : "") + "/.ros";
  return folder + "/camera_info/" + name + ".yaml";
}

}  // namespace laparoscope_servo
