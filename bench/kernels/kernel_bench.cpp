#include "bench/kernels/kernel_bench.h"

#include <random>

#include "bench/support/synthetic.h"
#include "laparoscope_servo/image/warp.h"

namespace laparoscope_servo::bench {

Scene::Scene(const benchmark::State& state)
    : side(static_cast<int>(state.range(0))),
      roi{(960 - side) / 2.0, (720 - side) / 2.0, static_cast<double>(side), static_cast<double>(side)},
      image(syntheticTissue(cv::Size(960, 720), 1)),
      image_T_patch(Eigen::Matrix3d::Identity()) {
  std::mt19937 random(1);
  moved = displacedCorners(roi, 3.0, random);
  seen = view(image, moved, 2.0, random);
  const cv::Rect everything(0, 0, image.cols, image.rows);
  reference.build(image, everything, 3, image::kLuma);
  current.build(seen, everything, 3, image::kLuma);
  image_T_patch.topRightCorner<2, 1>() << roi.x, roi.y;
}

Patches::Patches(const Scene& scene) {
  for (image::Patch* patch : {&reference, &warped, &valid}) patch->resize(scene.side, scene.side);
  image::warpBilinear(scene.reference.level(0), scene.image_T_patch, reference, valid);
  image::gradients(reference, reference_gx, reference_gy);
  image::warpBilinear(scene.current.level(0), scene.moved * scene.image_T_patch, warped, valid);
  warped.extrapolate();
}

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
