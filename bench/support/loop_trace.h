// What a run of the loop has shown, for plots: every so manyth image, and a table.
#pragma once

#include <Eigen/Core>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "bench/support/arguments.h"
#include "laparoscope_servo/geometry/sl3.h"

namespace laparoscope_servo::bench {

class LoopTrace {
 public:
  // FOLDER/NAME.csv and FOLDER/NAME_KKKK.png; an empty folder: nothing.
  LoopTrace(const std::string& folder, const std::string& name, int every)
      : folder_(folder), name_(name), every_(every) {
    if (folder.empty()) return;
    std::filesystem::create_directories(folder);
    table_ = create(folder + '/' + name + ".csv");
    table_ << "image,t,x,y,true_x,true_y,slant,a0,a1,a2,a3,a4,a5,a6,a7\n";
  }

  // px: where the target is said to be, and where it is; `slant`: degrees; `a`: of eq. (8), since the image before.
  void add(const cv::Mat& image, double time, const Eigen::Vector2d& place, const Eigen::Vector2d& truth, double slant,
           const geometry::Vector8d& a) {
    if (folder_.empty()) return;
    table_ << count_ << ',' << time << ',' << place.x() << ',' << place.y() << ',' << truth.x() << ',' << truth.y()
           << ',' << slant;
    for (int k = 0; k < 8; ++k) table_ << ',' << a[k];
    table_ << '\n';
    if (count_ % every_ == 0) {
      char number[8];
      std::snprintf(number, sizeof(number), "%04d", count_);
      cv::imwrite(folder_ + '/' + name_ + '_' + number + ".png", image);
    }
    ++count_;
  }

 private:
  std::string folder_, name_;
  int every_;
  int count_ = 0;
  std::ofstream table_;
};

}  // namespace laparoscope_servo::bench
