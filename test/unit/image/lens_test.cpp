#include "laparoscope_servo/image/lens.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <stdexcept>

#include "lens_models.h"
#include "support/error_text.h"

namespace laparoscope_servo::image {
namespace {

cv::Matx33d matrix(const geometry::PinholeCamera& c) {
  return {c.fx, 0.0, c.cx, 0.0, c.fy, c.cy, 0.0, 0.0, 1.0};
}

cv::Matx33d matrix(const Eigen::Matrix3d& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}

std::vector<double> coefficients(const LensParameters& p) {
  const std::size_t counts[] = {5, 8, 4};
  return {p.coefficients.begin(), p.coefficients.begin() + static_cast<long>(counts[static_cast<int>(p.distortion)])};
}

TEST(Lens, ThereAndBackAgainEndsWhereItBegan) {
  for (const LensParameters& p : models()) {
    const Lens lens(p);
    int seen = 0;
    for (int v = 0; v < kSize.height; v += 7) {
      for (int u = 0; u < kSize.width; u += 7) {
        const auto rectified = lens.toRectified(Eigen::Vector2d(u, v));
        if (!rectified) continue;
        ++seen;
        const auto raw = lens.toRaw(*rectified);
        ASSERT_TRUE(raw);
        EXPECT_LT((*raw - Eigen::Vector2d(u, v)).norm(), 1e-5) << name(p) << " at " << u << ", " << v;
      }
    }
    EXPECT_EQ(seen, 69 * 92) << name(p);
  }
}

TEST(Lens, BendsAsOpenCvProjectsPoints) {
  for (const LensParameters& p : models()) {
    const Lens lens(p);
    const cv::Matx33d rotation = matrix(Eigen::Matrix3d(p.rotation.transpose()));
    cv::Vec3d turn;
    cv::Rodrigues(rotation, turn);
    std::vector<cv::Point3d> rays;
    for (int v = 0; v < kSize.height; v += 20) {
      for (int u = 0; u < kSize.width; u += 20) {
        rays.emplace_back((u - p.rectified.cx) / p.rectified.fx, (v - p.rectified.cy) / p.rectified.fy, 1.0);
      }
    }
    std::vector<cv::Point2d> raw;
    if (p.distortion == Distortion::kEquidistant) {
      cv::fisheye::projectPoints(rays, raw, turn, cv::Vec3d(0.0, 0.0, 0.0), matrix(p.raw), coefficients(p));
    } else {
      cv::projectPoints(rays, turn, cv::Vec3d(0.0, 0.0, 0.0), matrix(p.raw), coefficients(p), raw);
    }
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const Eigen::Vector2d rectified(p.rectified.fx * rays[k].x + p.rectified.cx,
                                      p.rectified.fy * rays[k].y + p.rectified.cy);
      const auto mine = lens.toRaw(rectified);
      ASSERT_TRUE(mine) << name(p) << rectified.transpose();
      EXPECT_NEAR(mine->x(), raw[k].x, 1e-6) << name(p);
      EXPECT_NEAR(mine->y(), raw[k].y, 1e-6) << name(p);
    }
  }
}

TEST(Lens, StraightensAsOpenCvUndistortsPoints) {
  for (const LensParameters& p : models()) {
    const Lens lens(p);
    std::vector<cv::Point2d> raw, rectified;
    for (int v = 0; v < kSize.height; v += 20) {
      for (int u = 0; u < kSize.width; u += 20) raw.emplace_back(u, v);
    }
    if (p.distortion == Distortion::kEquidistant) {
      cv::fisheye::undistortPoints(raw, rectified, matrix(p.raw), coefficients(p), matrix(p.rotation),
                                   matrix(p.rectified));
    } else {
      cv::undistortPoints(raw, rectified, matrix(p.raw), coefficients(p), matrix(p.rotation), matrix(p.rectified),
                          cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-12));
    }
    for (std::size_t k = 0; k < raw.size(); ++k) {
      const auto mine = lens.toRectified(Eigen::Vector2d(raw[k].x, raw[k].y));
      ASSERT_TRUE(mine) << name(p);
      EXPECT_NEAR(mine->x(), rectified[k].x, 1e-3) << name(p);
      EXPECT_NEAR(mine->y(), rectified[k].y, 1e-3) << name(p);
    }
  }
}

