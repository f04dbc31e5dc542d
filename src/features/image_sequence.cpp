#include "laparoscope_servo/features/image_sequence.h"

#include "laparoscope_servo/image/image_type.h"

namespace laparoscope_servo::features {

void ImageSequence::begin(const cv::Mat& image, double stamp) {
  begun_ = true;
  size_ = image.size();
  type_ = image.type();
  stamp_ = stamp;
}

Reason ImageSequence::judge(const cv::Mat& image, double stamp) const {
  image::checkImage(image, stamp);
  if (!begun_) return Reason::kFirstImage;
  if (image.size() != size_ || image.type() != type_) return Reason::kImageChanged;
  return stamp < stamp_ ? Reason::kTimeJumpedBack : Reason::kNone;
}

}  // namespace laparoscope_servo::features
