// A camera of the test's: images of one kind after the other, 20 a second, in a thread of its own.
#pragma once

#include <cv_bridge/cv_bridge.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>

#include <atomic>
#include <boost/make_shared.hpp>
#include <functional>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "support/synthetic_sequence.h"

namespace laparoscope_servo::test_support {

class ImageFeed {
 public:
  using Make =
      std::function<sensor_msgs::Image(int)>;  // of the turn; no two may be alike, or the feed counts as frozen

  ImageFeed() : thread_([this] { run(); }) {}
  ~ImageFeed() {
    ends_ = true;
    thread_.join();
  }
  // Null: no images.
  void show(const Make& make) {
    const std::lock_guard<std::mutex> lock(mutex_);
    make_ = make;
  }
  // Seconds by which the camera's clock is ahead.
  void setClock(double ahead) { ahead_ = ahead; }

  // Left half black, right half white, with a grey that changes in its lowest rows.
  static Make halves(const cv::Size& size, const std::string& encoding) {
    return [size, encoding](int turn) {
      cv::Mat image(size, CV_8UC3, cv::Scalar::all(0));
      image.colRange(size.width / 2, size.width).setTo(cv::Scalar::all(255));
      image.rowRange(size.height - size.height / 8, size.height).setTo(cv::Scalar::all(60 + 3 * (turn % 50)));
      if (size.area() == 1) image.setTo(cv::Scalar::all(235 + turn % 20));
      return *cv_bridge::cvtColor(boost::make_shared<cv_bridge::CvImage>(std_msgs::Header(), "bgr8", image), encoding)
                  ->toImageMsg();
    };
  }
  // What can be tracked, with the noise of a sensor.
  static Make tissue(const cv::Size& size) {
    return [size, texture = texture(size)](int turn) {
      cv::Mat noise(size, CV_8UC3);
      cv::RNG(static_cast<std::uint64_t>(turn) + 1).fill(noise, cv::RNG::UNIFORM, 0, 4);
      return *cv_bridge::CvImage(std_msgs::Header(), "bgr8", texture + noise).toImageMsg();
    };
  }

 private:
  void run() {
    int turn = 0;
    for (ros::WallRate rate(20.0); !ends_ && ros::ok(); rate.sleep()) {
      Make make;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        make = make_;
      }
      if (!make) continue;
      sensor_msgs::Image image = make(++turn);
      image.header.frame_id = "camera";
      image.header.stamp = ros::Time::now() + ros::Duration(ahead_);
      publisher_.publish(image);
    }
  }

  ros::NodeHandle node_;
  ros::Publisher publisher_ = node_.advertise<sensor_msgs::Image>("camera/image_raw", 1);
  std::mutex mutex_;
  Make make_;
  std::atomic<double> ahead_{0.0};
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace laparoscope_servo::test_support
