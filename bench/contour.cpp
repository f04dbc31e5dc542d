// Contour and texture in one minimisation, beside either of them alone, on drawn sequences: a thing with both, a smooth
// one, one whose outline is covered, one with edges beside its own, one that is half covered. Images kept (TRACKING and
// less than 2 px off), lies (TRACKING and more than that off), error, and the processor's time.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "bench/support/cpu_clock.h"
#include "laparoscope_servo/robust/median.h"
#include "laparoscope_servo/tracking/contour_texture.h"
#include "test/support/contour_scene.h"

namespace {

using laparoscope_servo::bench::cpuTime;
using laparoscope_servo::features::State;
using laparoscope_servo::features::TrackedFeature;
using laparoscope_servo::test_support::ContourScene;
using laparoscope_servo::tracking::ContourTextureConfig;
using laparoscope_servo::tracking::ContourTextureTracker;
namespace geometry = laparoscope_servo::geometry;
namespace robust = laparoscope_servo::robust;

constexpr int kImages = 150;
using Cover = std::function<void(int, cv::Mat1f&)>;

struct Case {
  std::string name;
  ContourScene::Look look;
  Cover cover;
};

Eigen::Vector2d centreOf(int k) {
  return geometry::apply(ContourScene::motion(k), ContourScene::kCentre);
}

std::vector<Case> cases() {
  ContourScene::Look both, smooth, low;
  both.texture = 12.0;
  both.background = 8.0;
  low.texture = 3.0;
  const Cover ring = [](int k, cv::Mat1f& picture) {
    if (k % 50 < 10) return;
    const Eigen::Vector2d c = centreOf(k);
    cv::Mat1b mask = cv::Mat1b::zeros(picture.size());
    cv::circle(mask, {static_cast<int>(c.x()) + 6, static_cast<int>(c.y())}, 95, 255, cv::FILLED);
    cv::circle(mask, {static_cast<int>(c.x()) + 6, static_cast<int>(c.y())}, 54, 0, cv::FILLED);
    picture.setTo(60.0f, mask);
  };
  // Edges of the same sign, 9 px outside of the outline, which stay behind by 6 px.
  const Cover parallel = [](int k, cv::Mat1f& picture) {
    std::vector<cv::Point> outline;
    for (int a = 0; a < 90; ++a) {
      const Eigen::Vector2d p =
          geometry::apply(ContourScene::motion(std::max(0, k - 2)),
                          Eigen::Vector2d(ContourScene::kCentre +
                                          1.15 * (ContourScene::at(2.0 * M_PI * a / 90) - ContourScene::kCentre)));
      outline.emplace_back(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
    }
    cv::polylines(picture, outline, true, 60.0, 4);
  };
  const Cover half = [](int k, cv::Mat1f& picture) {
    const int x = 320 - 2 * (k % 100);
    picture(cv::Rect(std::clamp(x, 0, 319), 0, 320 - std::clamp(x, 0, 319), 240)).setTo(50.0f);
  };
  return {{"both", both, nullptr},         {"smooth", smooth, nullptr},      {"little texture", low, nullptr},
          {"outline covered", both, ring}, {"edges beside", both, parallel}, {"half covered", both, half}};
}

struct Way {
  const char* name;
  bool texture, contour;
};
constexpr Way kWays[] = {
    {"contour and texture", true, true}, {"texture (ESM)", true, false}, {"contour (edges)", false, true}};

struct Row {
  int kept = 0, lies = 0;
  std::vector<double> errors, times;
};

Row run(const ContourScene& scene, const Case& each, bool texture, bool contour) {
  ContourTextureConfig config;
  config.texture = texture;
  config.contour = contour;
  ContourTextureTracker tracker(config);
  tracker.select(scene.image(Eigen::Matrix3d::Identity(), 1), 0.0, ContourScene::selection(), {});
  Row row;
  for (int k = 1; k < kImages; ++k) {
    const Eigen::Matrix3d g = ContourScene::motion(k);
    const cv::Mat image = scene.image(g, static_cast<unsigned>(k + 1), [&](cv::Mat1f& picture) {
      if (each.cover) each.cover(k, picture);
    });
    const double begin = cpuTime();
    const TrackedFeature& told = tracker.track(image, k * 0.04, {}).features.at(0);
    row.times.push_back(1e3 * (cpuTime() - begin));
    if (told.state != State::kTracking) continue;
    const double error = ContourScene::error(told.parameters, g);
    row.errors.push_back(error);
    ++(error < 2.0 ? row.kept : row.lies);
  }
  return row;
}

// A film, for which there is no truth: images TRACKING, and the error that is expected.
bool film(const std::string& path, const laparoscope_servo::features::SelectedFeature& selected) {
  for (const Way& way : kWays) {
    cv::VideoCapture video(path);
    const double rate = std::max(1.0, video.get(cv::CAP_PROP_FPS));
    ContourTextureConfig config;
    config.texture = way.texture;
    config.contour = way.contour;
    ContourTextureTracker tracker(config);
    Row row;
    int images = 0;
    for (cv::Mat image; video.read(image); ++images) {
      const double begin = cpuTime();
      const auto& told =
          images == 0 ? tracker.select(image, 0.0, {selected}, {}) : tracker.track(image, images / rate, {});
      row.times.push_back(1e3 * (cpuTime() - begin));
      if (told.state != State::kTracking) continue;
      ++row.kept;
      row.errors.push_back(told.features.at(0).expected_error);
    }
    if (images == 0) {
      std::fprintf(stderr, "%s: no images\n", path.c_str());
      return false;
    }
    std::printf("%-20s TRACKING in %d of %d images, expected error %.2f px, %.2f ms\n", way.name, row.kept, images,
                row.errors.empty() ? NAN : robust::nearestRank(row.errors, 0.5), robust::nearestRank(row.times, 0.5));
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  if (argc > 1) {
    laparoscope_servo::features::SelectedFeature selected;
    selected.id = "outline";
    selected.kind = laparoscope_servo::features::FeatureKind::kSpline;
    selected.closed = true;
    selected.range = 12.0;
    for (int k = 2; k < argc; ++k) {
      double x = 0.0, y = 0.0;
      if (std::sscanf(argv[k], "%lf,%lf", &x, &y) != 2) {
        std::fprintf(stderr,
                     "usage: bench_contour [FILM x,y x,y ...], points on a closed outline in its first image, px\n");
        return 2;
      }
      selected.points.emplace_back(x, y);
    }
    return film(argv[1], selected) ? 0 : 1;
  }
  std::printf("%-16s %-20s %5s %5s %10s %10s %8s\n", "sequence", "by", "kept", "lies", "error px", "95 % px", "ms");
  for (const Case& each : cases()) {
    const ContourScene scene(each.look);
    for (const Way& way : kWays) {
      Row row = run(scene, each, way.texture, way.contour);
      const bool any = !row.errors.empty();
      std::printf("%-16s %-20s %5d %5d %10.3f %10.3f %8.3f\n", each.name.c_str(), way.name, row.kept, row.lies,
                  any ? robust::nearestRank(row.errors, 0.5) : NAN, any ? robust::nearestRank(row.errors, 0.95) : NAN,
                  robust::nearestRank(row.times, 0.5));
    }
  }
  return 0;
}
