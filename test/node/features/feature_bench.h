// A camera before the trackers of features `/scope/dots`, `/scope/points` and `/scope/edges`, for tests against the
// running nodelets.
#pragma once

#include <laparoscope_servo/SelectFeatures.h>
#include <laparoscope_servo/TrackedFeatures.h>

#include <future>
#include <map>
#include <string>

#include "node/tracker/camera_bench.h"
#include "support/feature_scene.h"

namespace laparoscope_servo::test_support {

class FeatureBench {
 public:
  FeatureBench() : node_("scope"), images_(node_.advertise<sensor_msgs::Image>("image", 1)) {
    for (const char* const kind : {"dots", "points", "edges"})
      inboxes_.try_emplace(kind, node_, std::string(kind) + "/features");
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

  // A picture of its own, no two of which repeat.
  cv::Mat picture(double shift = 0.0) { return featureScene(shift, ++seed_); }

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

  bool reset(const std::string& kind) {
    std_srvs::Trigger call;
    return ros::service::call("/scope/" + kind + "/reset", call) && call.response.success;
  }

  ros::NodeHandle& node() { return node_; }

 private:
  ros::NodeHandle node_;
  ros::Publisher images_;
  std::map<std::string, Inbox<TrackedFeatures>> inboxes_;
  unsigned seed_ = 0;
};

}  // namespace laparoscope_servo::test_support
