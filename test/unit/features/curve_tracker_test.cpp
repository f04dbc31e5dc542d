// Lines and ellipses through images whose truth is known: how far off, and whether what is claimed is true.
#include "laparoscope_servo/features/curve_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "laparoscope_servo/features/ellipse.h"
#include "laparoscope_servo/features/line.h"
#include "support/synthetic_edges.h"

namespace laparoscope_servo::features {
namespace {

using Cover = std::function<void(cv::Mat1f&)>;

// A line that sways about the middle of the image, from image to image.
struct SwayingLine {
  explicit SwayingLine(int image)
      : theta(0.5 + 0.05 * std::sin(image / 6.0)),
        middle(160.0 + 8.0 * std::sin(image / 5.0), 120.0 + 6.0 * std::cos(image / 7.0)),
        normal(std::cos(theta), std::sin(theta)),
        direction(-std::sin(theta), std::cos(theta)) {}

  Line line() const { return Line(middle - 90.0 * direction, middle + 90.0 * direction); }
  // Largest distance of a line, over 160 px about the middle.
  double error(const Line& found) const {
    double worst = 0.0;
    for (const double s : {-80.0, 80.0}) {
      worst = std::max(worst, std::abs(found.normal().dot(middle + s * direction) - found.rho()));
    }
    return worst;
  }
  // Of `texture`, from `from` to `to` along the line, 40 px either side.
  Cover cover(double from, double to, const cv::Mat1f& texture) const {
    return [=](cv::Mat1f& image) {
      for (int v = 0; v < image.rows; ++v) {
        for (int u = 0; u < image.cols; ++u) {
          const Eigen::Vector2d p = Eigen::Vector2d(u, v) - middle;
          const double s = p.dot(direction);
          if (s > from && s < to && std::abs(p.dot(normal)) < 40.0) image(v, u) = texture(v, u);
        }
      }
    };
  }
  cv::Mat draw(const test::EdgeScene& scene, const Cover& over = nullptr) const {
    return test::draw(scene, test::halfPlane(normal.dot(middle), theta), over);
  }

