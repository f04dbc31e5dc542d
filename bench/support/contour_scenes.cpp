#include "bench/support/contour_scenes.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::bench {

namespace {

using test_support::ContourScene;

// What lies in front: plain, or with a texture of its own, as instruments and other tissue are.
cv::Mat1f coverPicture(unsigned seed) {
  cv::RNG random(seed);
  const double level = random.uniform(40.0, 200.0);
  return test::texture(ContourScene::kSize, level, seed % 2 == 0 ? 0.0 : 10.0, 3.0, seed + 500);
}

Eigen::Vector2d direction(double angle) {
  return Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

cv::Point pixel(const Eigen::Vector2d& p) {
  return {static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y()))};
}

// The outline where the thing is in the image k, scaled about its centre; only angles from `begin` over `span`.
std::vector<cv::Point> arc(const ContourScene& scene, double k, double scale, double begin, double span) {
  std::vector<cv::Point> points;
  for (int i = 0; i <= 90; ++i) {
    const Eigen::Vector2d from = ContourScene::at(begin + span * i / 90.0) - ContourScene::kCentre;
    points.push_back(pixel(scene.place(ContourScene::kCentre + scale * from, k)));
  }
  return points;
}

// A band across the image: `from` to `to` px along its normal at `angle`, from the centre of the image 0.
std::vector<cv::Point> band(double angle, double from, double to) {
  const Eigen::Vector2d n = direction(angle), along(-n.y(), n.x());
  const Eigen::Vector2d c = ContourScene::kCentre;
  return {pixel(c + from * n - 400.0 * along), pixel(c + from * n + 400.0 * along), pixel(c + to * n + 400.0 * along),
          pixel(c + to * n - 400.0 * along)};
}

void paint(const std::vector<cv::Point>& shape, const cv::Mat1f& with, cv::Mat1f& picture) {
  cv::Mat1b mask = cv::Mat1b::zeros(picture.size());
  cv::fillPoly(mask, std::vector<std::vector<cv::Point>>{shape}, 255);
  with.copyTo(picture, mask);
}

// Present in 35 of 50 images, so that what is lost can come back.
bool isCovered(int k) {
  return k % 50 >= 10 && k % 50 < 45;
}

}  // namespace

std::vector<ContourCase> contourCases(unsigned seed) {
  cv::RNG random(seed + 7000);
  const double angle = random.uniform(0.0, 2.0 * M_PI), other = random.uniform(0.0, 2.0 * M_PI);
  const cv::Mat1f front = coverPicture(seed);
  ContourScene::Look both;
  both.texture = 12.0;
  both.background = 8.0;
  both.seed = seed;
  ContourScene::Look smooth, little = both, fast = both, blurred = both, bending = both;
  smooth.seed = seed;
  little.texture = 3.0;
  fast.speed = 2.5;
  blurred.speed = 2.0;
  blurred.exposure = 0.8;
  bending.bend = 1.5;
  // Half of the inside, up to close to the outline.
  const auto inside = [=](const ContourScene& scene, int k, cv::Mat1f& picture) {
    if (isCovered(k)) paint(arc(scene, k, 0.88, angle, M_PI), front, picture);
  };
  // Half of the outline, by what follows the thing two images late.
  const auto outline = [=](const ContourScene& scene, int k, cv::Mat1f& picture) {
    if (!isCovered(k)) return;
    std::vector<cv::Point> ring = arc(scene, std::max(0, k - 2), 1.4, angle, M_PI);
    const std::vector<cv::Point> inner = arc(scene, std::max(0, k - 2), 0.85, angle, M_PI);
    ring.insert(ring.end(), inner.rbegin(), inner.rend());
    paint(ring, front, picture);
  };
  // All of the outline.
  const auto around = [=](const ContourScene& scene, int k, cv::Mat1f& picture) {
    if (!isCovered(k)) return;
    const Eigen::Vector2d c = scene.place(ContourScene::kCentre, k);
    cv::Mat1b mask = cv::Mat1b::zeros(picture.size());
    cv::circle(mask, pixel(c + Eigen::Vector2d(6.0, 0.0)), 95, 255, cv::FILLED);
    cv::circle(mask, pixel(c + Eigen::Vector2d(6.0, 0.0)), 54, 0, cv::FILLED);
    front.copyTo(picture, mask);
  };
  // Edges beside those of the outline, which stay behind.
  const auto beside = [=](const ContourScene& scene, int k, cv::Mat1f& picture) {
    cv::polylines(picture, arc(scene, std::max(0, k - 2), 1.15, 0.0, 2.0 * M_PI), true, 60.0, 4);
  };
  // Comes in from one side up to beyond the middle, and leaves again.
  const auto part = [=](const ContourScene&, int k, cv::Mat1f& picture) {
    paint(band(angle, 110.0 - 120.0 * std::abs(std::sin(0.05 * k)), 600.0), front, picture);
  };
  const auto shaft = [=](const ContourScene&, int k, cv::Mat1f& picture) {
    const double at = 130.0 * std::cos(0.06 * k + other);
    for (int stripe = 0; stripe < 9; ++stripe) {  // round: brighter in its middle
      const double level = 60.0 + 12.0 * (4 - std::abs(stripe - 4));
      paint(band(angle, at + 4.0 * stripe - 18.0, at + 4.0 * stripe - 14.0),
            cv::Mat1f(picture.size(), static_cast<float>(level)), picture);
    }
  };
  // Gain, bias, and a shade across the image that wanders.
  const auto light = [=](const ContourScene&, int k, cv::Mat1f& picture) {
    const double gain = 1.0 + 0.3 * std::sin(0.11 * k + other) - 0.3 * std::sin(other),
                 bias = 20.0 * std::sin(0.07 * k);
    const Eigen::Vector2d slope = 0.12 * std::sin(0.05 * k) * direction(angle);
    picture.forEach([&](float& level, const int* at) {
      const double shade = slope.x() * (at[1] - 160.0) + slope.y() * (at[0] - 120.0);
      level = static_cast<float>(gain * static_cast<double>(level) + bias + shade);
    });
  };
  return {{"both", both, nullptr},
          {"smooth", smooth, nullptr},
          {"little texture", little, nullptr},
          {"outline covered", both, around},
          {"edges beside", both, beside},
          {"texture half covered", both, inside},
          {"contour half covered", both, outline},
          {"both in part covered", both, part},
          {"light changed", both, light},
          {"motion blur", blurred, nullptr},
          {"shaft crossing", both, shaft},
          {"fast motion", fast, nullptr},
          {"deforming", bending, nullptr}};
}

}  // namespace laparoscope_servo::bench
