// Views that are stored and recalled: a camera that slides along tissue, as the task error would have it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "ros/tracker/result_messages.h"
#include "ros/tracker/tracker_session.h"
#include "ros/tracker/view_library.h"
#include "support/error_text.h"
#include "support/stamped_header.h"
#include "support/synthetic_sequence.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo {
namespace {

using test_support::at;
using tracking::State;

const cv::Size kSize(320, 240);
const geometry::Rectangle kRoi{110.0, 75.0, 100.0, 90.0};
constexpr int kStep = 100;  // px between two views

class TrackerSessionViewsTest : public testing::Test {
 protected:
  void SetUp() override { camera(300.0); }

  void camera(double focal_length) {
    sensor_msgs::CameraInfo info;
    info.K = {focal_length, 0.0, 160.0, 0.0, focal_length, 120.0, 0.0, 0.0, 1.0};
    session_.setCameraInfo(info);
  }
  cv::Mat picture(const cv::Rect& window) { return test_support::noisy(scene_(window), random_); }
  Processed see(int x, const std::optional<geometry::Rectangle>& request = std::nullopt) {
    time_ += 0.04;
    return session_.process(picture(cv::Rect(cv::Point(x, 0), kSize)), at(time_), request);
  }
  std::string store(const std::string& name, const Processed& now) {
    return library_.store(name, session_.snapshot(now));
  }
  // A row of views, each with its region selected in the middle.
  void storeRow(int count) {
    for (int k = 0; k < count; ++k) store(std::string(1, static_cast<char>('a' + k)), see(kStep * k, kRoi));
  }
  std::string recall(const std::string& name, const Processed& now) {
    return session_.recall(library_.route(name, session_.snapshot(now)));
  }
  // Slides the camera by 5 px an image to where the task error vanishes; where it has come to.
  int drive(int x, int images) {
    for (int k = 0; k < images; ++k) {
      last_ = see(x);
      texts_.push_back(last_.recall);
      const TaskError error = taskErrorMessage(last_);
      if (!error.valid) continue;
      const double px = 300.0 * (error.x - error.desired_x);
      if (std::abs(px) >= 1.0) x += static_cast<int>(std::lround(std::clamp(px, -5.0, 5.0)));
    }
    return x;
  }