  double theta;
  Eigen::Vector2d middle, normal, direction;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.at(values.size() / 2);
}

test::EdgeScene sceneOf(int image) {
  test::EdgeScene scene;
  scene.seed = static_cast<unsigned>(image + 1);
  return scene;
}

TEST(CurveTracker, followsALineToAFractionOfAPixel) {
  CurveTracker<Line> tracker;
  std::vector<double> errors;
  for (int k = 0; k < 20; ++k) {
    const SwayingLine truth(k);
    const cv::Mat image = truth.draw(sceneOf(k));
    if (k == 0) {
      EXPECT_TRUE(tracker.select(image, 0.0, truth.line()).selected_now);
      continue;
    }
    const CurveResult<Line>& result = tracker.track(image, 0.04 * k);
    ASSERT_EQ(result.state, State::kTracking) << reasonText(result.reason);
    EXPECT_GT(result.share, 0.9);
    EXPECT_LT(truth.error(result.curve), std::max(0.1, 4.0 * result.expected_error));
    errors.push_back(truth.error(result.curve));
  }
  EXPECT_LT(median(errors), 0.03);
}

// Three fifths of it are covered, by what has edges of its own, or none.
TEST(CurveTracker, followsALineOfWhichTwoFifthsAreSeen) {
  for (const double contrast : {0.0, 25.0}) {
    CurveTracker<Line> tracker;
    std::vector<double> errors;
    for (int k = 0; k < 20; ++k) {
      const SwayingLine truth(k);
      const test::EdgeScene scene = sceneOf(k);
      const cv::Mat1f texture = test::texture(scene.size, 110.0, contrast, 3.0, 7);
      const cv::Mat image = truth.draw(scene, k == 0 ? Cover() : truth.cover(-18.0, 100.0, texture));
      if (k == 0) {
        tracker.select(image, 0.0, truth.line());
        continue;
      }
      const CurveResult<Line>& result = tracker.track(image, 0.04 * k);
      if (result.state != State::kTracking) continue;
      EXPECT_LT(truth.error(result.curve), std::max(0.3, 5.0 * result.expected_error)) << "image " << k;
      errors.push_back(truth.error(result.curve));
    }
    EXPECT_GE(errors.size(), 15u) << contrast;
    EXPECT_LT(median(errors), 0.1) << contrast;
  }
}

TEST(CurveTracker, claimsNoLineThatIsWhollyCoveredAndFindsItAfterwards) {
  for (const double contrast : {0.0, 25.0}) {
    CurveTracker<Line> tracker;
    for (int k = 0; k < 40; ++k) {
      const SwayingLine truth(k);
      const test::EdgeScene scene = sceneOf(k);
      const cv::Mat1f texture = test::texture(scene.size, 110.0, contrast, 3.0, 7);
      const bool covered = k > 4 && k < 30;
      const cv::Mat image = truth.draw(scene, covered ? truth.cover(-400.0, 400.0, texture) : Cover());
      if (k == 0) {
        tracker.select(image, 0.0, truth.line());
        continue;
      }
      const CurveResult<Line>& result = tracker.track(image, 0.04 * k);
      if (covered) {
        EXPECT_EQ(result.state, State::kSearching) << "image " << k << ", contrast " << contrast;
        EXPECT_TRUE(std::isinf(result.expected_error));
      }
      if (k < 5 || k > 36) {
        EXPECT_EQ(result.state, State::kTracking) << "image " << k << ": " << reasonText(result.reason);
        EXPECT_LT(truth.error(result.curve), 0.2);
      }
    }
  }
}

// The edge of a thing that looks different slides over the line, and lies next to it when the line is gone.
TEST(CurveTracker, doesNotTakeAnotherEdgeForTheLine) {
  CurveTracker<Line> tracker;
  for (int k = 0; k < 20; ++k) {
    const SwayingLine truth(0);
    const cv::Mat image = truth.draw(
        sceneOf(k), k < 5 ? Cover() : [&](cv::Mat1f& pixels) {
          for (int v = 0; v < pixels.rows; ++v) {
            for (int u = 0; u < pixels.cols; ++u) {
              if ((Eigen::Vector2d(u, v) - truth.middle).dot(truth.normal) < 12.0) pixels(v, u) = 50.0f;
            }
          }
        });
    if (k == 0) {
      tracker.select(image, 0.0, truth.line());
      continue;
    }
    const CurveResult<Line>& result = tracker.track(image, 0.04 * k);
    EXPECT_EQ(result.state, k < 5 ? State::kTracking : State::kSearching) << "image " << k;
  }
}

TEST(CurveTracker, bearsLightThatChanges) {
  CurveTracker<Line> tracker;
  for (int k = 0; k < 20; ++k) {
    const SwayingLine truth(k);
    cv::Mat image = truth.draw(sceneOf(k));
    image.convertTo(image, -1, k < 10 ? 1.0 : 0.7, k < 10 ? 0.0 : 15.0);
    if (k == 0) {
      tracker.select(image, 0.0, truth.line());
      continue;
    }
    const CurveResult<Line>& result = tracker.track(image, 0.04 * k);
    ASSERT_EQ(result.state, State::kTracking) << "image " << k << ": " << reasonText(result.reason);
    EXPECT_LT(truth.error(result.curve), 0.2);
  }
}

// The brighter side goes to the other one: another edge, wherever it lies.
TEST(CurveTracker, remembersTheSignOfTheContrast) {
  CurveTracker<Line> tracker;
  const SwayingLine truth(0);
  tracker.select(truth.draw(sceneOf(0)), 0.0, truth.line());
  EXPECT_EQ(tracker.track(truth.draw(sceneOf(1)), 0.04).state, State::kTracking);
  test::EdgeScene reversed = sceneOf(2);
  std::swap(reversed.dark, reversed.bright);
  EXPECT_EQ(tracker.track(truth.draw(reversed), 0.08).state, State::kSearching);
}

TEST(CurveTracker, aMotionThatIsKnownLeadsFurtherThanTheRange) {
  const SwayingLine truth(0);
  Eigen::Matrix3d motion = Eigen::Matrix3d::Identity();
  motion.topRightCorner<2, 1>() = -45.0 * truth.normal;
  CurveTracker<Line> tracker;
  tracker.select(truth.draw(sceneOf(0)), 0.0, truth.line());
  SwayingLine moved(0);
  moved.middle -= 45.0 * truth.normal;
  const CurveResult<Line>& result = tracker.track(moved.draw(sceneOf(1)), 0.04, motion);
  EXPECT_EQ(result.state, State::kTracking);
  EXPECT_LT(moved.error(result.curve), 0.2);
  // One that is none is ignored.
  motion.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(tracker.track(moved.draw(sceneOf(2)), 0.08, motion).state, State::kTracking);
}

struct SwayingEllipse {
  explicit SwayingEllipse(int k)
      : centre(160.0 + 8.0 * std::sin(k / 5.0), 120.0 + 6.0 * std::cos(k / 7.0)),
        a(70.0 * (1.0 + 0.1 * std::sin(k / 8.0))),
        b(45.0 * (1.0 + 0.1 * std::sin(k / 6.0))),
        angle(0.4 + 0.1 * std::sin(k / 5.0)) {}