TEST(Lens, NothingIsSeenWhereThePolynomialTurnsBack) {
  // r (1 - 0.5 r^2) grows up to r^2 = 2 / 3 only; a pixel farther out would be seen nearer to the centre again.
  LensParameters p;
  p.coefficients = {-0.5};
  p.raw = p.rectified = {400.0, 400.0, 320.0, 240.0};
  const Lens lens(p);
  EXPECT_NEAR(lens.field(), 2.0 / 3.0, 0.01);
  EXPECT_TRUE(lens.toRaw({320.0 + 0.80 * 400.0, 240.0}));
  EXPECT_FALSE(lens.toRaw({320.0 + 0.83 * 400.0, 240.0}));
  EXPECT_FALSE(lens.toRaw({320.0 + 1.40 * 400.0, 240.0})) << "which would fold back to the centre";
  EXPECT_FALSE(lens.toRectified({320.0 + 0.56 * 400.0, 240.0})) << "beyond the largest radius that is seen";
  float u[1200], v[1200];
  const Eigen::Matrix3d& rays = lens.raysFromRectified();
  const Eigen::Vector3d start = rays * Eigen::Vector3d(0.0, 240.0, 1.0);
  const ProjectiveRow row = {static_cast<float>(start[0]), static_cast<float>(rays(0, 0)),
                             static_cast<float>(start[1]), static_cast<float>(rays(1, 0)),
                             static_cast<float>(start[2]), static_cast<float>(rays(2, 0))};
  locateRaw(lens.loop({}), row, 0, 1200, u, v);
  for (int i = 0; i < 1200; ++i) {
    const bool seen = lens.toRaw(Eigen::Vector2d(i, 240.0)).has_value();
    EXPECT_EQ(std::isfinite(u[i]) && std::isfinite(v[i]), seen) << i;
  }
}

TEST(Lens, APoleEndsTheField) {
  LensParameters p;
  p.distortion = Distortion::kRationalPolynomial;
  p.coefficients = {0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0};  // r / (1 - r^2)
  p.raw = p.rectified = {400.0, 400.0, 320.0, 240.0};
  EXPECT_LT(Lens(p).field(), 1.0);
  EXPECT_GT(Lens(p).field(), 0.95);
}

TEST(Lens, RefusesWhatIsNoLens) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto error = [](const LensParameters& p) -> std::string {
    return test_support::errorText<std::invalid_argument>([&] { const Lens lens(p); });
  };
  LensParameters p = test::laparoscope(kSize, 500.0);
  EXPECT_EQ(error(p), "");
  p.coefficients[1] = nan;
  EXPECT_NE(error(p).find("coefficient nan"), std::string::npos) << error(p);
  p = test::laparoscope(kSize, 500.0);
  p.raw.fx = 0.0;
  EXPECT_NE(error(p).find("K: "), std::string::npos) << error(p);
  p = test::laparoscope(kSize, 500.0);
  p.rectified.fy = nan;
  EXPECT_NE(error(p).find("P: "), std::string::npos) << error(p);
  p = test::laparoscope(kSize, 500.0);
  p.rotation.setZero();
  EXPECT_NE(error(p).find("R: "), std::string::npos) << error(p);
}

TEST(Lens, NoPointIsSeenFromNowhere) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const LensParameters& p : models()) {
    const Lens lens(p);
    EXPECT_FALSE(lens.toRaw({nan, 3.0}));
    EXPECT_FALSE(lens.toRectified({nan, 3.0}));
    EXPECT_FALSE(lens.toRectified({1e300, 1e300}));
    EXPECT_FALSE(lens.toRaw({1e12, 0.0}));
    const geometry::Quadrilateral none = {Eigen::Vector2d(nan, nan), {nan, nan}, {nan, nan}, {nan, nan}};
    EXPECT_TRUE(rawBox(lens, none, 10.0).empty());
  }
}

