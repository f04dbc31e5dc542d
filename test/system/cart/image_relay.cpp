#include "image_relay.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace laparoscope_servo::test {

ImageRelay::ImageRelay(const std::string& from, const std::string& to) : spinner_(1, &queue_) {
  node_.setCallbackQueue(&queue_);
  publisher_ = node_.advertise<sensor_msgs::Image>(to, 2);
  subscriber_ = node_.subscribe(from, 2, &ImageRelay::onImage, this, ros::TransportHints().tcpNoDelay());
  spinner_.start();
}

ImageRelay::~ImageRelay() {
  spinner_.stop();
}

void ImageRelay::cover() {
  const std::lock_guard<std::mutex> lock(mutex_);
  faults_ = {image_faults::black()};
  covered_ = true;
}

void ImageRelay::begin(const Fault& fault) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (covered_) faults_.clear();
  covered_ = false;
  faults_.push_back(fault);
}

void ImageRelay::end() {
  const std::lock_guard<std::mutex> lock(mutex_);
  faults_.clear();
  covered_ = false;
}

std::vector<sensor_msgs::ImageConstPtr> ImageRelay::last(std::size_t count) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {kept_.end() - static_cast<std::ptrdiff_t>(std::min(count, kept_.size())), kept_.end()};
}

void ImageRelay::onImage(const sensor_msgs::ImageConstPtr& image) {
  const std::lock_guard<std::mutex> lock(mutex_);
  kept_.push_back(image);
  if (kept_.size() > kKept) kept_.pop_front();
  pass(*image, 0);
}

void ImageRelay::pass(const sensor_msgs::Image& image, std::size_t fault) {
  if (fault == faults_.size()) return publisher_.publish(image);
  faults_[fault](image, [&](const sensor_msgs::Image& out) { pass(out, fault + 1); });
}

