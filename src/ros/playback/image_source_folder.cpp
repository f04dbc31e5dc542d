// Folders of images.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <utility>
#include <vector>

#include "ros/common/picture_file.h"
#include "ros/playback/image_sources.h"
#include "ros/playback/jpeg_end.h"
#include "ros/playback/natural_order.h"

namespace laparoscope_servo {

namespace {

// Rotated by EXIF, with the depth of the file, without alpha.
constexpr int kAsShown = cv::IMREAD_ANYDEPTH | cv::IMREAD_ANYCOLOR;

SourceImage imageAt(std::size_t frame, double rate) {
  SourceImage image;
  image.frame = frame;
  image.header.stamp = image.record_time = ros::Time(static_cast<double>(frame) / rate);
  return image;
}

bool isImage(const std::filesystem::path& path) {
  static const std::set<std::string> kExtensions{".png",  ".jpg", ".jpeg", ".bmp", ".tif",
                                                 ".tiff", ".pgm", ".ppm",  ".pnm", ".webp"};
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return kExtensions.count(extension) > 0 && path.filename().string().front() != '.';
}

// Whether a JPEG is truncated: libjpeg fills the rest with grey and reports success.
bool isCutOff(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  return isJpeg(bytes) && !hasJpegEnd(bytes);
}

class FolderSource : public ImageSource {
 public:
  FolderSource(const std::string& path, const SourceOptions& options) : rate_(options.folder_rate), span_(options) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(path, error)) {
      if (isImage(entry.path())) files_.push_back(entry.path().string());
    }
    if (error) throw SourceError("folder '" + path + "' cannot be read: " + error.message());
    if (files_.empty()) {
      throw SourceError("folder '" + path +
                        "' has no images, expected files ending in png, jpg, bmp, tif, pgm, ppm or webp");
    }
    std::sort(files_.begin(), files_.end(), comesBefore);
  }

  std::optional<SourceImage> next() override {
    while (frame_ < files_.size() && span_.isSkipped(timeOf(frame_))) ++frame_;
    if (frame_ >= files_.size() || span_.isBehind(timeOf(frame_))) return std::nullopt;
    SourceImage image = imageAt(frame_, rate_);
    const std::string& file = files_[frame_++];
    if (isCutOff(file)) {
      image.error = "'" + file + "' breaks off before the end of its image";
      return image;
    }
    image.decoded = readPicture(file, kAsShown);
    if (image.decoded.empty()) image.error = "'" + file + "' cannot be read, expected a whole image";
    return image;
  }

  std::size_t size() const override { return files_.size(); }
  double rate() const override { return rate_; }
  bool hasRecordedStamps() const override { return false; }

 private:
  double timeOf(std::size_t frame) const { return static_cast<double>(frame) / rate_; }

  double rate_;
  ImageSpan span_;
  std::vector<std::string> files_;
  std::size_t frame_ = 0;
};

}  // namespace

std::unique_ptr<ImageSource> openFolderSource(const std::string& path, const SourceOptions& options) {
  return std::make_unique<FolderSource>(path, options);
}

}  // namespace laparoscope_servo
