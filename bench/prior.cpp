// What the known motion of the camera is worth to the trackers of features: the simulated scope pans about its
// insertion point, to and fro, and every tracker follows its features once by itself and once from where the camera's
// motion puts them. The motion is exact; the depth at which a plane is supposed is that of the default, the tissue's is
// another one in half of the runs.
#include <boost/program_options.hpp>
#include <cmath>
#include <functional>
#include <iomanip>
#include <iostream>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "bench/support/arguments.h"
#include "laparoscope_servo/features/dot_feature_tracker.h"
#include "laparoscope_servo/features/edge_feature_tracker.h"
#include "laparoscope_servo/features/point_feature_tracker.h"
#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/model/model_feature_tracker.h"
#include "laparoscope_servo/sim/scope_camera.h"
#include "laparoscope_servo/sim/texture.h"
#include "test/support/synthetic_model.h"
#include "test/support/temporary_folder.h"

namespace laparoscope_servo::bench {

namespace {

using features::FeatureKind;
using features::FeatureSelection;
using features::FeatureTracker;
using features::State;

constexpr double kPeriod = 0.04;            // s
constexpr double kAmplitude = M_PI / 18.0;  // rad
constexpr double kShaft = 0.1;              // m, from the insertion point to the camera
constexpr double kSupposedDepth = 0.08;     // m: the default of robot_motion/depth
constexpr double kWrong = 3.0;              // px

Eigen::Isometry3d panned(double angle) {
  return Eigen::Translation3d(0.0, 0.0, -kShaft) * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()) *
         Eigen::Translation3d(0.0, 0.0, kShaft);
}

struct Film {
  geometry::PinholeCamera camera;
  std::vector<cv::Mat> images;
  std::vector<Eigen::Isometry3d> poses;  // base_T_camera
  std::vector<Eigen::Matrix3d> truth;    // pixels of the first image to those of this one; empty: not of a plane
};

double angleAt(int image, double peak) {
  return kAmplitude * std::sin(peak / kAmplitude * kPeriod * image);
}

// Tissue with a card on it that has dark discs, and beside it a dark half plane.
Film tissueFilm(const std::string& texture, double depth, double peak, int images) {
  Film film;
  sim::SceneConfig config;
  config.tissue.image = texture;
  config.tissue.distance = depth;
  config.exposure.automatic = false;
  const Eigen::Isometry3d start = panned(0.0), tissue = sim::placeTissue(config.tissue, start);
  sim::ScopeCamera camera(config, tissue);
  film.camera = config.camera.intrinsics;
  for (int k = 0; k < images; ++k) {
    film.poses.push_back(panned(angleAt(k, peak)));
    film.images.push_back(camera.render(film.poses.back(), kPeriod * k).image);
    film.truth.push_back(sim::trueHomography(film.camera, tissue, start, film.poses.back()));
  }
  return film;
}

Film cubeFilm(const model::CadModel& cube, const Eigen::Isometry3d& base_T_cube, double peak, int images) {
  Film film;
  test::ModelScene scene;
  film.camera = scene.camera;
  const test::ModelRenderer renderer(cube, scene);
  for (int k = 0; k < images; ++k) {
    film.poses.push_back(panned(angleAt(k, peak)));
    film.images.push_back(renderer.draw(film.poses.back().inverse() * base_T_cube, static_cast<unsigned>(k + 1)));
  }
  return film;
}

struct Count {
  int told = 0, tracked = 0, wrong = 0;
};

// Points and dots are judged by the truth; of the others the state alone counts.
Count follow(FeatureTracker& tracker, const Film& film, const FeatureSelection& selection, bool with_prior) {
  features::FeaturePrior prior;
  prior.camera = film.camera;
  tracker.select(film.images[0], 0.0, selection, prior);
  std::vector<Eigen::Vector2d> places;
  for (const features::TrackedFeature& feature : tracker.features().features)
    places.push_back(feature.kind == FeatureKind::kPoint ? Eigen::Vector2d(feature.parameters)
                                                         : Eigen::Vector2d::Zero());
  Count count;
  for (std::size_t k = 1; k < film.images.size(); ++k) {
    if (with_prior) {
      prior.camera_motion = film.poses[k].inverse() * film.poses[k - 1];
      prior.motion =
          geometry::pixelsFromPlane(*prior.camera_motion, Eigen::Vector3d::UnitZ(), kSupposedDepth, film.camera);
    }
    const auto& told = tracker.track(film.images[k], kPeriod * static_cast<double>(k), prior);
    for (std::size_t i = 0; i < told.features.size(); ++i) {
      const features::TrackedFeature& feature = told.features[i];
      ++count.told;
      if (feature.state != State::kTracking) continue;
      const bool judged = feature.kind == FeatureKind::kPoint;
      const bool astray =
          judged && (Eigen::Vector2d(feature.parameters) - geometry::apply(film.truth[k], places[i])).norm() > kWrong;
      ++(astray ? count.wrong : count.tracked);
    }
  }
  return count;
}

features::SelectedFeature selected(const std::string& id, FeatureKind kind,
                                   const std::vector<Eigen::Vector2d>& points) {
  features::SelectedFeature feature;
  feature.id = id;
  feature.kind = kind;
  feature.points = points;
  return feature;
}

// m, in the tissue's plane, to pixels of the first image.
Eigen::Vector2d pixel(const Film& film, double depth, double x, double y) {
  return {film.camera.cx + film.camera.fx * x / depth, film.camera.cy + film.camera.fy * y / depth};
}

std::string drawTexture(const std::string& folder) {
  constexpr int kSide = 2400;
  constexpr double kScale = kSide / 0.30;  // px/m
  cv::Mat texture = sim::tissueTexture(kSide, 1);
  const auto at = [&](double x, double y) {
    return cv::Point(static_cast<int>(kSide / 2 + kScale * x), static_cast<int>(kSide / 2 + kScale * y));
  };
  const cv::Scalar dark(20, 20, 25), light(170, 170, 170);
  cv::rectangle(texture, at(-0.034, -0.024), at(-0.001, 0.024), light, cv::FILLED);
  for (const double x : {-0.025, -0.010}) {
    for (const double y : {-0.015, 0.015})
      cv::circle(texture, at(x, y), static_cast<int>(0.002 * kScale), dark, cv::FILLED, cv::LINE_AA);
  }
  cv::rectangle(texture, at(0.012, -0.1), at(0.05, 0.1), dark, cv::FILLED);
  const std::string file = folder + "/texture.png";
  cv::imwrite(file, texture);
  return file;
}

int measure(int argc, char** argv) {
  int images = 0;
  boost::program_options::options_description options(
      "bench_prior: features before a scope that pans, with its motion known or not");
  options.add_options()("help", "this text")("images", boost::program_options::value(&images)->default_value(100),
                                             "of each run");
  if (const auto status = parse(argc, argv, options, "images", 1, [&] { return images > 1; })) return *status;
  const test_support::TemporaryFolder temporary;
  const std::string texture = drawTexture(temporary.path());
  const auto cube = test::modelOf(test::kCube);
  std::cout
      << "kind     peak [deg/s]  depth [m]   tracked alone  wrong   with prior  wrong   [% of features x images]\n";
  const auto row = [](const std::string& kind, double peak, double depth, const Count& alone, const Count& prior) {
    const auto share = [](int part, const Count& of) { return 100.0 * part / std::max(1, of.told); };
    std::cout << std::left << std::setw(9) << kind << std::right << std::fixed << std::setprecision(0) << std::setw(12)
              << peak * 180.0 / M_PI << std::setprecision(2) << std::setw(11) << depth << std::setprecision(1)
              << std::setw(16) << share(alone.tracked, alone) << std::setw(7) << share(alone.wrong, alone)
              << std::setw(13) << share(prior.tracked, prior) << std::setw(7) << share(prior.wrong, prior) << std::endl;
  };
  for (const double degrees : {10.0, 30.0, 60.0, 90.0}) {
    const double peak = degrees * M_PI / 180.0;
    for (const double depth : {0.08, 0.12}) {
      const Film film = tissueFilm(texture, depth, peak, images);
      const auto at = [&](double x, double y) { return pixel(film, depth, x, y); };
      const auto compare = [&](const std::string& kind, const FeatureSelection& selection, const auto& make) {
        row(kind, peak, depth, follow(*make(), film, selection, false), follow(*make(), film, selection, true));
      };
      compare("dots",
              {selected("a", FeatureKind::kPoint, {at(-0.025, -0.015)}),
               selected("b", FeatureKind::kPoint, {at(-0.010, -0.015)}),
               selected("c", FeatureKind::kPoint, {at(-0.025, 0.015)}),
               selected("d", FeatureKind::kPoint, {at(-0.010, 0.015)})},
              [] { return std::make_unique<features::DotFeatureTracker>(features::DotsConfig()); });
      compare("edges", {selected("border", FeatureKind::kLine, {at(0.012, -0.03), at(0.012, 0.03)})},
              [] { return std::make_unique<features::EdgeFeatureTracker>(features::EdgeConfig()); });
      features::SelectedFeature corners = selected("tissue", FeatureKind::kPoint, {});
      corners.corners = features::CornerSelection();
      corners.corners->region = cv::Rect(60, 20, 300, 100);
      corners.corners->count = 30;
      compare("points", {corners},
              [] { return std::make_unique<features::PointFeatureTracker>(features::PointsConfig()); });
    }
    features::SelectedFeature object = selected("cube", FeatureKind::kPose, {});
    object.pose = test::viewOf(*cube, 0.45);
    const Film film = cubeFilm(*cube, panned(0.0) * *object.pose, peak, images);
    row("model", peak, 0.45, follow(*std::make_unique<model::ModelFeatureTracker>(cube), film, {object}, false),
        follow(*std::make_unique<model::ModelFeatureTracker>(cube), film, {object}, true));
  }
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_prior", [&] { return laparoscope_servo::bench::measure(argc, argv); });
}
