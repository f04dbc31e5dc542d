// A reduced image: how far each cell is from grey, and how bright it is.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace laparoscope_servo::features {

class GreyMap {
 public:
  // Colour is stored as kZero + kUnit * S0 cos H / mean(R, G, B), eq. (4) and (5) of Bourger et al. (2007) divided by
  // the brightness, clamped to [0, 255]. Grey is kZero, blue is less, red more.
  static constexpr double kUnit = 128.0;
  static constexpr double kZero = 64.0;

  // `image`: CV_8UC3. The cells have so many pixels a side that about kColumns of them lie side by side.
  void compute(const cv::Mat& image);

  int step() const { return step_; }  // px, side of a cell
  int columns() const { return colour_.cols; }
  int rows() const { return colour_.rows; }
  cv::Size size() const { return colour_.size(); }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < colour_.cols && y < colour_.rows; }
  const cv::Mat1b& colour() const { return colour_; }
  // Grey levels, mean of the three channels.
  const cv::Mat1b& level() const { return level_; }
  // px of the image at a place in cells, and back; the centre of the first cell is (0, 0).
  double toPixel(double cell) const { return cell * step_ + 0.5 * (step_ - 1); }
  double toCell(double pixel) const { return (pixel - 0.5 * (step_ - 1)) / step_; }

  // The cell that a point lies in; (-1, -1), which is in no map, for one that is far out or not finite.
  static cv::Point cellOf(const Eigen::Vector2d& p);

 private:
  static constexpr int kColumns = 200;

  int step_ = 1;
  cv::Mat1b colour_, level_;
  std::vector<std::uint16_t> sums_;        // of `step_` rows, per byte of a row
  std::vector<float> blue_, green_, red_;  // means of a row of cells
};

}  // namespace laparoscope_servo::features
