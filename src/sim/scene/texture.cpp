#include "laparoscope_servo/sim/texture.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace laparoscope_servo::sim {

namespace {

// Value noise: random numbers on grids, each twice as fine as the one before and `persistence` times as strong, in [0,
// 1].
cv::Mat1f fractalNoise(int side, int coarsest, int finest, float persistence, cv::RNG& random) {
  cv::Mat1f sum = cv::Mat1f::zeros(side, side);
  float amplitude = 1.0F;
  for (int cells = coarsest; cells <= std::min(finest, side); cells *= 2, amplitude *= persistence) {
    cv::Mat1f grid(cells + 1, cells + 1);
    random.fill(grid, cv::RNG::UNIFORM, -1.0, 1.0);
    cv::Mat1f octave;
    cv::resize(grid, octave, sum.size(), 0.0, 0.0, cv::INTER_CUBIC);
    cv::scaleAdd(octave, amplitude, sum, sum);
  }
  cv::normalize(sum, sum, 0.0, 1.0, cv::NORM_MINMAX);
  return sum;
}

// 0 below `low`, 1 above `high`, smooth in between.
cv::Mat1f smoothStep(const cv::Mat1f& value, double low, double high) {
  cv::Mat1f t = (value - low) / (high - low);
  cv::min(cv::max(t, 0.0F), 1.0F, t);
  return t.mul(t).mul(3.0F - 2.0F * t);
}

// One vessel: a walk whose direction drifts, thinner as it goes, with branches.
void drawVessel(cv::Mat1b& mask, cv::Point2d point, double direction, double width, int generation, cv::RNG& random) {
  const double step = std::max(4.0, mask.cols / 250.0);
  const int length = random.uniform(40, 120);
  for (int k = 0; k < length && width > 0.6; ++k) {
    direction += random.gaussian(0.12);
    const cv::Point2d next = point + step * cv::Point2d(std::cos(direction), std::sin(direction));
    cv::line(mask, point, next, cv::Scalar(255.0), std::max(1, cvRound(width)), cv::LINE_AA);
    point = next;
    width *= 0.992;
    if (generation < 3 && random.uniform(0.0, 1.0) < 0.025) {
      const double side = random.uniform(0, 2) == 0 ? -1.0 : 1.0;
      drawVessel(mask, point, direction + side * random.uniform(0.4, 1.0), 0.6 * width, generation + 1, random);
    }
  }
}

cv::Mat1f vessels(int side, cv::RNG& random) {
  // Drawn in 8 bit, where OpenCV draws smooth lines.
  cv::Mat1b drawn = cv::Mat1b::zeros(side, side);
  for (int k = 0; k < 60; ++k) {
    const cv::Point2d start(random.uniform(0.0, 1.0) * side, random.uniform(0.0, 1.0) * side);
    const double width = side / 2048.0 * std::exp(random.uniform(std::log(3.0), std::log(20.0)));
    drawVessel(drawn, start, random.uniform(0.0, 2.0 * CV_PI), width, 0, random);
  }
  cv::GaussianBlur(drawn, drawn, cv::Size(), side / 2048.0);
  cv::Mat1f mask;
  drawn.convertTo(mask, CV_32F, 1.0 / 255.0);
  return mask;
}

// image = (1 - weight) image + weight colour, per pixel.
void blend(cv::Mat3f& image, const cv::Mat1f& weight, const cv::Vec3f& colour) {
  image.forEach([&](cv::Vec3f& pixel, const int* at) {
    const float w = weight(at[0], at[1]);
    pixel = (1.0F - w) * pixel + w * colour;
  });
}

}  // namespace

cv::Mat tissueTexture(int side, std::uint64_t seed) {
  if (side < 64 || side > 8192) {
    throw std::invalid_argument("side of the tissue's texture is " + std::to_string(side) + " px, expected 64 to 8192");
  }
  cv::RNG random(seed ^ 0x9E3779B97F4A7C15ULL);  // OpenCV's generator does not work with a seed of 0

  cv::Mat3f image(side, side, cv::Vec3f(78.0F, 84.0F, 178.0F));
  blend(image, smoothStep(fractalNoise(side, 4, 64, 0.6F, random), 0.35, 0.8) * 0.8, {96.0F, 118.0F, 214.0F});
  blend(image, smoothStep(fractalNoise(side, 6, 96, 0.6F, random), 0.5, 0.8) * 0.7, {52.0F, 44.0F, 128.0F});
  blend(image, smoothStep(fractalNoise(side, 8, 256, 0.6F, random), 0.60, 0.72) * 0.75, {120.0F, 188.0F, 226.0F});
  blend(image, vessels(side, random) * 0.7, {40.0F, 28.0F, 110.0F});

  const cv::Mat1f fine = fractalNoise(side, 32, side / 2, 0.65F, random);
  image.forEach([&](cv::Vec3f& pixel, const int* at) { pixel *= 0.2F + 1.6F * fine(at[0], at[1]); });
  cv::Mat result;
  image.convertTo(result, CV_8UC3);
  return result;
}

cv::Mat textureFromFile(const std::string& file) {
  if (!std::ifstream(file)) throw std::runtime_error("cannot open the texture's image file '" + file + "'");
  cv::Mat image = cv::imread(file, cv::IMREAD_COLOR);
  if (image.empty()) throw std::runtime_error("'" + file + "' is no image that OpenCV can read");
  return image;
}

}  // namespace laparoscope_servo::sim
