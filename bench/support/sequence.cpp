#include "bench/support/sequence.h"

#include <algorithm>
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>
#include <filesystem>
#include <fstream>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <stdexcept>

namespace laparoscope_servo::bench {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kAreas = 14 * 14;

// The numbers of each line but the first, which names them; throws unless each has at least `expected`.
std::vector<std::vector<double>> readTable(const std::string& file, std::size_t expected) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(stream, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream text(line);
    std::vector<double> numbers;
    for (double number = 0.0; text >> number;) numbers.push_back(number);
    if (numbers.size() < expected) {
      throw std::runtime_error(file + ": line " + std::to_string(rows.size() + 2) + ": " +
                               std::to_string(numbers.size()) + " numbers, expected " + std::to_string(expected));
    }
    rows.push_back(std::move(numbers));
  }
  return rows;
}

void checkLines(const std::string& file, std::size_t lines, std::size_t images) {
  if (lines == images) return;
  throw std::runtime_error(file + ": " + std::to_string(lines) + " lines for " + std::to_string(images) + " images");
}

bool isImage(const fs::path& file) {
  static const std::vector<std::string> kEndings = {".png", ".jpg", ".jpeg", ".bmp", ".ppm", ".tif", ".tiff"};
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

}  // namespace

Sequence::Sequence(const std::string& path) : path_(path) {
  fs::path where = fs::path(path);
  if (!fs::exists(where)) throw std::runtime_error(path + ": no such file or folder");
  if (!where.has_filename()) where = where.parent_path();  // a slash at the end
  name_ = where.stem().string();
  if (fs::is_directory(where)) {
    const fs::path folder = fs::is_directory(where / "frames") ? where / "frames" : where;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      if (isImage(entry.path())) files_.push_back(entry.path().string());
    }
    std::sort(files_.begin(), files_.end());
    if (files_.empty()) throw std::runtime_error(folder.string() + ": no images");
    if (fs::exists(where / "scene.json")) readScene((where / "scene.json").string());
    if (fs::exists(where / "truth.csv")) readTruth((where / "truth.csv").string());
    if (fs::exists(where / "areas.csv")) readAreas((where / "areas.csv").string());
    // The generator's folders end in a hash of what made them.
    const std::size_t dash = name_.rfind('-');
    if (hasTruth() && dash != std::string::npos && dash > 0) name_.erase(dash);
  } else {
    rewind();
  }
}

void Sequence::rewind() {
  position_ = 0;
  if (files_.empty() && !video_.open(path_))
    throw std::runtime_error(path_ + ": no folder, and no video that can be read");
}

bool Sequence::next(cv::Mat& image) {
  if (files_.empty()) return video_.read(image);
  if (position_ == files_.size()) return false;
  const std::string& file = files_[position_++];
  image = cv::imread(file, cv::IMREAD_COLOR);
  if (image.empty()) throw std::runtime_error(file + ": cannot be read as an image");
  return true;
}

void Sequence::readScene(const std::string& file) {
  boost::property_tree::ptree tree;
  boost::property_tree::read_json(file, tree);
  std::vector<double> roi;
  for (const auto& number : tree.get_child("roi")) roi.push_back(number.second.get_value<double>());
  if (roi.size() != 4)
    throw std::runtime_error(file + ": roi has " + std::to_string(roi.size()) + " numbers, expected 4");
  roi_ = {roi[0], roi[1], roi[2], roi[3]};
  noise_ = tree.get("noise", noise_);
}

void Sequence::readTruth(const std::string& file) {
  for (const std::vector<double>& row : readTable(file, 11)) {
    Eigen::Matrix3d g;
    for (std::size_t k = 0; k < 9; ++k) g(k / 3, k % 3) = row[1 + k];
    truth_.push_back(g);
    covered_.push_back(row[10]);
  }
  checkLines(file, truth_.size(), files_.size());
}

void Sequence::readAreas(const std::string& file) {
  for (const std::vector<double>& row : readTable(file, 1 + kAreas)) areas_.emplace_back(row.begin() + 1, row.end());
  checkLines(file, areas_.size(), files_.size());
}

cv::Mat readImage(const std::string& name) {
  cv::Mat image;
  const std::size_t at = name.rfind('@');
  if (at == std::string::npos || fs::exists(name)) {
    image = cv::imread(name, cv::IMREAD_COLOR);
  } else {
    cv::VideoCapture video(name.substr(0, at));
    int number = std::stoi(name.substr(at + 1));
    while (number-- > 0 && video.grab()) {
    }
    video.read(image);
  }
  if (image.empty()) throw std::runtime_error(name + ": cannot be read as an image");
  return image;
}

double cornerError(const Eigen::Matrix3d& g, const Eigen::Matrix3d& truth, const geometry::Rectangle& roi) {
  double worst = 0.0;
  for (const Eigen::Vector2d& corner : roi.corners()) {
    const Eigen::Vector3d p = g * corner.homogeneous();
    const Eigen::Vector3d q = truth * corner.homogeneous();
    if (!(p.z() > 0.0)) return std::numeric_limits<double>::infinity();
    worst = std::max(worst, (p.hnormalized() - q.hnormalized()).norm());
  }
  return worst;
}

}  // namespace laparoscope_servo::bench
