#include "ros/tracker/image_backlog.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

namespace laparoscope_servo {
namespace {

constexpr double kPeriod = 0.02;  // s

// A camera and a tracker with a queue between, in simulated time.
class Feed {
 public:
  explicit Feed(double duration) : duration_(duration) {}

  // The next images come, while the tracker does not run for `stall` s from the first one on.
  void run(int images, double stall = 0.0) {
    free_at_ = std::max(free_at_, now_ + stall);
    for (int k = 0; k < images; ++k) {
      work(now_);
      queue_.push_back(now_);
      if (queue_.size() > ImageBacklog::kQueue) queue_.pop_front();
      ++sent_;
      now_ += kPeriod;
    }
    work(now_ + 10.0);
    now_ = std::max(now_, free_at_);
  }
  int processed() const { return processed_; }
  int lost() const { return sent_ - processed_; }
  double longestWait() const { return longest_wait_; }

 private:
  void work(double until) {
    while (!queue_.empty() && std::max(free_at_, queue_.front()) < until) {
      const double begin = std::max(free_at_, queue_.front()), waited = begin - queue_.front();
      const ros::Time stamp(1000.0 + queue_.front());
      queue_.pop_front();
      if (!backlog_.takes(stamp, waited)) continue;
      ++processed_;
      longest_wait_ = std::max(longest_wait_, waited);
      free_at_ = begin + duration_;
      backlog_.took(duration_);
    }
  }

  ImageBacklog backlog_;
  double duration_;
  double now_ = 0.0, free_at_ = 0.0, longest_wait_ = 0.0;
  std::deque<double> queue_;
  int sent_ = 0, processed_ = 0;
};

TEST(ImageBacklog, AFastTrackerCatchesUpAfterAStallAndLosesNothing) {
  Feed feed(0.25 * kPeriod);
  feed.run(50);
  feed.run(50, 3.5 * kPeriod);
  EXPECT_EQ(feed.lost(), 0);
  EXPECT_GT(feed.longestWait(), 3.0 * kPeriod);
}

TEST(ImageBacklog, ImagesWithoutUsableStampsAreForWhoRefusesThem) {
  for (const ros::Time& stamp : {ros::Time(), ros::Time(1000.0), ros::Time(4294967295U, 0)}) {
    ImageBacklog backlog;
    for (int k = 0; k < 4; ++k) {
      EXPECT_TRUE(backlog.takes(stamp, 1e-4)) << stamp;
      backlog.took(1e-4);
    }
    EXPECT_NO_THROW(backlog.takes(ros::Time(1.0), 0.0));
    EXPECT_NO_THROW(backlog.takes(ros::Time(4294967295U, 0), 0.0));
  }
}

TEST(ImageBacklog, AlsoWhenTheFirstImagesComeAtOnce) {
  ImageBacklog backlog;
  for (int k = 0; k < 4; ++k) {
    EXPECT_TRUE(backlog.takes(ros::Time(1000.0 + k * kPeriod), 0.1));
    backlog.took(0.1 * kPeriod);
  }
}

TEST(ImageBacklog, ASlowTrackerTakesNoImageThatIsOlderThanAPeriod) {
  for (const double share : {0.7, 1.5, 2.5}) {
    Feed feed(share * kPeriod);
    feed.run(20);  // until it is known how slow it is
    Feed before = feed;
    feed.run(200, 5.0 * kPeriod);
    EXPECT_GT(feed.processed() - before.processed(), 0.8 * 195 / std::max(1.0, share)) << "it works all the time";
  }
  ImageBacklog backlog;
  for (int k = 0; k < 9; ++k) {
    backlog.takes(ros::Time(1000.0 + k * kPeriod), 0.0);
    backlog.took(0.8 * kPeriod);
  }
  EXPECT_TRUE(backlog.takes(ros::Time(1000.0 + 9 * kPeriod), 0.9 * kPeriod));
  EXPECT_FALSE(backlog.takes(ros::Time(1000.0 + 10 * kPeriod), 1.1 * kPeriod));
}

TEST(ImageBacklog, OneSlowImageAmongFastOnesDoesNotCount) {
  ImageBacklog backlog;
  for (int k = 0; k < 20; ++k) {
    backlog.takes(ros::Time(1000.0 + k * kPeriod), 0.0);
    backlog.took(k == 19 ? 5.0 * kPeriod : 0.2 * kPeriod);
  }
  EXPECT_TRUE(backlog.takes(ros::Time(1000.0 + 20 * kPeriod), 4.0 * kPeriod));
}

TEST(ImageBacklog, StampsThatStandStillOrJumpBackDoNotStopIt) {
  ImageBacklog backlog;
  for (const double stamp : {1000.0, 1000.0, 1000.02, 500.0, 500.02}) {
    EXPECT_TRUE(backlog.takes(ros::Time(stamp), 0.0));
    backlog.took(1.0);
  }
}

}  // namespace
}  // namespace laparoscope_servo
