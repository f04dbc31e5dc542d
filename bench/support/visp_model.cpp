#include "bench/support/visp_model.h"

#include <visp3/core/vpException.h>
#include <visp3/core/vpImage.h>
#include <visp3/mbt/vpMbGenericTracker.h>

#include <cmath>

namespace laparoscope_servo::bench {

namespace {

void convert(const cv::Mat& image, vpImage<unsigned char>& grey) {
  grey.resize(static_cast<unsigned>(image.rows), static_cast<unsigned>(image.cols));
  image.copyTo(cv::Mat(image.rows, image.cols, CV_8UC1, grey.bitmap));
}

vpHomogeneousMatrix matrix(const Eigen::Isometry3d& pose) {
  vpHomogeneousMatrix result;
  for (unsigned i = 0; i < 4; ++i) {
    for (unsigned j = 0; j < 4; ++j) result[i][j] = pose.matrix()(static_cast<int>(i), static_cast<int>(j));
  }
  return result;
}

template <class Function>
bool succeeds(const Function& function) {
  try {
    function();
    return true;
  } catch (const vpException&) {
    return false;
  }
}

}  // namespace

struct VispModel::Implementation {
  vpMbGenericTracker tracker{1, vpMbGenericTracker::EDGE_TRACKER};
  vpImage<unsigned char> image;
  bool lost = false;
};

VispModel::VispModel(const std::string& path, const geometry::PinholeCamera& camera, int range)
    : implementation_(std::make_unique<Implementation>()) {
  vpMbGenericTracker& tracker = implementation_->tracker;
  vpMe me;
  me.setRange(static_cast<unsigned>(range));
  me.setSampleStep(4);
  me.setMaskSize(5);
  me.setMaskNumber(180);
  me.setThreshold(5000);
  me.setMu1(0.5);
  me.setMu2(0.5);
  tracker.setMovingEdge(me);
  vpCameraParameters intrinsics;
  intrinsics.initPersProjWithoutDistortion(camera.fx, camera.fy, camera.cx, camera.cy);
  tracker.setCameraParameters(intrinsics);
  tracker.setAngleAppear(vpMath::rad(65.0));
  tracker.setAngleDisappear(vpMath::rad(75.0));
  tracker.setScanLineVisibilityTest(true);  // parts hide one another, as for ours
  tracker.loadModel(path);
}

VispModel::~VispModel() = default;

bool VispModel::select(const cv::Mat& image, const Eigen::Isometry3d& camera_T_object) {
  Implementation& i = *implementation_;
  convert(image, i.image);
  i.lost = !succeeds([&] { i.tracker.initFromPose(i.image, matrix(camera_T_object)); });
  return !i.lost;
}

bool VispModel::track(const cv::Mat& image) {
  Implementation& i = *implementation_;
  convert(image, i.image);
  i.lost = i.lost || !succeeds([&] { i.tracker.track(i.image); });
  return !i.lost;
}

Eigen::Isometry3d VispModel::pose() const {
  const vpHomogeneousMatrix found = implementation_->tracker.getPose();
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 4; ++j) result.matrix()(i, j) = found[static_cast<unsigned>(i)][static_cast<unsigned>(j)];
  }
  return result;
}

}  // namespace laparoscope_servo::bench