  Ellipse ellipse() const { return Ellipse(centre, a, b, angle); }
  cv::Mat draw(const test::EdgeScene& scene, const Cover& over = nullptr) const {
    return test::draw(scene, test::ellipse(centre, a, b, angle), over);
  }
  // Distances of the found one along the true normals.
  std::vector<double> errors(const Ellipse& found) const {
    const EllipseCoefficients k = found.coefficients();
    std::vector<Site> sites;
    ellipse().sites(4.0, 64, sites);
    std::vector<double> result;
    for (const Site& site : sites) {
      const auto at = [&](double d) {
        const Eigen::Vector2d p = site.point + d * site.normal;
        return p.x() * p.x() + k[0] * p.y() * p.y() + 2.0 * (k[1] * p.x() * p.y() + k[2] * p.x() + k[3] * p.y()) + k[4];
      };
      double d = 0.0;
      for (int i = 0; i < 6; ++i) d -= 1e-4 * at(d) / (at(d + 1e-4) - at(d));
      result.push_back(std::abs(d));
    }
    return result;
  }

  Eigen::Vector2d centre;
  double a, b, angle;
};

TEST(CurveTracker, followsAnEllipseToAFractionOfAPixel) {
  CurveTracker<Ellipse> tracker;
  std::vector<double> errors;
  for (int k = 0; k < 20; ++k) {
    const SwayingEllipse truth(k);
    const cv::Mat image = truth.draw(sceneOf(k));
    if (k == 0) {
      tracker.select(image, 0.0, Ellipse(truth.centre + Eigen::Vector2d(1.5, -1.0), 71.0, 44.0, 0.42));
      continue;
    }
    const CurveResult<Ellipse>& result = tracker.track(image, 0.04 * k);
    ASSERT_EQ(result.state, State::kTracking) << reasonText(result.reason);
    const std::vector<double> distances = truth.errors(result.curve);
    EXPECT_LT(*std::max_element(distances.begin(), distances.end()), std::max(0.15, 4.0 * result.expected_error));
    errors.push_back(median(distances));
  }
  EXPECT_LT(median(errors), 0.05);
}

TEST(CurveTracker, whatItClaimsOfAnEllipseUnderCoverIsTrue) {
  for (const double contrast : {0.0, 25.0}) {
    CurveTracker<Ellipse> tracker;
    int claims = 0;
    for (int k = 0; k < 20; ++k) {
      const SwayingEllipse truth(k);
      const test::EdgeScene scene = sceneOf(k);
      const cv::Mat1f texture = test::texture(scene.size, 110.0, contrast, 3.0, 7);
      const cv::Mat image = truth.draw(scene, [&](cv::Mat1f& pixels) {
        if (k == 0) return;
        for (int v = 0; v < pixels.rows; ++v) {
          for (int u = 0; u < pixels.cols; ++u) {
            if (std::abs(std::atan2(v - truth.centre.y(), u - truth.centre.x())) < 0.45 * M_PI) {
              pixels(v, u) = texture(v, u);
            }
          }
        }
      });
      if (k == 0) {
        tracker.select(image, 0.0, truth.ellipse());
        continue;
      }
      const CurveResult<Ellipse>& result = tracker.track(image, 0.04 * k);
      if (result.state != State::kTracking) continue;
      ++claims;
      const std::vector<double> distances = truth.errors(result.curve);
      EXPECT_LT(*std::max_element(distances.begin(), distances.end()), std::max(0.3, 5.0 * result.expected_error))
          << "image " << k << ", contrast " << contrast;
    }
    if (contrast == 0.0) {
      EXPECT_GE(claims, 15);
    }
  }
}

// The same kind of contour, but larger by a quarter, is all that is left.
TEST(CurveTracker, doesNotTakeAnotherContourForTheEllipse) {
  CurveTracker<Ellipse> tracker;
  for (int k = 0; k < 30; ++k) {
    SwayingEllipse truth(0);
    const bool other = k > 4 && k < 15;
    if (other) {
      truth.a *= 1.3;
      truth.b *= 1.3;
    }
    const cv::Mat image = truth.draw(sceneOf(k));
    if (k == 0) {
      tracker.select(image, 0.0, truth.ellipse());
      continue;
    }
    const CurveResult<Ellipse>& result = tracker.track(image, 0.04 * k);
    if (other) {
      EXPECT_EQ(result.state, State::kSearching) << "image " << k;
    }
    if (k > 20) {
      EXPECT_EQ(result.state, State::kTracking) << "image " << k << ": " << reasonText(result.reason);
    }
  }
}

TEST(CurveTracker, refusesSelectionsAndGoesOn) {
  const SwayingLine truth(0);
  const cv::Mat image = truth.draw(sceneOf(0));
  CurveTracker<Line> tracker;
  tracker.select(image, 0.0, truth.line());
  EXPECT_THROW(tracker.select(image, 0.0, Line({400.0, 10.0}, {400.0, 200.0})), std::invalid_argument);
  EXPECT_THROW(tracker.select(image, 0.0, Line({20.0, 20.0}, {20.0, 100.0})), std::invalid_argument);
  EXPECT_THROW(tracker.select(cv::Mat(), 0.0, truth.line()), std::invalid_argument);
  EXPECT_THROW(tracker.select(cv::Mat(240, 320, CV_32FC1, cv::Scalar(0)), 0.0, truth.line()), std::invalid_argument);
  EXPECT_THROW(tracker.select(image, std::numeric_limits<double>::quiet_NaN(), truth.line()), std::invalid_argument);
  EXPECT_THROW(tracker.track(cv::Mat(), 0.02), std::invalid_argument);
  EXPECT_EQ(tracker.track(truth.draw(sceneOf(1)), 0.04).state, State::kTracking);
  EdgeConfig config;
  config.range = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(CurveTracker<Line>{config}, std::invalid_argument);
}

TEST(CurveTracker, resetsWhenTimeJumpsBackOrTheImageChanges) {
  const SwayingLine truth(0);
  const cv::Mat image = truth.draw(sceneOf(0));
  CurveTracker<Line> tracker;
  EXPECT_EQ(tracker.track(image, 0.0).state, State::kIdle);
  tracker.select(image, 10.0, truth.line());
  EXPECT_EQ(tracker.track(image, 9.0).reason, Reason::kTimeJumpedBack);
  EXPECT_EQ(tracker.track(image, 11.0).state, State::kIdle);
  tracker.select(image, 10.0, truth.line());
  EXPECT_EQ(tracker.track(image(cv::Rect(0, 0, 200, 200)), 10.1).reason, Reason::kImageChanged);
  tracker.select(image, 10.0, truth.line());
  tracker.reset();
  EXPECT_EQ(tracker.track(image, 10.1).reason, Reason::kReset);
}

TEST(CurveTracker, theSameImagesGiveTheSameNumbers) {
  CurveTracker<Ellipse> a, b;
  for (int k = 0; k < 5; ++k) {
    const SwayingEllipse truth(k);
    const cv::Mat image = truth.draw(sceneOf(k));
    if (k == 0) {
      a.select(image, 0.0, truth.ellipse());
      b.select(image, 0.0, truth.ellipse());
      continue;
    }
    EXPECT_EQ(a.track(image, 0.04 * k).curve.coefficients(), b.track(image, 0.04 * k).curve.coefficients());
    EXPECT_EQ(a.covariance(), b.covariance());
  }
}

}  // namespace
}  // namespace laparoscope_servo::features
