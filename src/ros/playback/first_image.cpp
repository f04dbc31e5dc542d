#include "ros/playback/first_image.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "ros/playback/image_source.h"
#include "ros/tracker/preview.h"
#include "ros/tracker/region_desk.h"
#include "ros/tracker/tracker_session.h"

namespace laparoscope_servo {

namespace {

constexpr double kShare = 1.0 / 3.0;  // of the image's smaller side: side of the region that is looked at first

std::unique_ptr<ImageSource> openSource(const OfflineOptions& options) {
  if (options.inputs.empty())
    throw std::invalid_argument("no input is given, expected a bag, a video or a folder of images");
  return openImageSource(options.inputs, options.source);
}

SourceImage readFirst(const OfflineOptions& options, ImageSource& source) {
  std::optional<SourceImage> image = source.next();
  if (!image) {
    throw SourceError("'" + options.inputs.front() + "' has no image after " + std::to_string(options.source.start) +
                      " s, but " + std::to_string(source.size()) + " in all");
  }
  return std::move(*image);
}

}  // namespace

FirstImage::FirstImage(const OfflineOptions& options) : FirstImage(options, *openSource(options)) {}

FirstImage::FirstImage(const OfflineOptions& options, ImageSource& source)
    : FirstImage(options, readFirst(options, source)) {}

FirstImage::FirstImage(const OfflineOptions& options, const SourceImage& image)
    : parameters_(options.parameters), frame_(image.frame) {
  parameters_.roi.reset();
  TrackerSession session(parameters_);
  if (!options.camera_info.empty()) {
    session.setCameraInfo(readCameraInfo(options.camera_info));
  } else if (image.camera_info) {
    session.setCameraInfo(*image.camera_info);
  }
  if (!image.error.empty()) throw SourceError("image " + std::to_string(frame_) + ": " + image.error);
  snapshot_ =
      session.snapshot(image.message ? session.process(*image.message) : session.process(image.decoded, image.header));
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

std::optional<geometry::Rectangle> FirstImage::suggestion() const {
  const double side = std::floor(kShare * std::min(size().width, size().height));
  const geometry::Rectangle centre{std::floor((size().width - side) / 2.0), std::floor((size().height - side) / 2.0),
                                   side, side};
  return refusal(centre).empty() ? centre : proposal(centre);
}

}  // namespace laparoscope_servo
