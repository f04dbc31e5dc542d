// The nodelet ContourTexture: selection, tracking, and whatever may go wrong with images and selections.
#include <gtest/gtest.h>
#include <laparoscope_servo/SelectFeatures.h>
#include <laparoscope_servo/TrackedFeatures.h>
#include <ros/ros.h>

#include <future>
#include <sstream>
#include <string>

#include "node/tracker/camera_bench.h"
#include "support/contour_scene.h"
#include "support/feature_scene.h"

namespace laparoscope_servo {
namespace {

using test_support::ContourScene;
using test_support::DiagnosticsListener;
using test_support::imageAt;
using test_support::Inbox;
using test_support::waitFor;

// As the service takes it.
std::string selectionText(double aside = 0.0) {
  const features::FeatureSelection selection = ContourScene::selection();
  std::ostringstream text;
  const char* before = "[{id: thing, closed: true, spline: [";
  for (const Eigen::Vector2d& point : selection[0].points) {
    text << before << '[' << point.x() + aside << ", " << point.y() << ']';
    before = ", ";
  }
  text << "]}]";
  return text.str();
}

ContourScene::Look textured() {
  ContourScene::Look look;
  look.texture = 12.0;
  return look;
}

class ContourNodelet : public testing::Test {
 protected:
  struct Bench {
    explicit Bench(const std::string& space) : node(space) {}
    ros::NodeHandle node;
    ros::Publisher images = node.advertise<sensor_msgs::Image>("image", 1);
    Inbox<TrackedFeatures> features{node, "contour/features"};
    ContourScene scene{textured()};
    unsigned image = 0;
    double time = 1000.0;

    bool ready() const {
      return waitFor([this] { return images.getNumSubscribers() > 0 && features.connected(); });
    }
    // Null when the image is refused.
    TrackedFeaturesConstPtr send(const cv::Mat& picture, double patience = 20.0) {
      const sensor_msgs::ImagePtr message = imageAt(picture, time += 0.04);
      images.publish(message);
      waitFor([&] { return features.at(message->header.stamp) != nullptr; }, patience);
      return features.at(message->header.stamp);
    }
    TrackedFeaturesConstPtr track(int moved = 0, double patience = 20.0) {
      return send(scene.image(moved, ++image), patience);
    }
    TrackedFeaturesConstPtr trackUntil(std::uint8_t state) {
      TrackedFeaturesConstPtr told;
      waitFor([&] { return (told = track(0, 0.5)) != nullptr && told->state == state; });
      return told && told->state == state ? told : nullptr;
    }
    SelectFeatures::Response select(const std::string& text) {
      SelectFeatures call;
      call.request.selection = text;
      const std::string name = node.resolveName("contour/select_features");
      auto answer = std::async(std::launch::async, [&call, name] {
        return ros::service::waitForService(name, 10000) && ros::service::call(name, call);
      });
      while (answer.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready) track(0, 0.5);
      if (!answer.get()) call.response.message = "the service call failed";
      return call.response;
    }
  };
  static Bench& bench() {
    static Bench bench("scope");
    return bench;
  }

  void SetUp() override {
    ASSERT_TRUE(bench().ready());
    ASSERT_TRUE(waitFor([] { return bench().track(0, 0.5) != nullptr; })) << "the nodelet does not answer";
    std_srvs::Trigger call;
    ASSERT_TRUE(ros::service::call("/scope/contour/reset", call) && call.response.success);
  }
};

TEST_F(ContourNodelet, SelectsInTheNextImageAndTracks) {
  EXPECT_EQ(bench().track()->state, TrackedFeatures::IDLE);
  const SelectFeatures::Response answer = bench().select(selectionText());
  ASSERT_TRUE(answer.success) << answer.message;
  for (int k = 1; k < 25; ++k) {
    const TrackedFeaturesConstPtr told = bench().track(k);
    ASSERT_TRUE(told);
    ASSERT_EQ(told->state, TrackedFeatures::TRACKING) << k << told->reason;
    ASSERT_EQ(told->features.size(), 1u);
    const TrackedFeature& feature = told->features[0];
    EXPECT_EQ(feature.id, "thing");
    EXPECT_EQ(feature.kind, TrackedFeature::HOMOGRAPHY);
    ASSERT_EQ(feature.parameters.size(), 8u);
    EXPECT_EQ(feature.covariance.size(), 64u);
    EXPECT_GT(feature.outline.size(), 100u);
    const Eigen::VectorXd h = Eigen::Map<const Eigen::VectorXd>(feature.parameters.data(), 8);
    EXPECT_LT(bench().scene.error(h, k), 0.5) << k;
  }
}

TEST_F(ContourNodelet, RefusesWhatTheImageDoesNotShowAndGoesOn) {
  ASSERT_TRUE(bench().select(selectionText()).success);
  const SelectFeatures::Response away = bench().select(selectionText(60.0));
  EXPECT_FALSE(away.success);
  EXPECT_NE(away.message.find("thing: no such edge in the image"), std::string::npos) << away.message;
  const SelectFeatures::Response line = bench().select("[{id: a, line: [[10, 10], [200, 100]]}]");
  EXPECT_FALSE(line.success);
  EXPECT_NE(line.message.find("a: kind = line, expected spline"), std::string::npos) << line.message;
  EXPECT_EQ(bench().track()->state, TrackedFeatures::TRACKING);
}

TEST_F(ContourNodelet, SaysThatItIsCoveredAndFindsItAgain) {
  ASSERT_TRUE(bench().select(selectionText()).success);
  cv::Mat covered(ContourScene::kSize, CV_8UC1);
  cv::RNG(77).fill(covered, cv::RNG::UNIFORM, 100, 104);
  const TrackedFeaturesConstPtr told = bench().send(covered);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->state, TrackedFeatures::SEARCHING);
  EXPECT_FALSE(told->reason.empty());
  EXPECT_TRUE(bench().trackUntil(TrackedFeatures::TRACKING));
}

TEST_F(ContourNodelet, ATimeThatJumpsBackAndAnotherSizeEndIt) {
  ASSERT_TRUE(bench().select(selectionText()).success);
  bench().time -= 500.0;
  EXPECT_TRUE(bench().trackUntil(TrackedFeatures::IDLE));
  ASSERT_TRUE(bench().select(selectionText()).success);
  TrackedFeaturesConstPtr told;
  EXPECT_TRUE(waitFor([&] {
    const cv::Mat picture = bench().scene.image(0, ++bench().image);
    told = bench().send(picture(cv::Rect(0, 0, 300, 200)), 0.5);
    return told && told->state == TrackedFeatures::IDLE;
  }));
}

TEST_F(ContourNodelet, SelectsWhatIsInTheFile) {
  Bench from_file("from_file");
  ASSERT_TRUE(from_file.ready());
  EXPECT_TRUE(from_file.trackUntil(TrackedFeatures::TRACKING));
}

TEST_F(ContourNodelet, StandsAsideWithWrongParametersAndNamesThemAll) {
  DiagnosticsListener diagnostics(bench().node, "wrong/contour");
  ASSERT_TRUE(diagnostics.waitForMessage(diagnostic_msgs::DiagnosticStatus::ERROR, "not started"))
      << diagnostics.last();
  EXPECT_NE(diagnostics.last().message.find("/wrong/contour/tracking/edges/rnge"), std::string::npos)
      << diagnostics.last().message;
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "contour_nodelet_test");
}
