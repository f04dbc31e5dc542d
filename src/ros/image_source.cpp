#include "laparoscope_servo/ros/image_source.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "image_sources.h"

namespace laparoscope_servo::skin {

namespace {

bool looksLikeBag(const std::filesystem::path& path) {
  constexpr std::array<char, 8> kMagic{'#', 'R', 'O', 'S', 'B', 'A', 'G', ' '};
  std::array<char, 8> start{};
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), start.size());
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  // By its name, too, so that a damaged bag is not taken for a video.
  return start == kMagic || extension == ".bag" || extension == ".active";
}

}  // namespace

std::unique_ptr<ImageSource> openImageSource(const std::string& path, const SourceOptions& options) {
  if (!(options.start >= 0.0) || !std::isfinite(options.start)) {
    throw SourceError("start = " + std::to_string(options.start) + " s, expected 0 or more");
  }
  if (!(options.folder_rate > 0.0) || !std::isfinite(options.folder_rate)) {
    throw SourceError("rate = " + std::to_string(options.folder_rate) + " Hz, expected more than 0");
  }
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw SourceError("'" + path + "' does not exist, expected a bag, a video or a folder of images");
  }
  if (std::filesystem::is_directory(status)) return openFolderSource(path, options);
  if (!std::ifstream(path)) throw SourceError("'" + path + "' cannot be read");
  if (looksLikeBag(path)) return openBagSource(path, options);
  return openVideoSource(path, options);
}

}  // namespace laparoscope_servo::skin
