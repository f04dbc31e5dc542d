#include "ros/tracker/view_recall.h"

#include <gtest/gtest.h>

namespace laparoscope_servo {
namespace {

using tracking::State;

const geometry::Rectangle kRoi{100.0, 70.0, 101.0, 91.0};

// The region `dx` px beside its place and `scale` times as large.
tracking::TrackResult at(double dx, double scale = 1.0, State state = State::kTracking) {
  tracking::TrackResult result;
  result.state = state;
  result.roi = kRoi;
  const Eigen::Vector2d centre = kRoi.centre();
  result.g << scale, 0.0, (1.0 - scale) * centre.x() + dx, 0.0, scale, (1.0 - scale) * centre.y(), 0.0, 0.0, 1.0;
  return result;
}

tracking::ViewConfig config() {
  tracking::ViewConfig config;
  config.arrival_centre = 10.0;
  config.arrival_scale = 0.1;
  return config;
}

std::vector<RecallStep> steps(const std::vector<std::string>& names) {
  std::vector<RecallStep> result;
  for (const std::string& name : names) result.push_back({name, {}, ros::Time(1.0)});
  return result;
}

TEST(HasArrivedTest, JudgesCentreAndScaleWhileTracking) {
  EXPECT_TRUE(hasArrived(at(0.0), config()));
  EXPECT_TRUE(hasArrived(at(-9.9, 1.09), config()));
  EXPECT_FALSE(hasArrived(at(-10.1), config()));
  EXPECT_FALSE(hasArrived(at(0.0, 1.11), config()));
  EXPECT_FALSE(hasArrived(at(0.0, 0.89), config()));
  for (const State state : {State::kIdle, State::kSearching, State::kLost}) {
    EXPECT_FALSE(hasArrived(at(0.0, 1.0, state), config()));
  }
  tracking::TrackResult nonsense = at(0.0);
  nonsense.g.row(2).setZero();
  EXPECT_FALSE(hasArrived(nonsense, config()));
}

TEST(ViewRecallTest, GoesFromViewToView) {
  ViewRecall recall(config());
  EXPECT_FALSE(recall.active());
  EXPECT_EQ(recall.due(), nullptr);
  EXPECT_EQ(recall.text(), "none");
  recall.begin(steps({"a", "b"}));
  ASSERT_NE(recall.due(), nullptr);
  EXPECT_EQ(recall.due()->name, "a");
  EXPECT_TRUE(recall.first());
  // What was tracked before says nothing of the view that is due.
  recall.see(at(0.0));
  EXPECT_EQ(recall.due()->name, "a");
  recall.taken();
  EXPECT_EQ(recall.due(), nullptr);
  recall.see(at(50.0));
  recall.see(at(0.0, 1.0, State::kSearching));
  EXPECT_EQ(recall.due(), nullptr);
  EXPECT_EQ(recall.text(), "going to view 'b', now to 'a' (1 of 2)");
  recall.see(at(5.0));
  ASSERT_NE(recall.due(), nullptr);
  EXPECT_EQ(recall.due()->name, "b");
  EXPECT_FALSE(recall.first());
  EXPECT_EQ(recall.text(), "going to view 'b'");
  recall.taken();
  recall.see(at(5.0));
  EXPECT_EQ(recall.due(), nullptr);
  EXPECT_EQ(recall.text(), "arrived at view 'b'");
  // It stays the reference, whatever comes.
  recall.see(at(50.0));
  EXPECT_TRUE(recall.active());
  EXPECT_EQ(recall.text(), "arrived at view 'b'");
}

TEST(ViewRecallTest, EndsAndMayBeginAgain) {
  ViewRecall recall(config());
  recall.end("nothing to end");
  EXPECT_EQ(recall.text(), "none");
  recall.begin(steps({"a", "b"}));
  recall.end("because");
  EXPECT_FALSE(recall.active());
  EXPECT_EQ(recall.due(), nullptr);
  EXPECT_EQ(recall.text(), "view 'b' given up: because");
  recall.see(at(0.0));
  EXPECT_EQ(recall.due(), nullptr);
  recall.begin(steps({"c"}));
  EXPECT_EQ(recall.due()->name, "c");
  EXPECT_EQ(recall.text(), "going to view 'c'");
}

}  // namespace
}  // namespace laparoscope_servo
