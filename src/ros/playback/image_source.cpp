#include "ros/playback/image_source.h"

#include <glob.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include "ros/playback/image_sources.h"

namespace laparoscope_servo {

namespace {

bool looksLikeBag(const std::filesystem::path& path) {
  constexpr std::array<char, 8> kMagic{'#', 'R', 'O', 'S', 'B', 'A', 'G', ' '};
  std::array<char, 8> start{};
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), start.size());
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  // Also by its name, so that a damaged bag is not taken for a video.
  return start == kMagic || extension == ".bag" || extension == ".active";
}

void checkOptions(const SourceOptions& options) {
  if (!(options.start >= 0.0) || !std::isfinite(options.start)) {
    throw SourceError("start = " + std::to_string(options.start) + " s, expected 0 or more");
  }
  if (!(options.end > options.start)) {
    throw SourceError("end = " + std::to_string(options.end) + " s, expected more than start, " +
                      std::to_string(options.start) + " s");
  }
  if (options.resume != 0.0 && !(options.resume > options.start && options.resume < options.end)) {
    throw SourceError("resume = " + std::to_string(options.resume) + " s, expected more than start, " +
                      std::to_string(options.start) + " s, and less than end, " + std::to_string(options.end) + " s");
  }
  if (!(options.folder_rate > 0.0) || !std::isfinite(options.folder_rate)) {
    throw SourceError("rate = " + std::to_string(options.folder_rate) + " Hz, expected more than 0");
  }
}

std::string sizeText(const cv::Size& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

// One view of a stereo video, say. An image that is too small for it is as one that cannot be decoded.
class CroppedSource : public ImageSource {
 public:
  CroppedSource(std::unique_ptr<ImageSource> source, const cv::Rect& crop) : source_(std::move(source)), crop_(crop) {}

  std::optional<SourceImage> next() override {
    std::optional<SourceImage> image = source_->next();
    if (!image || image->decoded.empty()) return image;
    if ((cv::Rect({}, image->decoded.size()) & crop_) == crop_) {
      image->decoded = image->decoded(crop_).clone();
    } else {
      image->error = "the image has " + sizeText(image->decoded.size()) + " px, expected at least " +
                     sizeText(cv::Size(crop_.br().x, crop_.br().y)) + " for crop";
      image->decoded.release();
    }
    return image;
  }

  std::size_t size() const override { return source_->size(); }
  double rate() const override { return source_->rate(); }
  bool hasRecordedStamps() const override { return source_->hasRecordedStamps(); }
  std::vector<std::string> notes() const override { return source_->notes(); }

 private:
  std::unique_ptr<ImageSource> source_;
  cv::Rect crop_;
};

enum class Kind { kFolder, kBag, kVideo };

Kind kindOf(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw SourceError("'" + std::filesystem::absolute(path, error).string() +
                      "' does not exist, expected a bag, a video or a folder of images");
  }
  if (std::filesystem::is_directory(status)) return Kind::kFolder;
  if (!std::ifstream(path)) throw SourceError("'" + path + "' cannot be read");
  return looksLikeBag(path) ? Kind::kBag : Kind::kVideo;
}

void addMatches(const std::string& pattern, std::vector<std::string>& inputs) {
  glob_t found{};
  if (::glob(pattern.c_str(), GLOB_NOCHECK, nullptr, &found) == 0) {
    inputs.insert(inputs.end(), found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  ::globfree(&found);
}

}  // namespace

std::unique_ptr<ImageSource> openImageSource(const std::vector<std::string>& paths, const SourceOptions& options) {
  checkOptions(options);
  if (paths.empty()) throw SourceError("no input is given, expected a bag, a video or a folder of images");
  for (const std::string& path : paths) {
    const Kind kind = kindOf(path);
    if (kind == Kind::kBag) continue;
    if (paths.size() > 1) throw SourceError("'" + path + "' is no bag, expected bags where several inputs are given");
    auto source = kind == Kind::kFolder ? openFolderSource(path, options) : openVideoSource(path, options);
    return options.crop.empty() ? std::move(source) : std::make_unique<CroppedSource>(std::move(source), options.crop);
  }
  if (!options.crop.empty())
    throw SourceError("crop is given, and '" + paths.front() + "' is a bag, expected a video or a folder of images");
  return openBagSource(paths, options);
}

std::unique_ptr<ImageSource> openImageSource(const std::string& path, const SourceOptions& options) {
  return openImageSource(std::vector<std::string>{path}, options);
}

std::vector<std::string> inputsOf(const std::string& text) {
  std::error_code error;
  if (text.empty() || std::filesystem::exists(text, error)) return {text};
  std::vector<std::string> inputs;
  std::istringstream words(text);
  for (std::string word; words >> word;) addMatches(word, inputs);
  return inputs.empty() ? std::vector<std::string>{text} : inputs;
}

}  // namespace laparoscope_servo
