#include "picture_faults.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace laparoscope_servo::test::image_faults {

namespace {

// Of the camera head, about the middle, and larger by `scale`.
cv::Matx23d aboutTheMiddle(const cv::Mat& image, double degrees, double scale) {
  const cv::Point2f middle(0.5F * static_cast<float>(image.cols - 1), 0.5F * static_cast<float>(image.rows - 1));
  return cv::getRotationMatrix2D(middle, degrees, scale);
}

void warp(cv::Mat& image, const cv::Matx23d& to) {
  cv::warpAffine(image.clone(), image, to, image.size(), cv::INTER_LINEAR, cv::BORDER_REFLECT);
}

}  // namespace

ImageRelay::Fault frozenWithNoise(double noise) {
  const auto first = std::make_shared<cv::Mat>();
  const auto random = std::make_shared<cv::RNG>(17);
  return changed([=](cv::Mat& mat) {
    if (first->empty()) *first = mat.clone();
    cv::Mat added(mat.size(), CV_16SC3);
    random->fill(added, cv::RNG::NORMAL, 0.0, noise);
    cv::add(*first, added, mat, cv::noArray(), CV_8U);
  });
}

ImageRelay::Fault everySecond(const std::function<void(cv::Mat&)>& change) {
  const auto count = std::make_shared<int>(0);
  return changed([=](cv::Mat& mat) {
    if (++*count % 2 == 0) change(mat);
  });
}

void shift(cv::Mat& image, int right, int down) {
  warp(image, {1.0, 0.0, static_cast<double>(right), 0.0, 1.0, static_cast<double>(down)});
}

ImageRelay::Fault trembling(int most) {
  const auto random = std::make_shared<cv::RNG>(19);
  return changed([=](cv::Mat& mat) {
    const int right = random->uniform(-most, most + 1);
    shift(mat, right, random->uniform(-most, most + 1));
  });
}

ImageRelay::Fault white() {
  return changed([](cv::Mat& mat) { mat.setTo(cv::Scalar::all(255)); });
}

ImageRelay::Fault inSmoke(double contrast) {
  return changed([contrast](cv::Mat& mat) { mat.convertTo(mat, -1, contrast, 170.0 * (1.0 - contrast)); });
}

ImageRelay::Fault outOfFocus(double sigma) {
  return changed([sigma](cv::Mat& mat) { cv::GaussianBlur(mat.clone(), mat, cv::Size(), sigma); });
}

ImageRelay::Fault inAWindow() {
  const auto first = std::make_shared<cv::Mat>();
  return changed([first](cv::Mat& mat) {
    if (first->empty()) *first = mat.clone();
    cv::Mat small;
    cv::resize(mat, small, mat.size() / 2, 0, 0, cv::INTER_AREA);
    first->copyTo(mat);
    small.copyTo(mat(cv::Rect(mat.cols / 4, mat.rows / 4, small.cols, small.rows)));
  });
}

ImageRelay::Fault torn() {
  const auto before = std::make_shared<cv::Mat>();
  const auto random = std::make_shared<cv::RNG>(11);
  return changed([=](cv::Mat& mat) {
    const cv::Mat now = mat.clone();
    const int line = random->uniform(1, mat.rows - 1);
    if (!before->empty()) before->rowRange(line, mat.rows).copyTo(mat.rowRange(line, mat.rows));
    *before = now;
  });
}

ImageRelay::Fault interlaced() {
  const auto before = std::make_shared<cv::Mat>();
  return changed([=](cv::Mat& mat) {
    const cv::Mat now = mat.clone();
    for (int y = 1; y < mat.rows && !before->empty(); y += 2) before->row(y).copyTo(mat.row(y));
    *before = now;
  });
}

ImageRelay::Fault runningThrough(int right, int down) {
  const auto shift = std::make_shared<cv::Point>(0, 0);
  return changed([=](cv::Mat& mat) {
    *shift += cv::Point(right, down);
    const cv::Mat now = mat.clone();
    for (int y = 0; y < mat.rows; ++y) {
      const cv::Mat to = mat.row((y + shift->y) % mat.rows);
      const int x = shift->x % mat.cols;
      now(cv::Rect(0, y, mat.cols - x, 1)).copyTo(to.colRange(x, mat.cols));
      if (x > 0) now(cv::Rect(mat.cols - x, y, x, 1)).copyTo(to.colRange(0, x));
    }
  });
}

