// Videos and folders of images.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <set>
#include <utility>
#include <vector>

#include "image_sources.h"

namespace laparoscope_servo::skin {

namespace {

constexpr double kTimeTolerance = 1e-6;  // s: --start 0.2 means frame 5 at 25 Hz, whatever rounding says

SourceImage imageAt(std::size_t frame, double rate) {
  SourceImage image;
  image.frame = frame;
  image.header.stamp = image.record_time = ros::Time(static_cast<double>(frame) / rate);
  return image;
}

bool isBeforeStart(std::size_t frame, double rate, double start) {
  return static_cast<double>(frame) / rate < start - kTimeTolerance;
}

class VideoSource : public ImageSource {
 public:
  VideoSource(const std::string& path, const SourceOptions& options) : path_(path), start_(options.start) {
    if (!capture_.open(path)) {
      throw SourceError("'" + path +
                        "' cannot be opened, expected a bag, a folder of images or a video that OpenCV can decode");
    }
    rate_ = capture_.get(cv::CAP_PROP_FPS);
    if (!(rate_ > 0.0) || !std::isfinite(rate_)) rate_ = options.folder_rate;
    const double count = capture_.get(cv::CAP_PROP_FRAME_COUNT);
    if (count > 0.0 && count < 1e9) size_ = static_cast<std::size_t>(count);
  }

  std::optional<SourceImage> next() override {
    while (isBeforeStart(frame_, rate_, start_)) {
      if (!capture_.grab()) return std::nullopt;
      ++frame_;
    }
    SourceImage image = imageAt(frame_, rate_);
    // A new matrix each time: the caller may keep the last one.
    if (!capture_.read(image.decoded)) {
      if (frame_ == 0) throw SourceError("video '" + path_ + "' has no frame that can be decoded");
      return std::nullopt;
    }
    ++frame_;
    return image;
  }

  std::size_t size() const override { return size_; }
  double rate() const override { return rate_; }
  bool hasRecordedStamps() const override { return false; }

 private:
  std::string path_;
  cv::VideoCapture capture_;
  double start_;
  double rate_ = 0.0;
  std::size_t size_ = 0;
  std::size_t frame_ = 0;
};

bool isImage(const std::filesystem::path& path) {
  static const std::set<std::string> kExtensions{".png",  ".jpg", ".jpeg", ".bmp", ".tif",
                                                 ".tiff", ".pgm", ".ppm",  ".pnm", ".webp"};
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return kExtensions.count(extension) > 0 && path.filename().string().front() != '.';
}

class FolderSource : public ImageSource {
 public:
  FolderSource(const std::string& path, const SourceOptions& options)
      : rate_(options.folder_rate), start_(options.start) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(path, error)) {
      if (isImage(entry.path())) files_.push_back(entry.path().string());
    }
    if (error) throw SourceError("folder '" + path + "' cannot be read: " + error.message());
    if (files_.empty()) {
      throw SourceError("folder '" + path +
                        "' has no images, expected files ending in png, jpg, bmp, tif, pgm, ppm or webp");
    }
    std::sort(files_.begin(), files_.end());
  }

  std::optional<SourceImage> next() override {
    while (frame_ < files_.size() && isBeforeStart(frame_, rate_, start_)) ++frame_;
    if (frame_ >= files_.size()) return std::nullopt;
    SourceImage image = imageAt(frame_, rate_);
    const std::string& file = files_[frame_++];
    image.decoded = cv::imread(file, cv::IMREAD_UNCHANGED);
    if (image.decoded.empty()) image.error = "'" + file + "' cannot be read, expected an image";
    return image;
  }

  std::size_t size() const override { return files_.size(); }
  double rate() const override { return rate_; }
  bool hasRecordedStamps() const override { return false; }

 private:
  double rate_;
  double start_;
  std::vector<std::string> files_;
  std::size_t frame_ = 0;
};

}  // namespace

std::unique_ptr<ImageSource> openVideoSource(const std::string& path, const SourceOptions& options) {
  return std::make_unique<VideoSource>(path, options);
}

std::unique_ptr<ImageSource> openFolderSource(const std::string& path, const SourceOptions& options) {
  return std::make_unique<FolderSource>(path, options);
}

}  // namespace laparoscope_servo::skin
