#include "bench/support/scenes.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "bench/support/arguments.h"
#include "bench/support/sequence.h"
#include "laparoscope_servo/tracking/region_tracker.h"

namespace laparoscope_servo::bench {

namespace {

constexpr double kPeriod = 0.04;     // s, between images of a film
constexpr std::size_t kBefore = 25;  // images
constexpr double kVisible = 0.6;     // of the region, in an image that is taken
constexpr double kNoise = 2.0;       // grey levels
constexpr double kVeil = 200.0;      // grey levels, of smoke
constexpr double kMargin = 15.0;     // px, around half of the region, that is covered with it

}  // namespace

Scene trackedScene(const std::string& text, int count, double seconds) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) throw std::runtime_error(text + ", expected FILM:x,y,width,height");
  Scene scene;
  scene.roi = parseRoi(text.substr(colon + 1));
  std::string film = text.substr(0, colon);
  const std::size_t at = film.rfind('@');
  const int first = at == std::string::npos ? 0 : std::stoi(film.substr(at + 1));
  film = film.substr(0, at);
  Sequence sequence(film);
  scene.name = sequence.name() + " " + text.substr(colon + 1);
  tracking::RegionTracker tracker{tracking::TrackerConfig()};
  cv::Mat image;
  const int last = first + static_cast<int>(seconds / kPeriod);
  for (int k = 0; k <= last && sequence.next(image); ++k) {
    if (k < first) continue;
    if (k == first) {
      scene.reference = image.clone();
      scene.roi = tracker.select(image, 0.0, scene.roi).roi;
      continue;
    }
    const tracking::TrackResult& r = tracker.track(image, kPeriod * (k - first));
    if (scene.before.size() < kBefore) scene.before.push_back(image.clone());
    if (r.state != tracking::State::kTracking || !(r.visible_fraction >= kVisible)) continue;
    scene.images.push_back(image.clone());
    scene.g.push_back(r.g);
  }
  if (scene.images.empty()) throw std::runtime_error(film + ": the region was not tracked");
  Scene some = scene;
  some.images.clear();
  some.g.clear();
  for (int k = 1; k <= count; ++k) {
    const std::size_t taken = (scene.images.size() - 1) * k / count;
    some.images.push_back(scene.images[taken]);
    some.g.push_back(scene.g[taken]);
  }
  return some;
}

cv::Mat changed(const cv::Mat& image, const Change& change, const geometry::Rectangle& roi, Eigen::Matrix3d& g,
                std::mt19937& random, std::mt19937& grains) {
  const Eigen::Vector2d middle = geometry::apply(g, roi.centre());
  std::uniform_real_distribution<double> shift(-0.06, 0.06);
  const double side = std::min(image.cols, image.rows);
  const bool moved = change.turn != 0.0 || change.scale != 1.0;
  cv::Mat result = image.clone();
  if (moved) {
    cv::Mat turn = cv::getRotationMatrix2D(cv::Point2f(static_cast<float>(middle.x()), static_cast<float>(middle.y())),
                                           change.turn, change.scale);
    turn.at<double>(0, 2) += shift(random) * side;
    turn.at<double>(1, 2) += shift(random) * side;
    const int method = change.scale < 1.0 ? cv::INTER_AREA : cv::INTER_LINEAR;
    cv::warpAffine(image, result, turn, image.size(), method);
    Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
    for (int r = 0; r < 2; ++r) {
      for (int c = 0; c < 3; ++c) m(r, c) = turn.at<double>(r, c);
    }
    g = m * g;
  }
  cv::Mat exact;
  result.convertTo(exact, CV_32F, change.gain * (1.0 - change.veil), change.veil * kVeil);
  if (change.half) {
    const geometry::Quadrilateral corners = geometry::apply(g, roi.corners());
    double left = corners[0].x(), right = left, top = corners[0].y(), bottom = top;
    for (const Eigen::Vector2d& p : corners) {
      left = std::min(left, p.x());
      right = std::max(right, p.x());
      top = std::min(top, p.y());
      bottom = std::max(bottom, p.y());
    }
    const cv::Point from(cvRound(0.5 * (left + right)), cvRound(top - kMargin));
    const cv::Point to(cvRound(right + kMargin), cvRound(bottom + kMargin));
    cv::rectangle(exact, from, to, cv::Scalar(150, 150, 155), cv::FILLED);
  }
  cv::Mat grain(exact.size(), exact.type());
  cv::RNG rng(grains());
  rng.fill(grain, cv::RNG::NORMAL, 0.0, kNoise);
  exact += grain;
  exact.convertTo(result, CV_8U);
  return result;
}

double threadSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace laparoscope_servo::bench
