// Which images go on with the sequence that a tracker has begun: one size and type, and time that does not go back.
#pragma once

#include <opencv2/core.hpp>

#include "laparoscope_servo/features/feature_state.h"

namespace laparoscope_servo::features {

class ImageSequence {
 public:
  // A sequence begins with this image, in place of what was. Stamps are seconds.
  void begin(const cv::Mat& image, double stamp);
  // There is no sequence any more.
  void end() { begun_ = false; }

  // kNone: this image goes on with the sequence. kFirstImage: there is no sequence. kImageChanged: its size or type is
  // another one, whatever its stamp. kTimeJumpedBack: its stamp lies before the last one; it may repeat it. Throws
  // std::invalid_argument for an image or a stamp that image::checkImage refuses.
  Reason judge(const cv::Mat& image, double stamp) const;
  // An image that goes on with the sequence was processed.
  void goOn(double stamp) { stamp_ = stamp; }

  double stamp() const { return stamp_; }  // s, of the last image

 private:
  bool begun_ = false;
  cv::Size size_;
  int type_ = 0;
  double stamp_ = 0.0;
};

}  // namespace laparoscope_servo::features
