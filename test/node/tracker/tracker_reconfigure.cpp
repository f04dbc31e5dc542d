// Thresholds of the tracker nodelet that change while it tracks, in a manager that it shares with another.
#include <gtest/gtest.h>

#include <limits>

#include "camera_bench.h"
#include "support/reconfigure_client.h"

namespace laparoscope_servo {
namespace {

using dynamic_reconfigure::Config;
using test_support::CameraBench;
using test_support::ReconfigureClient;
using test_support::waitFor;

const geometry::Rectangle kRoi{100.0, 70.0, 100.0, 90.0};
const std::string kVisible = "tracking__quality__min_visible_fraction";
const std::string kPath = "tracking/quality/min_visible_fraction";

class TrackerReconfigure : public testing::Test {
 protected:
  static CameraBench& camera() {
    static CameraBench bench("left");
    return bench;
  }
  static ReconfigureClient& client() {
    static ReconfigureClient instance("/left/tracker");
    return instance;
  }

  // Tracks the region.
  void SetUp() override {
    ASSERT_TRUE(camera().ready());
    ASSERT_EQ(client().set(kVisible, 0.1), "");
    ASSERT_TRUE(waitFor([] { return client().updated(kVisible) == 0.1; }));
    ASSERT_TRUE(camera().reset());
    auto answer = camera().select(kRoi);
    while (answer.wait_for(std::chrono::milliseconds(5)) != std::future_status::ready)
      ASSERT_TRUE(camera().track(image_, nextStamp()));
    ASSERT_TRUE(answer.get().success);
    ASSERT_EQ(state(image_), Homography::TRACKING);
  }

  static ros::Time nextStamp() {
    static ros::Time stamp(1000, 0);
    stamp += ros::Duration(0.04);
    return stamp;
  }
  int state(const cv::Mat& image) {
    const HomographyConstPtr answer = camera().track(image, nextStamp());
    return answer ? answer->state : -1;
  }
  cv::Mat covered() const {
    cv::Mat result = image_.clone();
    result(cv::Rect(100, 70, 40, 90)).setTo(cv::Scalar::all(10));
    return result;
  }

  const cv::Mat image_ = test_support::texture(cv::Size(320, 240));
};

TEST_F(TrackerReconfigure, TellsWhatMayChange) {
  ASSERT_TRUE(waitFor([] { return !client().types().empty(); }));
  const auto types = client().types();
  EXPECT_EQ(types.at(kVisible), "double");
  EXPECT_EQ(types.at("tracking__quality__confirmations"), "int");
  EXPECT_EQ(types.count("tracking__esm__levels"), 0u);
  EXPECT_EQ(types.count("input__max_repeats"), 0u);
}

TEST_F(TrackerReconfigure, AThresholdCountsFromTheNextImageOnAndTheRegionStays) {
  ASSERT_EQ(state(covered()), Homography::TRACKING);
  ASSERT_EQ(client().set(kVisible, 0.95), "");
  EXPECT_EQ(client().answered(kVisible), 0.95);
  EXPECT_EQ(state(covered()), Homography::SEARCHING);
  EXPECT_TRUE(waitFor([] { return client().stored(kPath) == 0.95; }));
  ASSERT_EQ(client().set(kVisible, 0.1), "");
  EXPECT_TRUE(waitFor([this] { return state(image_) == Homography::TRACKING; })) << "without selecting it again";
}

TEST_F(TrackerReconfigure, IsRefusedAsAWholeAndTheManagerGoesOn) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const double stored = client().stored(kPath);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::pair<std::string, double> wrong[] = {{"tracking__quality__min_zncc", kNan},
                                                  {"tracking__quality__min_zncc", 1.5},
                                                  {"tracking__quality__max_jump", kInfinity},
                                                  {"tracking__quality__min_znc", 0.5},
                                                  {"tracking__esm__levels", 2.0},
                                                  {"select_timeout", 1.0},
                                                  {"views__capacity", 3.0},
                                                  {"", 0.0},
                                                  {std::string(100000, '_'), 0.0},
                                                  {"tracking__quality__confirmations", 2.5}};
  for (const auto& [name, value] : wrong) {
    SCOPED_TRACE(name.substr(0, 40) + " = " + std::to_string(value));
    const int updates = client().updates();
    EXPECT_EQ(client().set([name = name, value = value](Config& config) {
      ReconfigureClient::add(config, kVisible, 0.95);
      ReconfigureClient::add(config, name, value);
    }),
              "refused");
    EXPECT_TRUE(waitFor([&] { return client().updates() > updates; })) << "tools are told what counts";
    EXPECT_EQ(client().updated(kVisible), 0.1);
  }
  EXPECT_EQ(client().set([](Config& config) {
    for (int k = 0; k < 5000; ++k) ReconfigureClient::add(config, kVisible, 0.5);
  }),
            "refused");
  EXPECT_EQ(client().stored(kPath), stored);
  EXPECT_EQ(state(covered()), Homography::TRACKING) << "by the threshold that it had";
  ReconfigureClient other("/right/tracker");
  EXPECT_EQ(other.set([](Config&) {}), "");
  EXPECT_EQ(other.answered(kVisible), 0.1);
}

TEST_F(TrackerReconfigure, WhatIsSetTheOtherTrackerDoesNotSee) {
  ReconfigureClient other("/right/tracker");
  ASSERT_EQ(other.set(kVisible, 0.95), "");
  EXPECT_EQ(state(covered()), Homography::TRACKING);
  ASSERT_EQ(client().set([](Config&) {}), "");
  EXPECT_EQ(client().answered(kVisible), 0.1);
}

TEST_F(TrackerReconfigure, NoImageIsNeededForAnAnswer) {
  ASSERT_EQ(client().set(kVisible, 0.2), "");
  EXPECT_TRUE(waitFor([] { return client().updated(kVisible) == 0.2; }));
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "tracker_reconfigure");
}
