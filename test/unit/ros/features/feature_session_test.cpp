#include "ros/features/feature_session.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "ros/features/feature_trackers.h"
#include "ros/features/selection_text.h"
#include "support/feature_scene.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

using features::State;
using test_support::coveredScene;
using test_support::featureCamera;
using test_support::featureScene;
using test_support::imageAt;

constexpr double kPeriod = 0.04;  // s

class FeatureSessionTest : public testing::TestWithParam<const char*> {
 protected:
  static std::string selectionText() {
    return GetParam() == std::string("dots") ? test_support::kDotsSelection : test_support::kEdgesSelection;
  }

  FeatureSession session(const std::string& file = "") {
    FeatureInput input;
    std::vector<std::string> errors;
    auto tracker = makeFeatureTracker(GetParam(), {}, "", input, errors);
    EXPECT_TRUE(errors.empty());
    input.selection = file;
    return FeatureSession(input, std::move(tracker));
  }

  // At the next stamp, a new picture.
  ProcessedFeatures next(FeatureSession& session, double shift = 0.0) {
    time_ += kPeriod;
    return session.process(*imageAt(featureScene(shift, ++seed_), time_));
  }

  ProcessedFeatures select(FeatureSession& session) {
    time_ += kPeriod;
    return session.process(*imageAt(featureScene(0.0, ++seed_), time_), parseSelection(selectionText()));
  }

  static constexpr double kJump = 30.0;  // px, further than edges and dots are searched by themselves

  // Of the camera, when pixels jump by kJump.
  static Eigen::Isometry3d jump() {
    return Eigen::Isometry3d(Eigen::Translation3d(kJump / 300.0 * FeatureInput().robot_motion.depth, 0.0, 0.0));
  }

  double time_ = 1000.0;
  unsigned seed_ = 0;
  const test_support::TemporaryFolder folder_;
};

TEST_P(FeatureSessionTest, SelectsAndTracks) {
  FeatureSession session = this->session();
  const ProcessedFeatures idle = next(session);
  EXPECT_EQ(idle.result.state, State::kIdle);
  EXPECT_TRUE(idle.selection_stamp.isZero());
  const ProcessedFeatures selected = select(session);
  EXPECT_EQ(selected.selection_stamp, selected.header.stamp);
  EXPECT_TRUE(selected.selected_now) << selected.selection_error;
  const ProcessedFeatures tracked = next(session, 1.0);
  EXPECT_EQ(tracked.result.state, State::kTracking) << tracked.result.reason;
  EXPECT_FALSE(tracked.selected_now);
  EXPECT_EQ(tracked.selection_stamp, selected.header.stamp);
  EXPECT_EQ(tracked.header.frame_id, "optical_of_the_test");
  EXPECT_NEAR(tracked.period, kPeriod, 1e-6);
  EXPECT_EQ(tracked.result.features.size(), 2u);
}

TEST_P(FeatureSessionTest, StartsFromWhereTheCamerasMotionPuts) {
  for (const bool knows : {false, true}) {
    FeatureSession session = this->session();
    session.setCameraInfo(featureCamera());
    select(session);
    std::vector<std::pair<ros::Time, ros::Time>> asked;
    const auto motion = [&](const std::string& frame, const ros::Time& from, const ros::Time& to, std::string& why) {
      EXPECT_EQ(frame, "optical_of_the_test");
      asked.emplace_back(from, to);
      if (!knows) why = "tf does not know";
      return knows ? std::make_optional(jump()) : std::nullopt;
    };
    session.setCameraMotion(motion);
    const ProcessedFeatures jumped = next(session, kJump);
    ASSERT_EQ(asked.size(), 1u);
    EXPECT_NEAR((asked[0].second - asked[0].first).toSec(), kPeriod, 1e-6);
    EXPECT_EQ(jumped.motion_error, knows ? "" : "tf does not know");
    EXPECT_EQ(jumped.result.state == State::kTracking, knows) << jumped.result.reason;
  }
}

// tf knows of the jump an image too late: it is asked for since the image before the jump.
TEST_P(FeatureSessionTest, AMotionThatIsKnownLateIsMadeUpFor) {
  FeatureSession session = this->session();
  session.setCameraInfo(featureCamera());
  select(session);
  const double before = time_;
  bool knows = false;
  session.setCameraMotion([&](const std::string&, const ros::Time& from, const ros::Time&, std::string& why) {
    if (!knows) why = "tf does not know";
    const bool jumps = std::abs(from.toSec() - before) < 0.5 * kPeriod;
    return knows ? std::make_optional(jumps ? jump() : Eigen::Isometry3d::Identity()) : std::nullopt;
  });
  EXPECT_NE(next(session, kJump).result.state, State::kTracking);
  EXPECT_NE(next(session, kJump).result.state, State::kTracking);
  knows = true;
  ProcessedFeatures later;
  for (int k = 0; k < features::StateConfig().confirmations; ++k) later = next(session, kJump);
  EXPECT_EQ(later.result.state, State::kTracking) << later.result.reason;
}

