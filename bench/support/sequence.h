// Images with or without ground truth: a folder made by the sequence generator (frames/NNNN.png, truth.csv, areas.csv,
// scene.json), any folder of images, or a video file.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"

namespace laparoscope_servo::bench {

class Sequence {
 public:
  // Throws std::runtime_error, with the path, when there is nothing to read or the truth does not fit the frames.
  explicit Sequence(const std::string& path);

  const std::string& name() const { return name_; }
  // The next image, CV_8UC3; false at the end.
  bool next(cv::Mat& image);
  // Starts again.
  void rewind();

  bool hasTruth() const { return !truth_.empty(); }
  bool hasRoi() const { return roi_.width > 0.0; }
  const geometry::Rectangle& roi() const { return roi_; }
  // Reference to current pixels, determinant 1, per frame.
  const std::vector<Eigen::Matrix3d>& truth() const { return truth_; }
  // Share of the ROI that is covered, per frame, 0 to 1.
  const std::vector<double>& covered() const { return covered_; }
  // Share of each of the ROI's 14 x 14 areas that is covered, row by row, per frame; empty without areas.csv.
  const std::vector<std::vector<double>>& areas() const { return areas_; }
  // Grey levels, of the images.
  double noise() const { return noise_; }

 private:
  void readScene(const std::string& file);
  void readTruth(const std::string& file);
  void readAreas(const std::string& file);

  std::string path_, name_;
  std::vector<std::string> files_;
  std::size_t position_ = 0;
  cv::VideoCapture video_;
  geometry::Rectangle roi_;
  std::vector<Eigen::Matrix3d> truth_;
  std::vector<double> covered_;
  std::vector<std::vector<double>> areas_;
  double noise_ = 2.0;
};

// An image file, or FILE@N for image N, from 0, of a video. Throws std::runtime_error, with the name.
cv::Mat readImage(const std::string& name);

// px: how far the worst of the ROI's corners is from where it should be; infinite where g takes one through infinity.
double cornerError(const Eigen::Matrix3d& g, const Eigen::Matrix3d& truth, const geometry::Rectangle& roi);

// Wrong by this many pixels or more is lost; saying otherwise is a lie.
constexpr double kLost = 5.0;

}  // namespace laparoscope_servo::bench