  cv::RNG random_{9};
  const cv::Mat scene_ = test::tissue(cv::Size(900, 240), 51);
  TrackerSession session_{TrackerParameters()};
  ViewLibrary library_{TrackerParameters()};
  Processed last_;
  std::vector<std::string> texts_;
  double time_ = 10.0;
};

TEST_F(TrackerSessionViewsTest, DrivesToAViewThatIsInTheImage) {
  storeRow(1);
  const Processed now = see(40);
  EXPECT_EQ(recall("a", now), "");
  EXPECT_EQ(drive(40, 30), 0);
  EXPECT_EQ(last_.recall, "arrived at view 'a'");
  EXPECT_EQ(last_.result.state, State::kTracking);
  EXPECT_NEAR(last_.reference_stamp.toSec(), 10.04, 1e-6);
}

TEST_F(TrackerSessionViewsTest, DrivesToAFarViewThroughThoseThatOverlap) {
  storeRow(4);
  const Processed now = see(290);
  EXPECT_EQ(routeText(library_.route("a", session_.snapshot(now))), "'c', 'b', 'a'");
  EXPECT_EQ(recall("a", now), "");
  EXPECT_EQ(drive(290, 120), 0);
  EXPECT_EQ(last_.recall, "arrived at view 'a'");
  std::vector<std::string> said;
  for (const std::string& text : texts_) {
    if (said.empty() || said.back() != text) said.push_back(text);
  }
  EXPECT_EQ(said, (std::vector<std::string>{"going to view 'a', now to 'c' (1 of 3)",
                                            "going to view 'a', now to 'b' (2 of 3)", "going to view 'a'",
                                            "arrived at view 'a'"}));
}

TEST_F(TrackerSessionViewsTest, StoresThePictureAsItIsWithTheRegionWhereItIs) {
  see(0, kRoi);
  Processed now;
  for (const int x : {4, 8, 12, 16, 20}) now = see(x);
  const Snapshot snapshot = session_.snapshot(now);
  ASSERT_TRUE(snapshot.roi) << snapshot.roi_error;
  EXPECT_NEAR(snapshot.roi->x, kRoi.x - 20.0, 1.0);
  EXPECT_NEAR(snapshot.roi->width, kRoi.width, 1.0);
  EXPECT_EQ(snapshot.stamp, now.header.stamp);
  EXPECT_EQ(cv::norm(snapshot.image, now.image, cv::NORM_INF), 0.0);
  EXPECT_NE(snapshot.image.data, now.image.data);
  EXPECT_EQ(store("here", now).find("stored view 'here' with ROI 90,75,100,90"), 0u);
}

TEST_F(TrackerSessionViewsTest, SaysFromWhereAViewIsReachedAndWhereItLeads) {
  EXPECT_EQ(store("a", see(0, kRoi)),
            "stored view 'a' with ROI 110,75,100,90; reached from no other, leads to no other");
  EXPECT_EQ(store("b", see(kStep, kRoi)), "stored view 'b' with ROI 110,75,100,90; reached from 'a', leads to 'a'");
  // A region at the far side: in the image of b, not in that of a; it sees theirs as b does.
  const geometry::Rectangle right{210.0, 75.0, 100.0, 90.0};
  EXPECT_EQ(store("c", see(kStep, right)),
            "stored view 'c' with ROI 210,75,100,90; reached from 'b', leads to 'a', 'b'");
}

TEST_F(TrackerSessionViewsTest, StoresNothingWhileItDoesNotTrackOrTheRegionIsCovered) {
  const Snapshot idle = session_.snapshot(see(0));
  EXPECT_FALSE(idle.roi);
  EXPECT_NE(idle.roi_error.find("IDLE"), std::string::npos) << idle.roi_error;
  EXPECT_THROW(library_.store("a", idle), std::invalid_argument);
  Processed covered = see(0, kRoi);
  covered.result.visible_fraction = 0.3;
  EXPECT_NE(session_.snapshot(covered).roi_error.find("visible fraction 0.3"), std::string::npos);
}

TEST_F(TrackerSessionViewsTest, SaysWhyAViewCannotBeReached) {
  storeRow(1);
  const auto why = [&](const std::string& name, int x) {
    return test_support::errorText<std::invalid_argument>([&] { recall(name, see(x)); });
  };
  EXPECT_EQ(why("a", 500), "no stored view overlaps with the present image");
  EXPECT_NE(why("b", 0).find("no view 'b' is stored"), std::string::npos);
  EXPECT_EQ(see(0).recall, "none");
}

TEST_F(TrackerSessionViewsTest, ASelectionEndsTheRecall) {
  storeRow(1);
  recall("a", see(40));
  EXPECT_EQ(see(40).recall, "going to view 'a'");
  random_ = cv::RNG(1);
  const Processed selected = see(40, kRoi);
  EXPECT_TRUE(selected.result.selected_now);
  EXPECT_EQ(selected.recall, "view 'a' given up: a region was selected");
  random_ = cv::RNG(1);  // the same picture, with its noise, for once
  EXPECT_EQ(see(40).result.g.isIdentity(1e-2), true);
  // One that is refused does not.
  recall("a", see(40));
  const Processed refused = see(40, geometry::Rectangle{300.0, 200.0, 100.0, 100.0});
  EXPECT_NE(refused.selection_error, "");
  EXPECT_EQ(refused.recall, "going to view 'a'");
}

TEST_F(TrackerSessionViewsTest, AResetEndsTheRecallAndKeepsTheViews) {
  storeRow(1);
  recall("a", see(40));
  see(40);
  session_.reset();
  const Processed now = see(40);
  EXPECT_EQ(now.result.state, State::kIdle);
  EXPECT_EQ(now.recall, "view 'a' given up: the tracker was reset");
  // From IDLE, too.
  EXPECT_EQ(recall("a", now), "");
  EXPECT_EQ(drive(40, 30), 0);
}

TEST_F(TrackerSessionViewsTest, ARecallThatWasPlannedBeforeAResetOrASelectionDoesNotBegin) {
  storeRow(1);
  RecallRoute route = library_.route("a", session_.snapshot(see(40)));
  session_.reset();
  EXPECT_NE(session_.recall(route), "");
  EXPECT_EQ(see(40).result.state, State::kIdle);
  route = library_.route("a", session_.snapshot(see(40)));
  see(40, kRoi);
  EXPECT_NE(session_.recall(route), "");
  EXPECT_NE(session_.recall(RecallRoute()), "");
  EXPECT_EQ(see(40).result.state, State::kTracking);
}

TEST_F(TrackerSessionViewsTest, TimeThatJumpsBackEndsTheRecall) {
  storeRow(1);
  recall("a", see(40));
  see(40);
  time_ = 5.0;
  session_.clockJumpedBack();
  EXPECT_EQ(see(40).result.state, State::kSearching);
  EXPECT_EQ(see(40).recall, "view 'a' given up: time jumped back");
  recall("a", see(40));
  time_ = 2.0;  // before the view has become the reference
  session_.clockJumpedBack();
  EXPECT_EQ(see(40).result.state, State::kSearching);
  EXPECT_EQ(see(40).recall, "view 'a' given up: time jumped back");
}

TEST_F(TrackerSessionViewsTest, ImagesOfAnotherSizeEndTheRecall) {
  storeRow(1);
  recall("a", see(40));
  const cv::Rect smaller(0, 0, 300, 240);
  for (int k = 0; k < 2; ++k) EXPECT_THROW(session_.process(picture(smaller), at(time_ += 0.04)), ImageError);
  const Processed other = session_.process(picture(smaller), at(time_ += 0.04));
  EXPECT_EQ(other.result.state, State::kIdle);
  EXPECT_EQ(other.recall.find("view 'a' given up: image size changed"), 0u) << other.recall;
}

TEST_F(TrackerSessionViewsTest, ARegionThatIsLostOnTheWayLeavesNoTaskError) {
  storeRow(1);
  recall("a", see(40));
  Processed now;
  for (int k = 0; k < 70; ++k) {
    now = see(500);
    EXPECT_FALSE(taskErrorMessage(now).valid);
  }
  EXPECT_EQ(now.result.state, State::kLost);
  EXPECT_EQ(now.recall, "going to view 'a'");
  EXPECT_EQ(drive(40, 30), 0);
}

TEST_F(TrackerSessionViewsTest, AnotherCameraForgetsTheViews) {
  storeRow(2);
  camera(400.0);
  const Processed now = see(40, kRoi);
  try {
    recall("a", now);
    ADD_FAILURE() << "recalled a view of another camera";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("calibration changed"), std::string::npos) << error.what();
  }
  store("c", now);
  EXPECT_EQ(library_.views().names(), std::vector<std::string>{"c"});
}

TEST_F(TrackerSessionViewsTest, IntrinsicsThatChangeOnTheWayTakeTheTaskErrorAway) {
  storeRow(3);
  recall("a", see(190));
  drive(190, 10);
  ASSERT_TRUE(last_.camera);
  camera(400.0);
  int x = 190;
  while (x > 100) see(x -= 5);  // to the view on the way by other means
  drive(x, 10);
  EXPECT_EQ(last_.recall, "going to view 'a'");
  EXPECT_EQ(last_.result.state, State::kTracking);
  EXPECT_FALSE(last_.camera);
  EXPECT_FALSE(taskErrorMessage(last_).valid);
}

}  // namespace
}  // namespace laparoscope_servo
