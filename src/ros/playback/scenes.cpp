#include "ros/playback/scenes.h"

#include <deque>
#include <exception>
#include <memory>
#include <utility>

#include "laparoscope_servo/image/cut_finder.h"
#include "ros/playback/first_image.h"
#include "ros/playback/image_source.h"
#include "ros/tracker/image_conversion.h"

namespace laparoscope_servo {

namespace {

class SceneReader {
 public:
  explicit SceneReader(const OfflineOptions& options) : options_(options) {
    options_.source.start = 0.0;
    options_.source.end = std::numeric_limits<double>::infinity();
    options_.source.crop = cv::Rect();
    source_ = openImageSource(options_.inputs, options_.source);
  }

  std::vector<Scene> read() {
    image::CutFinder finder(source_->rate());
    try {
      while (std::optional<SourceImage> image = source_->next()) take(std::move(*image), finder);
    } catch (const SourceError&) {
      if (times_.empty()) throw;
    }
    for (const image::Cut& cut : finder.end()) add(cut);
    return std::move(scenes_);
  }

 private:
  void take(SourceImage image, image::CutFinder& finder) {
    if (image.camera_info) camera_info_ = image.camera_info;
    image.camera_info = camera_info_;
    if (times_.empty()) {
      begin_ = image.record_time;
      scenes_.emplace_back();
      scenes_.back().roi = suggestionIn(image);
    }
    times_.push_back((image.record_time - begin_).toSec());
    const std::optional<image::Cut> cut = look(image, finder);
    held_.push_back(std::move(image));
    if (cut) add(*cut);
    while (times_.size() - held_.size() < finder.undecided()) held_.pop_front();
  }

  static std::optional<image::Cut> look(const SourceImage& image, image::CutFinder& finder) {
    if (!image.error.empty()) return finder.miss();
    try {
      return finder.see(image.message ? trackerImage(*image.message) : trackerImage(image.decoded));
    } catch (const ImageError&) {
      return finder.miss();
    }
  }

  void add(const image::Cut& cut) {
    scenes_.back().end = (times_[cut.last] + times_[cut.last + 1]) / 2.0;
    scenes_.emplace_back();
    scenes_.back().start = (times_[cut.first - 1] + times_[cut.first]) / 2.0;
    scenes_.back().roi = suggestionIn(held_[cut.first - (times_.size() - held_.size())]);
  }

  std::optional<geometry::Rectangle> suggestionIn(const SourceImage& image) const {
    try {
      return FirstImage(options_, image).suggestion();
    } catch (const std::exception&) {  // the image cannot be used
      return std::nullopt;
    }
  }

  OfflineOptions options_;
  std::unique_ptr<ImageSource> source_;
  sensor_msgs::CameraInfoConstPtr camera_info_;
  ros::Time begin_;
  std::vector<double> times_;     // s, of all images
  std::deque<SourceImage> held_;  // the last ones of them: a scene may begin with each
  std::vector<Scene> scenes_;
};

}  // namespace

std::vector<Scene> findScenes(const OfflineOptions& options) {
  std::vector<Scene> scenes = SceneReader(options).read();
  if (scenes.empty()) throw SourceError("'" + options.inputs.front() + "' has no image");
  return scenes;
}

}  // namespace laparoscope_servo
