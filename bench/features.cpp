// The trackers of features - line, ellipse, spline, dots - on images whose truth is known, beside ViSP's on the same
// images, in one run, on one thread. All get each image before any gets the next. Times are of the processor.
#include <boost/program_options.hpp>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>

#include "bench/support/arguments.h"
#include "bench/support/cpu_clock.h"
#include "bench/support/statistics.h"
#include "laparoscope_servo/features/curve_tracker.h"
#include "laparoscope_servo/features/dots.h"
#include "laparoscope_servo/features/ellipse.h"
#include "laparoscope_servo/features/line.h"
#include "laparoscope_servo/features/spline.h"
#include "test/support/synthetic_contour.h"
#include "test/support/synthetic_edges.h"
#ifdef LAPAROSCOPE_SERVO_BENCH_VISP
#include "bench/support/visp_features.h"
#endif

namespace laparoscope_servo::bench {

namespace {

using features::Ellipse;
using features::Line;
using features::State;
using test::Region;
using Cover = std::function<void(cv::Mat1f&)>;

// What a tracker says of an image: how far each part of the feature is from the truth, px; nothing when it claims none.
using Errors = std::vector<double>;

struct Contestant {
  std::string name;
  std::function<void(const cv::Mat&)> select;
  std::function<Errors(const cv::Mat&)> track;
  std::vector<double> errors, ms;
  int kept = 0, lies = 0;
};

constexpr double kLie = 1.0;  // px: a feature that is claimed and is further off, on average

void process(std::vector<Contestant>& contestants, const cv::Mat& image, int index) {
  for (std::size_t k = 0; k < contestants.size(); ++k) {
    Contestant& c = contestants[(k + static_cast<std::size_t>(index)) % contestants.size()];
    if (index == 0) {
      c.select(image);
      continue;
    }
    const double start = cpuTime();
    const Errors errors = c.track(image);
    c.ms.push_back(1e3 * (cpuTime() - start));
    if (errors.empty()) continue;
    const double middle = quantile(errors, 0.5);
    (middle < kLie ? c.kept : c.lies) += 1;
    if (middle < kLie) c.errors.push_back(middle);
  }
}

void print(const std::string& scene, const std::vector<Contestant>& contestants, int images) {
  for (const Contestant& c : contestants) {
    std::cout << std::left << std::setw(24) << scene << std::setw(12) << c.name << std::right << std::fixed
              << std::setprecision(4) << std::setw(10) << quantile(c.errors, 0.5) << std::setw(10)
              << quantile(c.errors, 0.95) << std::setw(8) << c.kept << std::setw(6) << c.lies << std::setw(8)
              << images - c.kept - c.lies << std::setprecision(3) << std::setw(9) << quantile(c.ms, 0.5) << '\n';
  }
  std::cout << std::flush;
}

test::EdgeScene sceneOf(int image) {
  test::EdgeScene scene;  // contrast 60, noise 2, blur 1 px
  scene.size = {320, 240};
  scene.seed = static_cast<unsigned>(image + 1);
  return scene;
}

struct LineTruth {
  explicit LineTruth(int k)
      : theta(0.5 + 0.05 * std::sin(k / 6.0)),
        middle(160.0 + 8.0 * std::sin(k / 5.0), 120.0 + 6.0 * std::cos(k / 7.0)),
        normal(std::cos(theta), std::sin(theta)),
        direction(-std::sin(theta), std::cos(theta)) {}
  Eigen::Vector2d at(double along) const { return middle + along * direction; }
  Errors errors(double found_rho, double found_theta) const {
    Errors result;
    for (double s = -80.0; s <= 80.0; s += 8.0) {
      result.push_back(std::abs(at(s).x() * std::cos(found_theta) + at(s).y() * std::sin(found_theta) - found_rho));
    }
    return result;
  }
  double theta;
  Eigen::Vector2d middle, normal, direction;
};

// Of a texture, over three fifths of the line.
Cover coverOf(const LineTruth& truth, const cv::Mat1f& texture) {
  return [&](cv::Mat1f& image) {
    image.forEach([&](float& value, const int* at) {
      const Eigen::Vector2d p = Eigen::Vector2d(at[1], at[0]) - truth.middle;
      const double s = p.dot(truth.direction);
      if (s > -18.0 && s < 100.0 && std::abs(p.dot(truth.normal)) < 40.0) value = texture(at[0], at[1]);
    });
  };
}

void runLine(int images, bool covered, double contrast) {
  features::CurveTracker<Line> tracker;
  LineTruth truth(0);
  double stamp = 0.0;
  std::vector<Contestant> contestants;
  contestants.push_back(
      {"ours",
       [&](const cv::Mat& image) { tracker.select(image, 0.0, Line(truth.at(-90.0), truth.at(90.0))); },
       [&](const cv::Mat& image) {
         const auto& result = tracker.track(image, stamp);
         return result.state == State::kTracking ? truth.errors(result.curve.rho(), result.curve.theta()) : Errors();
       },
       {},
       {}});
#ifdef LAPAROSCOPE_SERVO_BENCH_VISP
  VispLine visp;
  contestants.push_back(
      {"vpMeLine",
       [&](const cv::Mat& image) { visp.select(image, truth.at(-90.0), truth.at(90.0)); },
       [&](const cv::Mat& image) { return visp.track(image) ? truth.errors(visp.rho(), visp.theta()) : Errors(); },
       {},
       {}});
#endif
  for (int k = 0; k < images; ++k) {
    truth = LineTruth(k);
    stamp = 0.04 * k;
    const test::EdgeScene scene = sceneOf(k);
    const cv::Mat1f texture = test::texture(scene.size, 110.0, contrast, 3.0, 7);
    process(contestants,
            test::draw(scene, test::halfPlane(truth.normal.dot(truth.middle), truth.theta),
                       covered && k > 0 ? coverOf(truth, texture) : Cover()),
            k);
  }
  print(!covered         ? "line"
        : contrast > 0.0 ? "line, 60 % textured over"
                         : "line, 60 % covered",
        contestants, images - 1);
}

struct EllipseTruth {
  explicit EllipseTruth(int k)
      : centre(160.0 + 8.0 * std::sin(k / 5.0), 120.0 + 6.0 * std::cos(k / 7.0)),
        a(70.0 * (1.0 + 0.1 * std::sin(k / 8.0))),
        b(45.0 * (1.0 + 0.1 * std::sin(k / 6.0))),
        angle(0.4 + 0.1 * std::sin(k / 5.0)) {}
  Ellipse ellipse() const { return Ellipse(centre, a, b, angle); }
  // Along the true normals.
  Errors errors(const features::EllipseCoefficients& k) const {
    Errors result;
    std::vector<features::Site> sites;
    ellipse().sites(4.0, 64, sites);
    for (const features::Site& site : sites) {
      const auto at = [&](double d) {
        const Eigen::Vector2d p = site.point + d * site.normal;
        return p.x() * p.x() + k[0] * p.y() * p.y() + 2.0 * (k[1] * p.x() * p.y() + k[2] * p.x() + k[3] * p.y()) + k[4];
      };
      double d = 0.0;
      for (int i = 0; i < 6; ++i) d -= 1e-4 * at(d) / (at(d + 1e-4) - at(d));
      result.push_back(std::isfinite(d) ? std::abs(d) : 1e3);
    }
    return result;
  }
  Eigen::Vector2d centre;
  double a, b, angle;
};

void runEllipse(int images) {
  features::CurveTracker<Ellipse> tracker;
  EllipseTruth truth(0);
  double stamp = 0.0;
  std::vector<Contestant> contestants;
  contestants.push_back({"ours",
                         [&](const cv::Mat& image) { tracker.select(image, 0.0, truth.ellipse()); },
                         [&](const cv::Mat& image) {
                           const auto& result = tracker.track(image, stamp);
                           return result.state == State::kTracking ? truth.errors(result.curve.coefficients())
                                                                   : Errors();
                         },
                         {},
                         {}});
#ifdef LAPAROSCOPE_SERVO_BENCH_VISP
  VispEllipse visp;
  contestants.push_back(
      {"vpMeEllipse",
       [&](const cv::Mat& image) {
         std::vector<Eigen::Vector2d> points;
         for (int k = 0; k < 8; ++k) points.push_back(truth.ellipse().at(0.785 * k));
         visp.select(image, points);
       },
       [&](const cv::Mat& image) { return visp.track(image) ? truth.errors(visp.ellipse().coefficients()) : Errors(); },
       {},
       {}});
#endif
  for (int k = 0; k < images; ++k) {
    truth = EllipseTruth(k);
    stamp = 0.04 * k;
    process(contestants, test::draw(sceneOf(k), test::ellipse(truth.centre, truth.a, truth.b, truth.angle)), k);
  }
  print("ellipse", contestants, images - 1);
}

// 770 px long, which is 200 sites. Astray: a texture over three tenths of it, in nine pieces. No peer: vpMeNurbs
// crashes.
void runSpline(int images, bool astray) {
  features::CurveTracker<features::Spline> tracker;
  test::Contour truth(0, {200.0, 180.0}, 120.0);
  double stamp = 0.0;
  std::vector<Contestant> contestants;
  contestants.push_back({"ours",
                         [&](const cv::Mat& image) {
                           tracker.select(image, 0.0, features::Spline::throughPoints(truth.points(12), true));
                         },
                         [&](const cv::Mat& image) {
                           const auto& result = tracker.track(image, stamp);
                           return result.state == State::kTracking ? truth.errors(result.curve) : Errors();
                         },
                         {},
                         {}});
  for (int k = 0; k < images; ++k) {
    truth = test::Contour(k, {200.0, 180.0}, 120.0);
    stamp = 0.04 * k;
    test::EdgeScene scene = sceneOf(k);
    scene.size = {400, 360};
    const cv::Mat1f texture = test::texture(scene.size, 110.0, 25.0, 3.0, 7);
    const auto cover = [&](cv::Mat1f& image) {
      image.forEach([&](float& value, const int* at) {
        const double angle = std::atan2(at[0] - truth.centre.y(), at[1] - truth.centre.x());
        if (std::fmod(angle + M_PI, 2.0 * M_PI / 9.0) < 0.3 * 2.0 * M_PI / 9.0) value = texture(at[0], at[1]);
      });
    };
    process(contestants, test::draw(scene, truth.region(), astray && k > 0 ? Cover(cover) : Cover()), k);
  }
  print(astray ? "spline, 30 % astray" : "spline, 200 sites", contestants, images - 1);
}

void runDots(int images) {
  features::DotTracker tracker;
  Eigen::Vector2d truth(160.0, 120.0);
  double stamp = 0.0;
  std::vector<Contestant> contestants;
  contestants.push_back({"ours",
                         [&](const cv::Mat& image) { tracker.select(image, 0.0, {truth}); },
                         [&](const cv::Mat& image) {
                           const features::DotsResult& result = tracker.track(image, stamp);
                           return result.state == State::kTracking ? Errors{(result.dots[0].centre - truth).norm()}
                                                                   : Errors();
                         },
                         {},
                         {}});
#ifdef LAPAROSCOPE_SERVO_BENCH_VISP
  VispDot visp;
  contestants.push_back(
      {"vpDot2",
       [&](const cv::Mat& image) { visp.select(image, truth); },
       [&](const cv::Mat& image) { return visp.track(image) ? Errors{(visp.centre() - truth).norm()} : Errors(); },
       {},
       {}});
#endif
  for (int k = 0; k < images; ++k) {
    truth = Eigen::Vector2d(160.0 + 30.3 * std::sin(k / 5.0), 120.0 + 20.1 * std::cos(k / 7.0));
    stamp = 0.04 * k;
    process(contestants, test::draw(sceneOf(k), test::ellipse(truth, 8.0, 8.0, 0.0)), k);
  }
  print("dot, radius 8 px", contestants, images - 1);
}

int measure(int argc, char** argv) {
  int images = 0;
  boost::program_options::options_description options(
      "bench_features: line, ellipse, spline and dots on drawn images of contrast 60, noise 2, blur 1 px; beside "
      "ViSP's");
  options.add_options()("help", "this text")("images", boost::program_options::value(&images)->default_value(100),
                                             "of each scene");
  if (const auto status = parse(argc, argv, options, "images", 1, [&] { return images > 1; })) return *status;
  std::cout << "scene                   tracker     error median [px]  p95    kept  lies  silent  cpu [ms]\n";
  runLine(images, false, 0.0);
  runLine(images, true, 0.0);
  runLine(images, true, 25.0);
  runEllipse(images);
  runSpline(images, false);
  runSpline(images, true);
  runDots(images);
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_features", [&] { return laparoscope_servo::bench::measure(argc, argv); });
}
