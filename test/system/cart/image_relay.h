// What lies between camera and tracker: passes images on, as they are or as a broken camera, grabber or driver would.
#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>

#include <deque>
#include <functional>
#include <mutex>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace laparoscope_servo::test {

class ImageRelay {
 public:
  using Publish = std::function<void(const sensor_msgs::Image&)>;
  // Called with each image in order, in the relay's thread.
  using Fault = std::function<void(const sensor_msgs::Image&, const Publish&)>;

  // From topic to topic. It runs in a thread of its own.
  ImageRelay(const std::string& from, const std::string& to);
  ~ImageRelay();

  // Nothing is seen until a fault of another kind begins.
  void cover();
  // After those that have begun before.
  void begin(const Fault& fault);
  void end();
  // The last `count` pictures that came, at most kKept, the oldest first.
  std::vector<sensor_msgs::ImageConstPtr> last(std::size_t count);

 private:
  static constexpr std::size_t kKept = 12;

  void onImage(const sensor_msgs::ImageConstPtr& image);
  void pass(const sensor_msgs::Image& image, std::size_t fault);

  std::mutex mutex_;
  std::vector<Fault> faults_;
  bool covered_ = false;
  std::deque<sensor_msgs::ImageConstPtr> kept_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  ros::AsyncSpinner spinner_;
};

// Faults of images. Those that have a state begin anew with each call.
namespace image_faults {

// The pixels themselves, three bytes each; empty where an image has none: another fault was there before.
cv::Mat pixels(sensor_msgs::Image& image);
// Where the region is.
cv::Rect middle(const cv::Mat& image);

// Of the pixels alone. `change` gets the picture, and the time since the first one [s].
ImageRelay::Fault changed(const std::function<void(cv::Mat&)>& change);
ImageRelay::Fault changedInTime(const std::function<void(cv::Mat&, double)>& change);

ImageRelay::Fault frozen();
// Only what lies in the middle, where the region is.
ImageRelay::Fault frozenInside();
// Those pictures over and over, with the stamps of the true ones.
ImageRelay::Fault inTurn(const std::vector<sensor_msgs::ImageConstPtr>& pictures);
// Each picture after its successor.
ImageRelay::Fault swapped();
// cv::flip's code: 0 upside down, 1 left to right, -1 both, which is a roll by 180 degrees.
ImageRelay::Fault flipped(int code);
// Mirrored left to right, and turned by 90 degrees about its middle.
ImageRelay::Fault flippedAndTurned();
// The lower half is what was there before, as of a JPEG that broke off.
ImageRelay::Fault half();
ImageRelay::Fault resized(int width, int height);
// By `seconds`, with the stamps of the exposure.
ImageRelay::Fault late(double seconds);
// Every `period`-th stamp is off by `offset` [s]; 1: all.
ImageRelay::Fault stamped(double offset, int period = 1);
ImageRelay::Fault unstamped();
// Each by another time, 0 to `most` [s], later.
ImageRelay::Fault unevenlyStamped(double most);
// The stamps go on at `rate` of the clock; 0: they all are that of the first.
ImageRelay::Fault slowlyStamped(double rate);
// By a matrix of 2 x 3, pixels to pixels: as a grabber that turns, shifts or enlarges the picture.
ImageRelay::Fault warped(const cv::Matx23d& to);
ImageRelay::Fault flickering();
ImageRelay::Fault black();
ImageRelay::Fault silent();
// One of `period` does not come.
ImageRelay::Fault dropped(int period);
// One of `period` is that of another camera; 1: all.
ImageRelay::Fault otherScene(int period);
// The encoding is not what the bytes are.
ImageRelay::Fault mislabelled();

}  // namespace image_faults

}  // namespace laparoscope_servo::test