ImageRelay::Fault swappedColours() {
  return changed([](cv::Mat& mat) { cv::cvtColor(mat.clone(), mat, cv::COLOR_BGR2RGB); });
}

ImageRelay::Fault gamma(double exponent) {
  cv::Mat table(1, 256, CV_8UC1);
  for (int k = 0; k < 256; ++k) table.at<uchar>(k) = cv::saturate_cast<uchar>(255.0 * std::pow(k / 255.0, exponent));
  return changed([table](cv::Mat& mat) { cv::LUT(mat.clone(), table, mat); });
}

ImageRelay::Fault smoothed(double pictures) {
  const auto mean = std::make_shared<cv::Mat>();
  const double weight = 1.0 - std::exp(-1.0 / pictures);
  return changed([=](cv::Mat& mat) {
    if (mean->empty()) mat.convertTo(*mean, CV_32FC3);
    cv::accumulateWeighted(mat, *mean, weight);
    mean->convertTo(mat, CV_8UC3);
  });
}

ImageRelay::Fault compressed(int quality) {
  return changed([quality](cv::Mat& mat) {
    std::vector<std::uint8_t> bytes;
    cv::imencode(".jpg", mat, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
    cv::imdecode(bytes, cv::IMREAD_COLOR).copyTo(mat);
  });
}

ImageRelay::Fault sideBySide() {
  return changed([](cv::Mat& mat) {
    cv::Mat narrow;
    cv::resize(mat, narrow, {mat.cols / 2, mat.rows}, 0, 0, cv::INTER_AREA);
    narrow.copyTo(mat.colRange(0, mat.cols / 2));
    narrow.copyTo(mat.colRange(mat.cols - mat.cols / 2, mat.cols));
  });
}

ImageRelay::Fault menu() {
  return changed([](cv::Mat& mat) {
    const cv::Rect box = middle(mat);
    cv::rectangle(mat, box, {60, 60, 60}, cv::FILLED);
    const char* const lines[] = {"WHITE BALANCE", "BRIGHTNESS  5", "ENHANCE  HIGH", "FREEZE  OFF", "EXIT"};
    int y = box.y;
    for (const char* line : lines) {
      cv::putText(mat, line, {box.x + 10, y += box.height / 6}, cv::FONT_HERSHEY_SIMPLEX, 1.0, {230, 230, 230}, 2);
    }
  });
}

ImageRelay::Fault testPicture() {
  return changed([](cv::Mat& mat) {
    constexpr int kBars = 8;
    for (int k = 0; k < kBars; ++k) {
      const cv::Scalar colour(k & 1 ? 190 : 20, k & 2 ? 190 : 20, k & 4 ? 190 : 20);
      mat.colRange(k * mat.cols / kBars, (k + 1) * mat.cols / kBars).setTo(colour);
    }
  });
}

ImageRelay::Fault turning(double rate, double most) {
  return changedInTime(
      [=](cv::Mat& mat, double time) { warp(mat, aboutTheMiddle(mat, std::min(rate * time, most), 1.0)); });
}

ImageRelay::Fault zooming(double rate, double most) {
  const double towards = most > 1.0 ? rate : 1.0 / rate;
  return changedInTime([=](cv::Mat& mat, double time) {
    const double scale = std::pow(towards, time);
    warp(mat, aboutTheMiddle(mat, 0.0, most > 1.0 ? std::min(scale, most) : std::max(scale, most)));
  });
}

ImageRelay::Fault stabilised() {
  constexpr int kCoarse = 4;      // px of the picture, one px of what is compared
  constexpr double kKeep = 0.96;  // share that is kept from one picture to the next: a second at 25 Hz
  struct State {
    cv::Mat before;
    cv::Point2d shift;
  };
  const auto state = std::make_shared<State>();
  return changed([=](cv::Mat& mat) {
    cv::Mat small, grey;
    cv::resize(mat, small, mat.size() / kCoarse, 0, 0, cv::INTER_AREA);
    cv::cvtColor(small, small, cv::COLOR_BGR2GRAY);
    small.convertTo(grey, CV_32F);
    if (!state->before.empty()) {
      state->shift = (state->shift + kCoarse * cv::phaseCorrelate(state->before, grey)) * kKeep;
    }
    state->before = grey;
    warp(mat, {1.0, 0.0, -state->shift.x, 0.0, 1.0, -state->shift.y});
  });
}

}  // namespace laparoscope_servo::test::image_faults
