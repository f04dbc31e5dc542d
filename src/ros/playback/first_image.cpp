#include "ros/playback/first_image.h"

#include <stdexcept>

#include "ros/playback/image_source.h"
#include "ros/tracker/preview.h"
#include "ros/tracker/region_desk.h"
#include "ros/tracker/tracker_session.h"

namespace laparoscope_servo {

FirstImage::FirstImage(const OfflineOptions& options) : parameters_(options.parameters) {
  if (options.inputs.empty())
    throw std::invalid_argument("no input is given, expected a bag, a video or a folder of images");
  parameters_.roi.reset();
  TrackerSession session(parameters_);
  const bool own_camera_info = !options.camera_info.empty();
  if (own_camera_info) session.setCameraInfo(readCameraInfo(options.camera_info));
  const auto source = openImageSource(options.inputs, options.source);
  const auto image = source->next();
  if (!image) {
    throw SourceError("'" + options.inputs.front() + "' has no image after " + std::to_string(options.source.start) +
                      " s, but " + std::to_string(source->size()) + " in all");
  }
  frame_ = image->frame;
  if (image->camera_info && !own_camera_info) session.setCameraInfo(*image->camera_info);
  if (!image->error.empty()) throw SourceError("image " + std::to_string(frame_) + ": " + image->error);
  snapshot_ = session.snapshot(image->message ? session.process(*image->message)
                                              : session.process(image->decoded, image->header));
}

cv::Mat FirstImage::picture(int side) const {
  return Preview(side).of(snapshot_.image, snapshot_.lens);
}

std::string FirstImage::refusal(const geometry::Rectangle& roi) const {
  try {
    RegionDesk(parameters_).check(snapshot_, roi);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

std::optional<geometry::Rectangle> FirstImage::proposal(const geometry::Rectangle& roi) const {
  return RegionDesk(parameters_).propose(snapshot_, roi);
}

}  // namespace laparoscope_servo