TEST(SeenBox, IsEmptyWhereACornerIsNowhere) {
  const geometry::Quadrilateral corners = {Eigen::Vector2d(20, 30), {60, 30}, {60, 50}, {20, 50}};
  EXPECT_FALSE(seenBox(nullptr, corners, 1.0).empty());
  for (std::size_t k = 0; k < 4; ++k) {
    for (const double nowhere : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      geometry::Quadrilateral broken = corners;
      broken[k].x() = nowhere;
      EXPECT_TRUE(seenBox(nullptr, broken, 1.0).empty()) << k;
    }
  }
}

TEST(RawBox, HoldsEveryPixelOfTheQuadrilateral) {
  const geometry::Quadrilateral corners = {Eigen::Vector2d(20, 30), {600, 60}, {580, 440}, {60, 400}};
  const Eigen::Matrix3d g = geometry::fromCorners(geometry::Rectangle{0, 0, 101, 101}.corners(), corners);
  for (const LensParameters& p : models()) {
    const Lens lens(p);
    const cv::Rect box = rawBox(lens, corners, 1.5);
    for (int j = 0; j <= 100; ++j) {
      for (int i = 0; i <= 100; ++i) {
        const auto raw = lens.toRaw(geometry::apply(g, Eigen::Vector2d(i, j)));
        ASSERT_TRUE(raw);
        EXPECT_TRUE(raw->x() >= box.x && raw->y() >= box.y && raw->x() <= box.br().x - 1 && raw->y() <= box.br().y - 1);
      }
    }
  }
}

TEST(RectifiedMap, FollowsTheLens) {
  for (const LensParameters& p : models()) {
    const Lens lens(p);
    const cv::Rect box(101, 53, 250, 211);
    const cv::Mat2f map = rectifiedMap(lens, box);
    for (int j = 0; j < box.height; j += 3) {
      for (int i = 0; i < box.width; i += 3) {
        const auto exact = lens.toRectified(Eigen::Vector2d(box.x + i, box.y + j));
        ASSERT_TRUE(exact);
        EXPECT_NEAR(map(j, i)[0], exact->x(), 0.25);
        EXPECT_NEAR(map(j, i)[1], exact->y(), 0.25);
      }
    }
  }
}

TEST(DrawMask, ShowsTheMaskWhereTheImageShowsTheRegion) {
  cv::Mat1b mask(60, 80, static_cast<unsigned char>(0));
  mask(cv::Rect(0, 0, 40, 60)).setTo(255);
  Eigen::Matrix3d g;
  g << 1.2, 0.1, 200.0, -0.1, 1.1, 150.0, 0.0, 1e-4, 1.0;
  const cv::Rect window(150, 100, 220, 200);
  for (const LensParameters& p : models()) {
    const Lens lens(p);
    cv::Mat1b drawn;
    drawMask(mask, g, &lens, window, drawn);
    int compared = 0;
    for (int v = 0; v < window.height; ++v) {
      for (int u = 0; u < window.width; ++u) {
        const auto rectified = lens.toRectified(Eigen::Vector2d(window.x + u, window.y + v));
        ASSERT_TRUE(rectified);
        const Eigen::Vector2d at = geometry::apply(g.inverse(), *rectified);
        const auto near = [](double x, double border) { return std::abs(x - border) < 1.0; };
        if (near(at.x(), 0.0) || near(at.x(), 39.5) || near(at.y(), 0.0) || near(at.y(), 59.5)) continue;
        const bool inside = at.x() > 0.0 && at.x() < 39.5 && at.y() > 0.0 && at.y() < 59.5;
        EXPECT_EQ(drawn(v, u), inside ? 255 : 0);
        compared += inside ? 1 : 0;
      }
    }
    EXPECT_GT(compared, 500);
  }
}

}  // namespace
}  // namespace laparoscope_servo::image
