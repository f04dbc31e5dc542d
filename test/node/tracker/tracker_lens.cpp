// The tracker with rectify: true: waits for camera_info, tracks in rectified pixels, draws on the raw image.
#include <gtest/gtest.h>

#include "camera_bench.h"
#include "support/lens_info.h"

namespace laparoscope_servo {
namespace {

using test_support::CameraBench;
using test_support::DiagnosticsListener;
using test_support::Inbox;
using test_support::waitFor;

const cv::Size kSize(320, 240);
const geometry::Rectangle kRoi{40.0, 30.0, 90.0, 80.0};

class TrackerLens : public testing::Test {
 protected:
  static ros::Time nextStamp() {
    static ros::Time stamp(1000, 0);
    stamp += ros::Duration(0.04);
    return stamp;
  }

  // camera_info and images come over two connections: an image after which it has arrived.
  HomographyConstPtr trackUntil(std::uint8_t state, const cv::Mat& image) {
    HomographyConstPtr homography;
    waitFor([&] {
      homography = bench_.track(image, nextStamp());
      return homography && homography->state == state;
    });
    return homography;
  }

  const image::Lens lens_{test::laparoscope(kSize, 220.0)};
  const test::LensView view_{lens_, kSize};
  const cv::Mat scene_ = test_support::texture(cv::Size(420, 320));
  const std::vector<Eigen::Matrix3d> motion_ = test_support::motion(20, kRoi, 20.0);
  CameraBench bench_{"/"};
};

TEST_F(TrackerLens, TracksOnceItKnowsTheLensAndEndsWithIt) {
  ASSERT_TRUE(bench_.ready());
  DiagnosticsListener diagnostics(bench_.node(), "tracker");
  const cv::Mat first = view_(scene_, motion_[0]);
  const auto images = [&] {
    const HomographyConstPtr homography = bench_.track(first, nextStamp());
    return homography && homography->state == Homography::IDLE &&
           diagnostics.last().message.find("cannot be rectified: no camera_info") != std::string::npos;
  };
  ASSERT_TRUE(waitFor(images)) << diagnostics.last();

  sensor_msgs::CameraInfo bad = test_support::lensInfo(lens_, kSize);
  bad.distortion_model = "fov";
  bench_.publishInfo(bad);
  ASSERT_TRUE(waitFor([&] {
    bench_.track(first, nextStamp());
    return diagnostics.last().message.find("'fov'") != std::string::npos;
  })) << diagnostics.last();

  bench_.publishInfo(test_support::lensInfo(lens_, kSize));
  ASSERT_TRUE(trackUntil(Homography::TRACKING, first));
  Inbox<sensor_msgs::Image> masks(bench_.node(), "tracker/occlusion_mask");
  Inbox<sensor_msgs::Image> overlays(bench_.node(), "tracker/overlay");
  for (std::size_t k = 1; k < motion_.size(); ++k) {
    const HomographyConstPtr homography = bench_.track(view_(scene_, motion_[k]), nextStamp());
    ASSERT_TRUE(homography);
    ASSERT_EQ(homography->state, Homography::TRACKING) << k;
    EXPECT_TRUE(homography->has_intrinsics);
    const geometry::Quadrilateral truth = geometry::apply(motion_[k], kRoi.corners());
    for (std::size_t c = 0; c < 4; ++c) {
      EXPECT_NEAR(homography->corners[2 * c], truth[c].x(), 0.2);
      EXPECT_NEAR(homography->corners[2 * c + 1], truth[c].y(), 0.2);
    }
  }
  ros::Time stamp;
  ASSERT_TRUE(waitFor([&] {
    stamp = nextStamp();
    bench_.track(first, stamp);
    return waitFor([&] { return masks.at(stamp) && overlays.at(stamp); }, 0.2);
  }));
  EXPECT_EQ(masks.at(stamp)->width, 320u);
  EXPECT_EQ(overlays.at(stamp)->width, 320u);

  sensor_msgs::CameraInfo other = test_support::lensInfo(lens_, kSize);
  other.D[0] += 0.05;
  bench_.publishInfo(other);
  ASSERT_TRUE(trackUntil(Homography::IDLE, first));
  EXPECT_TRUE(waitFor([&] { return diagnostics.value("last reset").find("lens changed") != std::string::npos; }))
      << diagnostics.last();
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "tracker_lens_test");
}
