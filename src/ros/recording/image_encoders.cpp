#include "ros/recording/image_encoders.h"

#include <sensor_msgs/image_encodings.h>

#include <boost/make_shared.hpp>
#include <exception>
#include <opencv2/imgcodecs.hpp>

#include "ros/common/clocks.h"
#include "ros/common/quiet_thread.h"
#include "ros/tracker/image_conversion.h"

namespace laparoscope_servo {

sensor_msgs::CompressedImagePtr compressed(const sensor_msgs::Image& image, int jpeg_quality) {
  const cv::Mat pixels = trackerImage(image);
  const auto message = boost::make_shared<sensor_msgs::CompressedImage>();
  message->header = image.header;
  message->format = image.encoding + "; jpeg compressed " + (pixels.channels() == 3 ? "bgr8" : "");
  if (!cv::imencode(".jpg", pixels, message->data, {cv::IMWRITE_JPEG_QUALITY, jpeg_quality}))
    throw ImageError("an image of " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                     " px cannot be encoded as JPEG");
  return message;
}

ImageEncoders::ImageEncoders(int threads, int most, int jpeg_quality, const Done& done)
    : most_(static_cast<std::size_t>(most)), quality_(jpeg_quality), done_(done) {
  for (int k = 0; k < threads; ++k) threads_.push_back(startQuietThread([this] { run(); }));
}

ImageEncoders::~ImageEncoders() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

bool ImageEncoders::add(const sensor_msgs::ImageConstPtr& image, const ros::Time& time) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (waiting_.size() >= most_) {
      ++counts_.dropped;
      return false;
    }
    waiting_.emplace_back(image, time);
  }
  changed_.notify_one();
  return true;
}

ImageEncoders::Counts ImageEncoders::counts() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counts_;
}

void ImageEncoders::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const auto [image, time] = waiting_.front();
    waiting_.pop_front();
    lock.unlock();
    const double begin = steadyNow();
    std::string error;
    try {
      done_(compressed(*image, quality_), time);
    } catch (const std::exception& e) {
      error = e.what();
    }
    lock.lock();
    counts_.time = steadyNow() - begin;
    if (!error.empty()) {
      ++counts_.refused;
      counts_.refusal = error;
    }
  }
}

}  // namespace laparoscope_servo
