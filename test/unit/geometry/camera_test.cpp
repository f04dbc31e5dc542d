#include "laparoscope_servo/geometry/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace laparoscope_servo::geometry {
namespace {

const PinholeCamera kCamera{400.0, 300.0, 320.0, 240.0};

TEST(PinholeCamera, ProjectsAsTheConventionSays) {
  // x right, y down, the centre of the first pixel at (0, 0).
  EXPECT_EQ(Eigen::Vector3d(kCamera.matrix() * Eigen::Vector3d(0, 0, 1)), Eigen::Vector3d(320, 240, 1));
  EXPECT_EQ(Eigen::Vector3d(kCamera.matrix() * Eigen::Vector3d(0.1, 0.2, 1)), Eigen::Vector3d(360, 300, 1));
}

TEST(PinholeCamera, InverseUndoesTheMatrix) {
  EXPECT_TRUE((kCamera.inverseMatrix() * kCamera.matrix()).isApprox(Eigen::Matrix3d::Identity(), 1e-15));
  EXPECT_TRUE((kCamera.matrix() * kCamera.inverseMatrix()).isApprox(Eigen::Matrix3d::Identity(), 1e-15));
}

TEST(PinholeCamera, ReadsARowMajorMatrix) {
  const double k[9] = {400, 0, 320, 0, 300, 240, 0, 0, 1};
  EXPECT_EQ(cameraFromRowMajor(k).matrix(), kCamera.matrix());
}

TEST(PinholeCamera, EqualsItselfToTheLastDigit) {
  EXPECT_TRUE(kCamera == kCamera);
  EXPECT_FALSE(kCamera != kCamera);
  for (double PinholeCamera::*field :
       {&PinholeCamera::fx, &PinholeCamera::fy, &PinholeCamera::cx, &PinholeCamera::cy}) {
    PinholeCamera other = kCamera;
    other.*field = std::nextafter(other.*field, 1e9);
    EXPECT_TRUE(other != kCamera);
    other.*field = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(other == other);
    EXPECT_TRUE(other != other);
  }
}

TEST(PinholeCamera, NamesWhatIsWrong) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(kCamera.error(), "");
  EXPECT_NE(PinholeCamera().error().find("focal lengths (0, 0)"), std::string::npos);
  for (const double bad : {0.0, -400.0, nan, infinity}) {
    EXPECT_NE((PinholeCamera{bad, 300, 320, 240}.error().find("focal")), std::string::npos) << bad;
    EXPECT_NE((PinholeCamera{400, bad, 320, 240}.error().find("focal")), std::string::npos) << bad;
  }
  for (const double bad : {nan, infinity, -infinity}) {
    EXPECT_NE((PinholeCamera{400, 300, bad, 240}.error().find("principal point")), std::string::npos) << bad;
    EXPECT_NE((PinholeCamera{400, 300, 320, bad}.error().find("principal point")), std::string::npos) << bad;
  }
  EXPECT_EQ((PinholeCamera{400, 300, -50, 1000}.error()), "");  // a cropped image may have its centre outside
}

}  // namespace
}  // namespace laparoscope_servo::geometry
