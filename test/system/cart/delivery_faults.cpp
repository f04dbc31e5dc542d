#include "delivery_faults.h"

#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace laparoscope_servo::test::image_faults {

namespace {

using Image = sensor_msgs::Image;
using Publish = ImageRelay::Publish;

// What a broken driver sends, each impossible in a way of its own.
const std::vector<std::function<void(Image&)>>& nonsense() {
  static const std::vector<std::function<void(Image&)>> kinds{
      [](Image& image) { image.data.clear(); },
      [](Image& image) { image.data.resize(image.data.size() / 3); },
      [](Image& image) { image.step = 0; },
      [](Image& image) { image.step = 1; },
      [](Image& image) { image.step = 0xFFFFFFFF; },
      [](Image& image) { image.width = 0; },
      [](Image& image) { image.height = 0; },
      [](Image& image) { image.height = 0xFFFFFFFF; },
      [](Image& image) { image.width = image.height = 0x10000; },
      [](Image& image) { image.encoding.clear(); },
      [](Image& image) { image.encoding = std::string(100000, '%'); },
      [](Image& image) { image.encoding = "bayer_rggb8"; },
      [](Image& image) { image.encoding = "32FC3"; },
      [](Image& image) { image.encoding = "8UC3333"; },
      [](Image& image) { image.width = image.height = image.step = 0; },
  };
  return kinds;
}

}  // namespace

ImageRelay::Fault oldButStampedNow(double seconds) {
  const auto kept = std::make_shared<std::deque<Image>>();
  return [=](const Image& image, const Publish& publish) {
    kept->push_back(image);
    while (kept->size() > 1 && (image.header.stamp - (*kept)[1].header.stamp).toSec() >= seconds) kept->pop_front();
    if ((image.header.stamp - kept->front().header.stamp).toSec() < seconds) return;  // until the first has aged
    Image out = kept->front();
    out.header = image.header;
    publish(out);
  };
}

ImageRelay::Fault filling(double share) {
  const auto kept = std::make_shared<std::deque<Image>>();
  const auto due = std::make_shared<double>(0.0);
  return [=](const Image& image, const Publish& publish) {
    kept->push_back(image);
    *due += share;
    if (*due < 1.0) return;
    *due -= 1.0;
    Image out = kept->front();
    kept->pop_front();
    out.header = image.header;
    publish(out);
  };
}

ImageRelay::Fault inBursts(std::size_t count) {
  const auto waiting = std::make_shared<std::vector<Image>>();
  return [=](const Image& image, const Publish& publish) {
    waiting->push_back(image);
    if (waiting->size() < count) return;
    for (const Image& one : *waiting) publish(one);
    waiting->clear();
  };
}

ImageRelay::Fault doubled() {
  const auto last = std::make_shared<ros::Time>();
  return [last](const Image& image, const Publish& publish) {
    const ros::Duration half = last->isZero() ? ros::Duration(0.02) : (image.header.stamp - *last) * 0.5;
    *last = image.header.stamp;
    Image out = image;
    if (!out.header.stamp.isZero()) out.header.stamp -= half;  // another fault may have taken it away
    publish(out);
    publish(image);
  };
}

ImageRelay::Fault repeatedEvery(int period) {
  const auto before = std::make_shared<Image>();
  const auto count = std::make_shared<int>(0);
  return [=](const Image& image, const Publish& publish) {
    Image out = image;
    if (++*count % period == 0) out.data = before->data;
    *before = image;
    publish(out);
  };
}

ImageRelay::Fault only(int period) {
  const auto count = std::make_shared<int>(0);
  return [=](const Image& image, const Publish& publish) {
    if (++*count % period == 0) publish(image);
  };
}

ImageRelay::Fault laterAndLater(double rate) {
  const auto waiting = std::make_shared<std::deque<Image>>();
  const auto first = std::make_shared<ros::Time>();
  return [=](const Image& image, const Publish& publish) {
    if (first->isZero()) *first = image.header.stamp;
    waiting->push_back(image);
    const ros::Duration late = (image.header.stamp - *first) * rate;
    while (!waiting->empty() && image.header.stamp - waiting->front().header.stamp >= late) {
      publish(waiting->front());
      waiting->pop_front();
    }
  };
}

ImageRelay::Fault oldBetween(std::size_t pictures) {
  const auto kept = std::make_shared<std::deque<Image>>();
  const auto count = std::make_shared<int>(0);
  return [=](const Image& image, const Publish& publish) {
    kept->push_back(image);
    if (kept->size() > pictures + 1) kept->pop_front();
    Image out = ++*count % 2 == 0 ? kept->front() : image;
    out.header = image.header;
    publish(out);
  };
}

ImageRelay::Fault stuttering(double share) {
  const auto standing = std::make_shared<Image>();
  const auto first = std::make_shared<ros::Time>();
  return [=](const Image& image, const Publish& publish) {
    if (first->isZero()) *first = image.header.stamp;
    const double second = std::fmod((image.header.stamp - *first).toSec(), 1.0);
    if (second >= share || standing->data.empty()) *standing = image;
    Image out = *standing;
    out.header = image.header;
    publish(out);
  };
}

ImageRelay::Fault blockLost(int period) {
  const auto random = std::make_shared<cv::RNG>(13);
  return [=](const Image& image, const Publish& publish) {
    Image out = image;
    if (random->uniform(0, period) == 0) {
      const int size = static_cast<int>(out.data.size());
      const auto from = out.data.begin() + random->uniform(0, size / 2 + 1);
      out.data.erase(from, from + random->uniform(0, size / 16 + 1));
      out.data.resize(image.data.size());
    }
    publish(out);
  };
}

ImageRelay::Fault grey() {
  return [](const Image& image, const Publish& publish) {
    Image in = image;
    if (pixels(in).empty()) return publish(image);
    Image out = image;
    out.encoding = "mono8";
    out.step = out.width;
    out.data.resize(static_cast<std::size_t>(out.step) * out.height);
    cv::Mat mat(static_cast<int>(out.height), static_cast<int>(out.width), CV_8UC1, out.data.data());
    cv::cvtColor(pixels(in), mat, cv::COLOR_BGR2GRAY);
    publish(out);
  };
}

ImageRelay::Fault malformed() {
  const auto count = std::make_shared<std::size_t>(0);
  return [count](const Image& image, const Publish& publish) {
    Image out = image;
    nonsense()[(*count)++ % nonsense().size()](out);
    publish(out);
  };
}

}  // namespace laparoscope_servo::test::image_faults
