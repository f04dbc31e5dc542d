// A shaft in front of tissue, drawn with its outline known: noise, blur, highlights and halved chroma as a
// laparoscope's video has them.
#pragma once

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::test_support {

struct ShaftPicture {
  cv::Mat image;  // CV_8UC3
  cv::Mat mask;   // CV_8UC1, 255 on the shaft
};

struct ShaftScene {
  cv::Size size{640, 480};
  cv::Point2d tip{250.0, 260.0};
  cv::Point2d entry{660.0, 330.0};  // beyond the border
  double tip_width = 60.0;          // px, across the axis
  double entry_width = 90.0;        // px
  cv::Scalar shaft{150, 145, 135};  // blue, green, red
  cv::Scalar tissue{60, 70, 170};   // blue, green, red
  double noise = 2.0;               // grey levels
  double blur = 1.0;                // px
  int highlights = 12;
  bool halved_chroma = true;
  bool with_shaft = true;
  int seed = 1;
};

inline ShaftPicture drawShaft(const ShaftScene& s) {
  cv::RNG random(static_cast<std::uint64_t>(s.seed));
  ShaftPicture picture;
  picture.image = cv::Mat(s.size, CV_8UC3, s.tissue);
  // Tissue has texture: large soft patches, brighter and darker.
  cv::Mat coarse(s.size.height / 32 + 2, s.size.width / 32 + 2, CV_32FC1), soft;
  random.fill(coarse, cv::RNG::UNIFORM, 0.6, 1.3);
  cv::resize(coarse, soft, s.size, 0, 0, cv::INTER_CUBIC);
  for (int y = 0; y < s.size.height; ++y) {
    for (int x = 0; x < s.size.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        uchar& p = picture.image.at<cv::Vec3b>(y, x)[c];
        p = cv::saturate_cast<uchar>(p * soft.at<float>(y, x));
      }
    }
  }
  for (int k = 0; k < s.highlights; ++k) {
    const cv::Point at(random.uniform(0, s.size.width), random.uniform(0, s.size.height));
    cv::ellipse(picture.image, at, {random.uniform(2, 7), random.uniform(2, 5)}, random.uniform(0, 180), 0, 360,
                cv::Scalar(250, 250, 250), cv::FILLED);
  }
  picture.mask = cv::Mat::zeros(s.size, CV_8UC1);
  if (s.with_shaft) {
    const cv::Point2d d = s.entry - s.tip;
    const double length = std::hypot(d.x, d.y);
    const cv::Point2d side(-d.y / length, d.x / length);
    constexpr int kShift = 6;
    const auto fixed = [](const cv::Point2d& p) {
      return cv::Point(cvRound(p.x * (1 << kShift)), cvRound(p.y * (1 << kShift)));
    };
    const cv::Point corners[4] = {fixed(s.tip + 0.5 * s.tip_width * side), fixed(s.entry + 0.5 * s.entry_width * side),
                                  fixed(s.entry - 0.5 * s.entry_width * side), fixed(s.tip - 0.5 * s.tip_width * side)};
    cv::fillConvexPoly(picture.image, corners, 4, s.shaft, cv::LINE_8, kShift);
    cv::fillConvexPoly(picture.mask, corners, 4, 255, cv::LINE_8, kShift);
    cv::line(picture.image, s.tip - 0.2 * s.tip_width * side, s.entry - 0.2 * s.entry_width * side,
             cv::Scalar(235, 235, 235), 3);  // a highlight along it
  }
  if (s.blur > 0.0) cv::GaussianBlur(picture.image, picture.image, {}, s.blur);
  if (s.halved_chroma) {
    cv::Mat ycc, small;
    cv::cvtColor(picture.image, ycc, cv::COLOR_BGR2YCrCb);
    cv::Mat planes[3];
    cv::split(ycc, planes);
    for (int c = 1; c < 3; ++c) {
      cv::resize(planes[c], small, {}, 0.5, 0.5, cv::INTER_AREA);
      cv::resize(small, planes[c], s.size, 0, 0, cv::INTER_LINEAR);
    }
    cv::merge(planes, 3, ycc);
    cv::cvtColor(ycc, picture.image, cv::COLOR_YCrCb2BGR);
  }
  cv::Mat noise(s.size, CV_16SC3), wide;
  random.fill(noise, cv::RNG::NORMAL, 0.0, s.noise);
  picture.image.convertTo(wide, CV_16SC3);
  cv::Mat(wide + noise).convertTo(picture.image, CV_8UC3);
  return picture;
}

}  // namespace laparoscope_servo::test_support
