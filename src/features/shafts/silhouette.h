// The part of an image that an instrument covers: its shaft, by the edges, and what hangs on to it and is grey: wrist
// and jaws.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "features/shafts/grey_map.h"
#include "features/shafts/mask_drawing.h"
#include "features/shafts/shaft_finder.h"
#include "laparoscope_servo/image/field_of_view.h"

namespace laparoscope_servo::features {

class Silhouette {
 public:
  // Cells that are grey, hang on to the shaft, and lie where wrist and jaws may be.
  void grow(const GreyMap& map, const image::FieldOfView& view, double threshold, const Shaft& shaft);

  bool found() const { return count_ > 0; }
  // Cells: the cell furthest along the axis, to a fraction of a cell along it.
  const Eigen::Vector2d& tip() const { return tip_; }
  int count() const { return count_; }  // cells
  // Share of the cells between the shaft's edges that belong to it.
  double fill() const { return fill_; }

  // Adds it to `mask` (CV_8UC1, size of the image), 255 for its pixels, grown by `margin` px.
  void draw(const GreyMap& map, double threshold, const Shaft& shaft, double margin, cv::Mat1b& mask);

 private:
  void dropDeadEnds(const GreyMap& map, double strict, const Shaft& shaft);
  void measure(const GreyMap& map, double threshold, const Shaft& shaft);
  void fillHoles();
  bool mayBe(const Shaft& shaft, const Eigen::Vector2d& p) const;
  cv::Rect drawGrey(const GreyMap& map, double threshold);
  void drawRow(int step, int cells, int limit, uchar* to) const;
  bool isNear(const cv::Point& cell, const cv::Rect& box) const;

  cv::Mat1b cells_;  // 255 for its cells, less for holes in it
  std::vector<cv::Point> stack_;
  cv::Rect box_;
  int count_ = 0;
  double fill_ = 0.0;
  Eigen::Vector2d tip_ = Eigen::Vector2d::Zero();
  cv::Mat1b part_, drawn_;
  std::vector<int> row_;  // of cells, between two rows
  MaskGrowth growth_;
};

}  // namespace laparoscope_servo::features
