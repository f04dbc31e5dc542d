// A camera of 1080p and the tracker's nodelet in one manager: what a screen beside them costs the tracker. Run by
// scripts/measure_screen; no test.
//
//   screen_load SECONDS FRAMES.csv [RATE]     60 images a second where nothing is said
//
// Every image is stamped when it is published. Two bands at its top tell its number by their grey, for who looks at the
// screen. FRAMES.csv: number, stamp [s], how late it was published [s], delay to the homography [s; empty: none], of
// that the processing [s], state.
#include <cv_bridge/cv_bridge.h>
#include <laparoscope_servo/Homography.h>
#include <laparoscope_servo/SelectRoi.h>
#include <nodelet/loader.h>
#include <ros/ros.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <string>
#include <thread>
#include <vector>

#include "support/synthetic_sequence.h"

namespace {

const cv::Size kSize(1920, 1080);
constexpr int kImages =
    120;                   // made before, a closed walk of which no two are alike: a picture that repeats is no picture
constexpr int kBand = 60;  // px
constexpr int kLevels = 12;  // 144 numbers, 2.4 s

struct Frame {
  ros::Time stamp;
  double late = 0.0;
  double delay = -1.0;
  double processing = 0.0;
  int state = -1;
};

// A walk over a texture, 5 px an image at most.
std::vector<cv::Mat> pictures() {
  const cv::Mat scene = laparoscope_servo::test_support::texture(kSize + cv::Size(200, 200));
  std::vector<cv::Mat> result;
  for (int k = 0; k < kImages; ++k) {
    const double t = 2.0 * M_PI * k / kImages;
    result.push_back(
        scene(cv::Rect(cv::Point(static_cast<int>(100 - 90 * std::cos(t)), 100 + static_cast<int>(50 * std::sin(t))),
                       kSize))
            .clone());
  }
  return result;
}

void writeNumber(cv::Mat& image, int number) {
  const int digits[] = {number % kLevels, (number / kLevels) % kLevels};
  for (int k = 0; k < 2; ++k) image.rowRange(k * kBand, (k + 1) * kBand).setTo(cv::Scalar::all(10 + 20 * digits[k]));
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "screen_load");
  if (argc < 3) {
    std::fprintf(stderr, "screen_load SECONDS FRAMES.csv [RATE]\n");
    return 2;
  }
  const double rate = argc > 3 ? std::stod(argv[3]) : 60.0;
  const int count = static_cast<int>(std::stod(argv[1]) * rate);
  ros::NodeHandle node;
  nodelet::Loader loader;
  const ros::M_string no_remappings{{"image", "camera/image_raw"}};
  if (!loader.load("/tracker", "laparoscope_servo/Tracker", no_remappings, {})) return 1;
  ros::Publisher images = node.advertise<sensor_msgs::Image>("camera/image_raw", 1);
  std::vector<Frame> frames(static_cast<std::size_t>(count));
  std::mutex mutex;
  std::size_t published = 0;
  const ros::Subscriber results = node.subscribe<laparoscope_servo::Homography>(
      "tracker/homography", 100, [&](const laparoscope_servo::HomographyConstPtr& result) {
        const ros::Time now = ros::Time::now();
        const std::lock_guard<std::mutex> lock(mutex);
        for (std::size_t k = published; k-- > 0 && frames[k].stamp >= result->header.stamp;) {
          if (frames[k].stamp != result->header.stamp) continue;
          frames[k].delay = (now - frames[k].stamp).toSec();
          frames[k].processing = result->processing_time;
          frames[k].state = result->state;
        }
      });
  ros::AsyncSpinner spinner(1);
  spinner.start();
  std::vector<cv::Mat> walk = pictures();
  while (ros::ok() && images.getNumSubscribers() == 0) ros::WallDuration(0.01).sleep();
  std::thread selector([] {
    laparoscope_servo::SelectRoi call;
    call.request.roi.x_offset = 800;
    call.request.roi.y_offset = 450;
    call.request.roi.width = call.request.roi.height = 240;
    ros::service::waitForService("tracker/select_roi");
    if (!ros::service::call("tracker/select_roi", call) || !call.response.success)
      std::fprintf(stderr, "not selected: %s\n", call.response.message.c_str());
  });
  const auto begin = std::chrono::steady_clock::now();
  for (int k = 0; k < count && ros::ok(); ++k) {
    cv::Mat& picture = walk[static_cast<std::size_t>(k % kImages)];
    writeNumber(picture, k);
    std_msgs::Header header;
    header.frame_id = "camera";
    const sensor_msgs::ImagePtr message = cv_bridge::CvImage(header, "bgr8", picture).toImageMsg();
    const auto due = begin + std::chrono::duration<double>(k / rate);
    std::this_thread::sleep_until(due);
    message->header.stamp = ros::Time::now();
    {
      const std::lock_guard<std::mutex> lock(mutex);
      Frame& frame = frames[static_cast<std::size_t>(k)];
      frame.stamp = message->header.stamp;
      frame.late = std::chrono::duration<double>(std::chrono::steady_clock::now() - due).count();
      published = static_cast<std::size_t>(k) + 1;
    }
    images.publish(message);
  }
  ros::WallDuration(1.0).sleep();
  selector.join();
  const std::lock_guard<std::mutex> lock(mutex);
  std::ofstream file(argv[2]);
  file.precision(6);
  file << "number,stamp,late,delay,processing,state\n" << std::fixed;
  for (std::size_t k = 0; k < published; ++k) {
    file << k << ',' << frames[k].stamp.toSec() << ',' << frames[k].late << ',';
    if (frames[k].state >= 0) file << frames[k].delay;
    file << ',' << frames[k].processing << ',' << frames[k].state << '\n';
  }
  return 0;
}
