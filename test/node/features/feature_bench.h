// A camera before trackers of features in `/scope`, for tests against the running nodelets.
#pragma once

#include <laparoscope_servo/SelectFeatures.h>
#include <laparoscope_servo/TrackedFeatures.h>

#include <functional>
#include <future>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "node/tracker/camera_bench.h"
#include "support/feature_scene.h"

namespace laparoscope_servo::test_support {

class FeatureBench {
 public:
  // Each picture has a number of its own, from 1 on; no two of them may repeat.
  using Scene = std::function<cv::Mat(unsigned number)>;

  // `kinds`: names of the nodelets. `scene`: what the camera shows while nothing else is asked for.
  FeatureBench(const std::vector<std::string>& kinds, Scene scene)
      : node_("scope"), images_(node_.advertise<sensor_msgs::Image>("image", 1)), scene_(std::move(scene)) {
    for (const std::string& kind : kinds) inboxes_.try_emplace(kind, node_, kind + "/features");
  }

  bool ready() const {
    for (const auto& [kind, inbox] : inboxes_) {
      if (!waitFor([&, box = &inbox] { return images_.getNumSubscribers() >= 1 && box->connected(); }) ||
          !ros::service::waitForService("/scope/" + kind + "/select_features", 10000))
        return false;
    }
    return true;
  }

  // Stamps of all tests go up, so that only those tests see time jump that want to.
  static ros::Time nextStamp() {
    static ros::Time stamp(1000, 123456789);
    stamp += ros::Duration(0.04);
    return stamp;
  }

  cv::Mat picture() { return scene_(nextNumber()); }
  unsigned nextNumber() { return ++number_; }

  // What `kind` says of this image; null when it is refused.
  TrackedFeaturesConstPtr track(const std::string& kind, const cv::Mat& image, const ros::Time& stamp = nextStamp(),
                                double patience = 20.0) {
    const sensor_msgs::ImagePtr message = imageAt(image, stamp.toSec());
    images_.publish(message);
    const Inbox<TrackedFeatures>& inbox = inboxes_.at(kind);
    waitFor([&] { return inbox.at(message->header.stamp) != nullptr; }, patience);
    return inbox.at(message->header.stamp);
  }

  // Images until `kind` says something for which the condition holds, or null.
  TrackedFeaturesConstPtr trackUntil(const std::string& kind, const std::function<bool(const TrackedFeatures&)>& is) {
    TrackedFeaturesConstPtr told;
    waitFor([&] {
      told = track(kind, picture(), nextStamp(), 0.5);
      return told && is(*told);
    });
    return told && is(*told) ? told : nullptr;
  }
  TrackedFeaturesConstPtr trackUntil(const std::string& kind, std::uint8_t state) {
    return trackUntil(kind, [state](const TrackedFeatures& told) { return told.state == state; });
  }

  // Pictures until images of their size, colour and time are the camera's, whatever a test did before: those of another
  // size are answered, too, and believed with the third.
  bool settle(const std::string& kind) {
    int answered = 0;
    return trackUntil(kind, [&answered](const TrackedFeatures&) { return ++answered > 3; }) != nullptr;
  }

  // Selects while images come.
  SelectFeatures::Response select(const std::string& kind, const std::string& text) {
    auto answer = ask(kind, text);
    while (answer.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready)
      track(kind, picture(), nextStamp(), 0.5);
    return answer.get();
  }

  std::future<SelectFeatures::Response> ask(const std::string& kind, const std::string& text) {
    SelectFeatures call;
    call.request.selection = text;
    const std::string name = "/scope/" + kind + "/select_features";
    return std::async(std::launch::async, [call, name]() mutable {
      if (!ros::service::call(name, call)) call.response.message = "the service call failed";
      return call.response;
    });
  }

  // More than once if need be: roscpp drops the answer of a call whose connection the server closes while another
  // thread of the client is about to read it, which happens on a busy machine.
  bool reset(const std::string& kind) {
    return waitFor([&] {
      std_srvs::Trigger call;
      return ros::service::call("/scope/" + kind + "/reset", call) && call.response.success;
    });
  }

  ros::NodeHandle& node() { return node_; }

 private:
  ros::NodeHandle node_;
  ros::Publisher images_;
  std::map<std::string, Inbox<TrackedFeatures>> inboxes_;
  Scene scene_;
  unsigned number_ = 0;
};

}  // namespace laparoscope_servo::test_support
