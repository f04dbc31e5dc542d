#include "bench/support/flow_peers.h"

#include <memory>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "bench/support/robust_fit.h"
#include "laparoscope_servo/robust/median.h"

namespace laparoscope_servo::bench {

namespace {

using Points = std::vector<cv::Point2f>;

constexpr double kInlier = 1.0;  // px

Eigen::Matrix3d fit(motion::Model model, const Points& from, const Points& to) {
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  if (from.size() < 8) return g;
  if (model == motion::Model::kConstant) {
    std::vector<float> x, y;
    for (std::size_t k = 0; k < from.size(); ++k) {
      x.push_back(to[k].x - from[k].x);
      y.push_back(to[k].y - from[k].y);
    }
    g(0, 2) = static_cast<double>(robust::median(x));
    g(1, 2) = static_cast<double>(robust::median(y));
    return g;
  }
  const bool affine = model == motion::Model::kAffine;
  const cv::Mat m = affine ? cv::estimateAffine2D(from, to, cv::noArray(), kRobustFit, kInlier)
                           : cv::findHomography(from, to, kRobustFit, kInlier);
  for (int k = 0; k < static_cast<int>(m.total()); ++k) g(k / 3, k % 3) = m.at<double>(k / 3, k % 3);
  return g;
}

}  // namespace

std::vector<FlowPeer> flowPeers(motion::Model model) {
  const auto klt = [model](const cv::Mat& first, const cv::Mat& second) {
    cv::Mat before, after;
    cv::cvtColor(first, before, cv::COLOR_BGR2GRAY);
    cv::cvtColor(second, after, cv::COLOR_BGR2GRAY);
    Points corners, found, from, to;
    cv::goodFeaturesToTrack(before, corners, 500, 0.01, 8.0);
    if (corners.empty()) return Eigen::Matrix3d(Eigen::Matrix3d::Identity());
    std::vector<unsigned char> status;
    cv::calcOpticalFlowPyrLK(before, after, corners, found, status, cv::noArray(), cv::Size(21, 21), 3);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      if (status[k] == 0) continue;
      from.push_back(corners[k]);
      to.push_back(found[k]);
    }
    return fit(model, from, to);
  };
  const cv::Ptr<cv::DISOpticalFlow> flow = cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_FAST);
  const auto dis = [model, flow](const cv::Mat& first, const cv::Mat& second) {
    cv::Mat before, after;
    cv::cvtColor(first, before, cv::COLOR_BGR2GRAY);
    cv::cvtColor(second, after, cv::COLOR_BGR2GRAY);
    cv::Mat2f field;
    flow->calc(before, after, field);
    Points from, to;
    for (int v = 4; v < field.rows; v += 8) {
      for (int u = 4; u < field.cols; u += 8) {
        from.emplace_back(static_cast<float>(u), static_cast<float>(v));
        to.emplace_back(static_cast<float>(u) + field(v, u)[0], static_cast<float>(v) + field(v, u)[1]);
      }
    }
    return fit(model, from, to);
  };
  const std::string name = model == motion::Model::kConstant ? "median" : kRobustFitName;
  return {{"klt + " + name, klt}, {"dis + " + name, dis}};
}

}  // namespace laparoscope_servo::bench