TEST_P(FeatureSessionTest, GoesOnWhenASelectionIsRefused) {
  FeatureSession session = this->session();
  select(session);
  time_ += kPeriod;
  const ProcessedFeatures refused =
      session.process(*imageAt(featureScene(0.0, ++seed_), time_), parseSelection("[{id: off, point: [9999, 5]}]"));
  EXPECT_FALSE(refused.selected_now);
  EXPECT_FALSE(refused.selection_error.empty());
  EXPECT_EQ(refused.result.state, State::kTracking);
  EXPECT_LT(refused.selection_stamp, refused.header.stamp) << "the selection before goes on";
}

// The first images of a camera may be black.
TEST_P(FeatureSessionTest, SelectsTheFileInTheFirstImageThatShowsIt) {
  const std::string file = folder_.file("features.yaml");
  std::ofstream(file) << selectionText();
  FeatureSession session = this->session(file);
  const ProcessedFeatures black = session.process(*imageAt(cv::Mat(240, 320, CV_8UC1, cv::Scalar(0)), time_));
  EXPECT_FALSE(black.selected_now);
  EXPECT_FALSE(black.selection_error.empty());
  EXPECT_TRUE(next(session).selected_now);
  EXPECT_FALSE(next(session).selected_now);
  session.reset();
  EXPECT_FALSE(next(session).selected_now);
  EXPECT_TRUE(next(session).selection_stamp.isZero());
  EXPECT_EQ(next(session).result.state, State::kIdle);
  EXPECT_THROW(this->session(folder_.file("absent.yaml")), std::invalid_argument);
}

TEST_P(FeatureSessionTest, ForgetsWhenTimeBeginsAgainAndSelectsTheFileAgain) {
  const std::string file = folder_.file("features.yaml");
  std::ofstream(file) << selectionText();
  for (const bool with_file : {false, true}) {
    FeatureSession session = this->session(with_file ? file : "");
    select(session);
    if (with_file) {
      session.reset();
      session = this->session(file);
      next(session);
    }
    EXPECT_EQ(next(session).result.state, State::kTracking);
    time_ -= 100.0;
    session.clockJumpedBack();
    const ProcessedFeatures again = next(session);
    EXPECT_EQ(again.selected_now, with_file);
    EXPECT_EQ(again.selection_stamp, with_file ? again.header.stamp : ros::Time());
    EXPECT_EQ(again.result.state, with_file ? State::kTracking : State::kIdle);
    EXPECT_EQ(again.result.reason, with_file ? "" : "time jumped back");
    EXPECT_EQ(next(session).result.reason, with_file ? "" : "time jumped back");
  }
}

TEST_P(FeatureSessionTest, RefusesSingleImagesThatAreNoneOfTheSequence) {
  FeatureSession session = this->session();
  select(session);
  EXPECT_THROW(session.process(*imageAt(featureScene(0.0, ++seed_), time_)), ImageError);
  EXPECT_THROW(session.process(*imageAt(featureScene(0.0, ++seed_), time_ - 50.0)), ImageError);
  const cv::Mat colour(240, 320, CV_8UC3, cv::Scalar::all(90)), small(120, 160, CV_8UC1, cv::Scalar(90));
  EXPECT_THROW(session.process(*imageAt(colour, time_ + 0.01)), ImageError);
  EXPECT_THROW(session.process(*imageAt(small, time_ + 0.02)), ImageError);
  sensor_msgs::Image bayer = *imageAt(featureScene(0.0, ++seed_), time_ + 0.03);
  bayer.encoding = "bayer_rggb8";
  EXPECT_THROW(session.process(bayer), ImageError);
  EXPECT_EQ(next(session).result.state, State::kTracking);
}

