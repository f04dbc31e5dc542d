#include "laparoscope_servo/image/patch.h"

namespace laparoscope_servo::image {

void Patch::extrapolate() {
  const int last = width_ - 1;
  for (int j = 0; j < height_; ++j) {
    float* r = row(j);
    r[-1] = width_ > 1 ? 2.0f * r[0] - r[1] : r[0];
    r[width_] = width_ > 1 ? 2.0f * r[last] - r[last - 1] : r[last];
  }
  const float* first = row(0);
  const float* second = row(height_ > 1 ? 1 : 0);
  const float* bottom = row(height_ - 1);
  const float* above = row(height_ > 1 ? height_ - 2 : 0);
  float* before = row(-1);
  float* after = row(height_);
  for (int i = 0; i < width_; ++i) {
    before[i] = 2.0f * first[i] - second[i];
    after[i] = 2.0f * bottom[i] - above[i];
  }
}

}  // namespace laparoscope_servo::image