namespace image_faults {

namespace {

using Image = sensor_msgs::Image;
using Publish = ImageRelay::Publish;

cv::Mat noise(const cv::Size& size) {
  cv::Mat coarse(size / 16, CV_8UC3), out;
  cv::RNG random(5);
  random.fill(coarse, cv::RNG::UNIFORM, 20, 200);
  cv::resize(coarse, out, size, 0, 0, cv::INTER_CUBIC);
  return out;
}

}  // namespace

cv::Mat pixels(Image& image) {
  constexpr std::uint32_t kLeast = 64, kMost = 4096;  // px
  const auto sensible = [](std::uint32_t side) { return side >= kLeast && side <= kMost; };
  if (!sensible(image.width) || !sensible(image.height) || image.encoding != "bgr8") return {};
  if (image.step != 3 * image.width || image.data.size() != std::size_t{image.step} * image.height) return {};
  return {static_cast<int>(image.height), static_cast<int>(image.width), CV_8UC3, image.data.data(), image.step};
}

cv::Rect middle(const cv::Mat& image) {
  return {image.cols / 4, image.rows / 6, image.cols / 2, 2 * image.rows / 3};
}

ImageRelay::Fault changedInTime(const std::function<void(cv::Mat&, double)>& change) {
  const auto first = std::make_shared<ros::Time>();
  return [=](const Image& image, const Publish& publish) {
    if (first->isZero()) *first = image.header.stamp;
    Image out = image;
    cv::Mat mat = pixels(out);
    if (!mat.empty()) change(mat, (image.header.stamp - *first).toSec());
    publish(out);
  };
}

ImageRelay::Fault changed(const std::function<void(cv::Mat&)>& change) {
  return changedInTime([change](cv::Mat& mat, double) { change(mat); });
}

ImageRelay::Fault frozen() {
  const auto first = std::make_shared<std::optional<Image>>();
  return [first](const Image& image, const Publish& publish) {
    if (!*first) *first = image;
    (*first)->header = image.header;
    publish(**first);
  };
}

ImageRelay::Fault frozenInside() {
  const auto first = std::make_shared<cv::Mat>();
  return changed([first](cv::Mat& mat) {
    if (first->empty()) *first = mat(middle(mat)).clone();
    first->copyTo(mat(middle(mat)));
  });
}

ImageRelay::Fault inTurn(const std::vector<sensor_msgs::ImageConstPtr>& pictures) {
  const auto next = std::make_shared<std::size_t>(0);
  return [=](const Image& image, const Publish& publish) {
    Image out = *pictures[(*next)++ % pictures.size()];
    out.header = image.header;
    publish(out);
  };
}

ImageRelay::Fault swapped() {
  const auto waiting = std::make_shared<std::optional<Image>>();
  return [waiting](const Image& image, const Publish& publish) {
    if (!*waiting) {
      *waiting = image;
      return;
    }
    publish(image);
    publish(**waiting);
    waiting->reset();
  };
}

ImageRelay::Fault flipped(int code) {
  return changed([code](cv::Mat& mat) { cv::flip(mat.clone(), mat, code); });
}

ImageRelay::Fault warped(const cv::Matx23d& to) {
  return changed([to](cv::Mat& mat) { cv::warpAffine(mat.clone(), mat, to, mat.size()); });
}

ImageRelay::Fault flippedAndTurned() {
  return changed([](cv::Mat& mat) {
    cv::Mat flipped;
    cv::flip(mat, flipped, 1);
    const cv::Point2f middle(0.5F * static_cast<float>(mat.cols - 1), 0.5F * static_cast<float>(mat.rows - 1));
    cv::warpAffine(flipped, mat, cv::getRotationMatrix2D(middle, 90.0, 1.0), mat.size());
  });
}

ImageRelay::Fault half() {
  const auto first = std::make_shared<cv::Mat>();
  return changed([first](cv::Mat& mat) {
    cv::Mat lower = mat.rowRange(mat.rows / 2, mat.rows);
    if (first->empty()) *first = lower.clone();
    first->copyTo(lower);
  });
}

ImageRelay::Fault resized(int width, int height) {
  return [=](const Image& image, const Publish& publish) {
    Image in = image;
    if (pixels(in).empty()) return publish(image);
    Image out = image;
    out.width = static_cast<std::uint32_t>(width);
    out.height = static_cast<std::uint32_t>(height);
    out.step = 3 * out.width;
    out.data.assign(static_cast<std::size_t>(out.step) * out.height, 0);
    cv::Mat mat(height, width, CV_8UC3, out.data.data());
    cv::resize(pixels(in), mat, mat.size(), 0, 0, cv::INTER_AREA);
    publish(out);
  };
}

ImageRelay::Fault late(double seconds) {
  const auto waiting = std::make_shared<std::deque<Image>>();
  return [=](const Image& image, const Publish& publish) {
    waiting->push_back(image);
    while ((image.header.stamp - waiting->front().header.stamp).toSec() >= seconds) {
      publish(waiting->front());
      waiting->pop_front();
    }
  };
}

ImageRelay::Fault stamped(double offset, int period) {
  const auto count = std::make_shared<int>(0);
  return [=](const Image& image, const Publish& publish) {
    Image out = image;
    if (++*count % period == 0 && !out.header.stamp.isZero()) out.header.stamp += ros::Duration(offset);
    publish(out);
  };
}

ImageRelay::Fault unstamped() {
  return [](const Image& image, const Publish& publish) {
    Image out = image;
    out.header.stamp = ros::Time();
    publish(out);
  };
}

ImageRelay::Fault unevenlyStamped(double most) {
  const auto random = std::make_shared<cv::RNG>(7);
  return [=](const Image& image, const Publish& publish) {
    Image out = image;
    out.header.stamp += ros::Duration(random->uniform(0.0, most));
    publish(out);
  };
}

ImageRelay::Fault slowlyStamped(double rate) {
  const auto first = std::make_shared<std::optional<ros::Time>>();
  return [=](const Image& image, const Publish& publish) {
    if (!*first) *first = image.header.stamp;
    Image out = image;
    out.header.stamp = **first + (image.header.stamp - **first) * rate;
    publish(out);
  };
}

ImageRelay::Fault flickering() {
  const auto count = std::make_shared<int>(0);
  return changed([count](cv::Mat& mat) { mat *= ++*count % 2 == 0 ? 0.6 : 1.4; });
}

ImageRelay::Fault black() {
  return changed([](cv::Mat& mat) { mat.setTo(0); });
}

ImageRelay::Fault silent() {
  return [](const Image&, const Publish&) {};
}

ImageRelay::Fault dropped(int period) {
  const auto count = std::make_shared<int>(0);
  return [=](const Image& image, const Publish& publish) {
    if (++*count % period != 0) publish(image);
  };
}

ImageRelay::Fault otherScene(int period) {
  const auto count = std::make_shared<int>(0);
  return changed([=](cv::Mat& mat) {
    if (++*count % period == 0) noise(mat.size()).copyTo(mat);
  });
}

ImageRelay::Fault mislabelled() {
  return [](const Image& image, const Publish& publish) {
    Image out = image;
    out.encoding = "bgra16";
    publish(out);
  };
}

}  // namespace image_faults

}  // namespace laparoscope_servo::test