TEST_P(FeatureSessionTest, TellsThatNothingWasSeenInAnImageThatItRefused) {
  FeatureSession session = this->session();
  EXPECT_EQ(session.notSeen({}, "why").result.state, State::kIdle);
  const ProcessedFeatures selected = select(session);
  std_msgs::Header header;
  header.stamp = ros::Time(time_ + 0.01);
  const ProcessedFeatures not_seen = session.notSeen(header, "of another size");
  EXPECT_EQ(not_seen.header.stamp, header.stamp);
  EXPECT_EQ(not_seen.selection_stamp, selected.header.stamp);
  EXPECT_EQ(not_seen.result.state, State::kSearching);
  ASSERT_EQ(not_seen.result.features.size(), 2u);
  for (const features::TrackedFeature& feature : not_seen.result.features) {
    EXPECT_EQ(feature.state, State::kSearching);
    EXPECT_EQ(feature.reason, "of another size");
    EXPECT_TRUE(std::isinf(feature.expected_error));
  }
  EXPECT_EQ(next(session).result.state, State::kTracking) << "the session is unchanged";
}

TEST_P(FeatureSessionTest, EndsWithAnotherCamera) {
  FeatureSession session = this->session();
  select(session);
  const cv::Mat small(120, 160, CV_8UC1, cv::Scalar(90));
  for (int k = 0; k < 2; ++k) EXPECT_THROW(session.process(*imageAt(small, time_ += kPeriod)), ImageError);
  const ProcessedFeatures other = session.process(*imageAt(small, time_ += kPeriod));
  EXPECT_EQ(other.result.state, State::kIdle);
  EXPECT_NE(other.result.reason.find("another size or type"), std::string::npos) << other.result.reason;
}

TEST_P(FeatureSessionTest, BelievesNoFrozenFeed) {
  FeatureSession session = this->session();
  select(session);
  const cv::Mat frozen = featureScene(0.0, ++seed_);
  ProcessedFeatures processed;
  for (int k = 0; k < 4; ++k) processed = session.process(*imageAt(frozen, time_ += kPeriod));
  EXPECT_EQ(processed.result.state, State::kSearching);
  EXPECT_NE(processed.result.reason.find("the picture repeats"), std::string::npos) << processed.result.reason;
  for (const features::TrackedFeature& feature : processed.result.features) {
    EXPECT_EQ(feature.state, State::kSearching);
    EXPECT_TRUE(std::isinf(feature.expected_error));
    EXPECT_TRUE(std::isinf(feature.covariance(0, 0)));
  }
  // The tracker has lost nothing.
  for (int k = 0; k < 3; ++k) processed = next(session);
  EXPECT_EQ(processed.result.state, State::kTracking) << processed.result.reason;
}

TEST_P(FeatureSessionTest, SearchesWhatIsCovered) {
  FeatureSession session = this->session();
  select(session);
  EXPECT_EQ(session.process(*imageAt(coveredScene(++seed_), time_ += kPeriod)).result.state, State::kSearching);
}

TEST_P(FeatureSessionTest, TellsWhyThereAreNoIntrinsics) {
  FeatureSession session = this->session();
  EXPECT_NE(next(session).camera_error.find("no camera_info"), std::string::npos);
  session.setCameraInfo(featureCamera());
  EXPECT_EQ(next(session).camera_error, "");
}

TEST(FeatureSession, TakesNoFileForATrackerThatFindsByItself) {
  FeatureInput input;
  std::vector<std::string> errors;
  auto tracker = makeFeatureTracker("instrument", {}, "", input, errors);
  input.selection = "/tmp/features.yaml";
  try {
    const FeatureSession session(input, std::move(tracker));
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "selection = /tmp/features.yaml, expected none: nothing is to be selected");
  }
}

// Motion is told without a selection, and of a region where one is selected.
TEST(FeatureSession, TakesAFileForATrackerThatNeedsNone) {
  const test_support::TemporaryFolder folder;
  FeatureInput input;
  std::vector<std::string> errors;
  auto tracker = makeFeatureTracker("motion", {}, "", input, errors);
  ASSERT_TRUE(tracker->findsByItself());
  input.selection = folder.file("features.yaml");
  std::ofstream(input.selection) << "- {id: liver, motion: [[60, 40], [260, 200]]}\n";
  FeatureSession session(input, std::move(tracker));
  const ProcessedFeatures first = session.process(*imageAt(featureScene(0.0, 1), 1000.0));
  EXPECT_TRUE(first.selected_now) << first.selection_error;
  EXPECT_EQ(session.process(*imageAt(featureScene(1.0, 2), 1000.04)).result.features.at(0).id, "liver");
}

INSTANTIATE_TEST_SUITE_P(All, FeatureSessionTest, testing::Values("dots", "edges"));

}  // namespace
}  // namespace laparoscope_servo
