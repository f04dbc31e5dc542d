// The tracker nodelet in a manager that it shares with others.
#include <gtest/gtest.h>
#include <laparoscope_servo/TrackerState.h>
#include <ros/topic.h>

#include <cmath>
#include <limits>
#include <mutex>

#include "camera_bench.h"
#include "second_publisher.h"

namespace laparoscope_servo {
namespace {

using test_support::CameraBench;
using test_support::DiagnosticsListener;
using test_support::Inbox;
using test_support::waitFor;

const geometry::Rectangle kRoi{100.0, 70.0, 100.0, 90.0};
constexpr double kFocalLength = 300.0;  // px

class TrackerNodelet : public testing::Test {
 protected:
  // Connections take longer than the tests: one bench for all of them.
  static CameraBench& left() {
    static CameraBench bench("left");
    return bench;
  }
  static CameraBench& right() {
    static CameraBench bench("right");
    return bench;
  }

  void SetUp() override {
    ASSERT_TRUE(left().ready());
    ASSERT_TRUE(left().reset());
    left().publishInfo(0.0);  // no camera left over from the test before
    left().homographies.clear();
    left().task_errors.clear();
  }

  // Stamps of all tests go up, so that only those tests see time jump that want to.
  static ros::Time nextStamp() {
    static ros::Time stamp(1000, 123456789);
    stamp += ros::Duration(0.04);
    return stamp;
  }

  // Selects a ROI in `image` while the camera runs.
  SelectRoiResponse selectWhileRunning(const cv::Mat& image, const geometry::Rectangle& roi) {
    auto answer = left().select(roi);
    while (answer.wait_for(std::chrono::milliseconds(5)) != std::future_status::ready) {
      if (!left().track(image, nextStamp())) break;
    }
    return answer.get();
  }

  // Images until one is not refused.
  static HomographyConstPtr trackUntilAnswered(CameraBench& camera, const cv::Mat& image,
                                               const std::function<ros::Time()>& next_stamp = nextStamp) {
    HomographyConstPtr answer;
    waitFor([&] {
      const ros::Time stamp = next_stamp();
      camera.send(image, stamp);
      return waitFor([&] { return (answer = camera.homographies.at(stamp)) != nullptr; }, 0.3);
    });
    return answer;
  }

  // Camera info and images come over two connections: an image after which it has arrived.
  bool trackUntilIntrinsics(bool there) {
    return waitFor([&] {
      const HomographyConstPtr homography = left().track(image_, nextStamp());
      return homography && static_cast<bool>(homography->has_intrinsics) == there;
    });
  }

  const cv::Mat image_ = test_support::texture(cv::Size(320, 240));
};

TEST_F(TrackerNodelet, AnswersEveryImageWithItsHeaderAlsoWhileIdle) {
  const ros::Time stamp = nextStamp();
  const HomographyConstPtr homography = left().track(image_, stamp);
  ASSERT_TRUE(homography);
  EXPECT_EQ(homography->header.stamp, stamp);
  EXPECT_EQ(homography->header.frame_id, "optical_of_the_test");
  EXPECT_EQ(homography->state, Homography::IDLE);
  const TaskErrorConstPtr error = left().task_errors.waitFor(stamp);
  ASSERT_TRUE(error);
  EXPECT_FALSE(error->valid);
  EXPECT_EQ(error->header.frame_id, "optical_of_the_test");
}

// They come while the tracker is at work, as after a stall of the camera or of this machine. With their stamps' period
// the tracker has time for them on any machine.
TEST_F(TrackerNodelet, ProcessesImagesThatComeAtOnceInTheirOrder) {
  constexpr int kAtOnce = 4;
  ros::Time stamp = nextStamp() + ros::Duration(10.0);
  const auto next = [&stamp] { return stamp += ros::Duration(0.5); };
  ASSERT_TRUE(trackUntilAnswered(left(), image_, next)) << "the gap is believed";
  for (int turn = 0; turn < 5; ++turn) {
    std::vector<sensor_msgs::ImagePtr> messages;
    for (int k = 0; k < kAtOnce; ++k) messages.push_back(left().message(image_, next()));
    for (const auto& message : messages) left().publish(*message);
    for (const auto& message : messages)
      ASSERT_TRUE(left().homographies.waitFor(message->header.stamp)) << "turn " << turn;
  }
  trackUntilAnswered(left(), image_, [&stamp] { return stamp += ros::Duration(0.04); });
  while (nextStamp() < stamp) {
  }
}

TEST_F(TrackerNodelet, SelectsOnTheNextImageAndTracks) {
  const SelectRoiResponse answer = selectWhileRunning(image_, kRoi);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_NE(answer.message.find("100,70,100,90"), std::string::npos) << answer.message;
  const Eigen::Matrix3d g = test_support::motion(20, kRoi, 6.0)[1];
  const HomographyConstPtr homography = left().track(test_support::view(image_, g), nextStamp());
  ASSERT_TRUE(homography);
  EXPECT_EQ(homography->state, Homography::TRACKING);
  const geometry::Quadrilateral truth = geometry::apply(g, kRoi.corners());
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(homography->corners[2 * k], truth[k].x(), 0.5);
    EXPECT_NEAR(homography->corners[2 * k + 1], truth[k].y(), 0.5);
  }
  EXPECT_GT(homography->processing_time, 0.0);
}

TEST_F(TrackerNodelet, RefusesARoiThatCannotBeTracked) {
  for (const geometry::Rectangle& roi : {geometry::Rectangle{300.0, 70.0, 100.0, 90.0},
                                         geometry::Rectangle{10.0, 10.0, 4.0, 4.0}, geometry::Rectangle{}}) {
    const SelectRoiResponse answer = selectWhileRunning(image_, roi);
    EXPECT_FALSE(answer.success);
    EXPECT_NE(answer.message.find("ROI"), std::string::npos) << answer.message;
  }
  const SelectRoiResponse flat = selectWhileRunning(cv::Mat(240, 320, CV_8UC3, cv::Scalar(90, 90, 90)), kRoi);
  EXPECT_FALSE(flat.success);
  EXPECT_NE(flat.message.find("texture"), std::string::npos) << flat.message;
  EXPECT_EQ(left().track(image_, nextStamp())->state, Homography::IDLE);
}

TEST_F(TrackerNodelet, SaysSoWhenNoImageComesToSelectIn) {
  const SelectRoiResponse answer = left().select(kRoi).get();
  EXPECT_FALSE(answer.success);
  EXPECT_NE(answer.message.find("/left/image"), std::string::npos) << answer.message;
  EXPECT_NE(answer.message.find("select_timeout"), std::string::npos) << answer.message;
  // The request is gone: it does not select in the image that comes too late.
  EXPECT_EQ(left().track(image_, nextStamp())->state, Homography::IDLE);
}

TEST_F(TrackerNodelet, TheManagersOnlyThreadGoesOnWhileSelectWaits) {
  auto answer = left().select(kRoi);
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(300);
  while (std::chrono::steady_clock::now() < until) ASSERT_TRUE(left().reset());
  EXPECT_NE(answer.wait_for(std::chrono::seconds(0)), std::future_status::ready) << "the reset had to wait";
  EXPECT_FALSE(answer.get().success);
}

TEST_F(TrackerNodelet, SurvivesImagesOfEveryBadKind) {
  ASSERT_TRUE(selectWhileRunning(image_, kRoi).success);
  DiagnosticsListener diagnostics(left().node(), "left/tracker");
  const sensor_msgs::Image good = *cv_bridge::CvImage(CameraBench::header(nextStamp()), "bgr8", image_).toImageMsg();
  std::vector<sensor_msgs::Image> bad(8, good);
  bad[0].encoding = "bayer_rggb8";
  bad[1].encoding = "nonsense";
  bad[2].encoding.clear();
  bad[3].data.clear();
  bad[4].data.resize(good.data.size() / 2);
  bad[5].width = 0;
  bad[6].step = 1;
  bad[7].height = 4000000000u;
  for (const sensor_msgs::Image& image : bad) {
    left().publish(image);
    const HomographyConstPtr homography = left().track(image_, nextStamp());
    ASSERT_TRUE(homography) << image.encoding;
    EXPECT_EQ(homography->state, Homography::TRACKING);
  }
  EXPECT_FALSE(left().homographies.at(good.header.stamp)) << "a bad image is not answered";
  left().publish(bad[0]);
  EXPECT_TRUE(diagnostics.waitForMessage(diagnostic_msgs::DiagnosticStatus::ERROR, "image_proc")) << diagnostics.last();
}

TEST_F(TrackerNodelet, TellsTheClientWhatIsWrongWithTheImages) {
  auto answer = left().select(kRoi);
  sensor_msgs::Image bayer = *cv_bridge::CvImage(CameraBench::header(nextStamp()), "bgr8", image_).toImageMsg();
  bayer.encoding = "bayer_rggb8";
  while (answer.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) left().publish(bayer);
  const SelectRoiResponse response = answer.get();
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("image_proc"), std::string::npos) << response.message;
}

TEST_F(TrackerNodelet, RefusesAnOddSizeAndForgetsTheRoiWhenItLasts) {
  ASSERT_TRUE(selectWhileRunning(image_, kRoi).success);
  const cv::Mat other = test_support::texture(cv::Size(160, 120));
  const ros::Time stamp = nextStamp();
  left().send(other, stamp);
  const TaskErrorConstPtr error = left().task_errors.waitFor(stamp);
  ASSERT_TRUE(error) << "the scope goes on by the image before";
  EXPECT_FALSE(error->valid);
  EXPECT_EQ(left().track(image_, nextStamp())->state, Homography::TRACKING);
  for (int k = 0; k < 2; ++k) left().send(other, nextStamp());
  const HomographyConstPtr homography = trackUntilAnswered(left(), other);
  ASSERT_TRUE(homography);
  EXPECT_EQ(homography->state, Homography::IDLE);
  EXPECT_TRUE(selectWhileRunning(other, {40.0, 30.0, 60.0, 60.0}).success);
  ASSERT_TRUE(trackUntilAnswered(left(), image_)) << "the size of the other tests";
}

TEST_F(TrackerNodelet, HasATaskErrorOnlyWithUsableIntrinsics) {
  ASSERT_TRUE(selectWhileRunning(image_, kRoi).success);
  DiagnosticsListener diagnostics(left().node(), "left/tracker");
  for (const double bad : {0.0, std::numeric_limits<double>::quiet_NaN(), -1.0}) {
    left().publishInfo(kFocalLength);
    ASSERT_TRUE(trackUntilIntrinsics(true)) << "late, or again";
    left().publishInfo(bad);
    ASSERT_TRUE(trackUntilIntrinsics(false)) << bad;
    const ros::Time stamp = nextStamp();
    ASSERT_TRUE(left().track(image_, stamp));
    const TaskErrorConstPtr error = left().task_errors.waitFor(stamp);
    ASSERT_TRUE(error);
    EXPECT_FALSE(error->valid);
    EXPECT_EQ(error->e_v.x, 0.0);
  }
  EXPECT_TRUE(waitFor([&] {
    left().track(image_, nextStamp());
    return diagnostics.last().level == diagnostic_msgs::DiagnosticStatus::WARN &&
           diagnostics.last().message.find("focal") != std::string::npos;
  })) << diagnostics.last();
  left().publishInfo(kFocalLength);
  ASSERT_TRUE(trackUntilIntrinsics(true));
  const ros::Time stamp = nextStamp();
  const HomographyConstPtr homography = left().track(image_, stamp);
  ASSERT_TRUE(homography);
  const TaskErrorConstPtr error = left().task_errors.waitFor(stamp);
  ASSERT_TRUE(error);
  EXPECT_TRUE(error->valid);
  EXPECT_NEAR(error->m_star.x, (kRoi.centre().x() - 160.0) / kFocalLength, 1e-12);
}

TEST_F(TrackerNodelet, HasNoTaskErrorAfterTheIntrinsicsChangedUntilANewSelection) {
  left().publishInfo(kFocalLength);
  ASSERT_TRUE(trackUntilIntrinsics(true));
  ASSERT_TRUE(selectWhileRunning(image_, kRoi).success);
  left().publishInfo(1.5 * kFocalLength);
  ASSERT_TRUE(trackUntilIntrinsics(false));
  EXPECT_EQ(left().track(image_, nextStamp())->state, Homography::TRACKING);
  ASSERT_TRUE(selectWhileRunning(image_, kRoi).success);
  EXPECT_TRUE(trackUntilIntrinsics(true));
}

TEST_F(TrackerNodelet, RefusesIntrinsicsOfAnotherSize) {
  ASSERT_TRUE(selectWhileRunning(image_, kRoi).success);
  left().publishInfo(kFocalLength, 320, 240);
  ASSERT_TRUE(trackUntilIntrinsics(true));
  left().publishInfo(kFocalLength, 1920, 1080);
  EXPECT_TRUE(trackUntilIntrinsics(false));
}

TEST_F(TrackerNodelet, DropsImagesOfAnotherTimeAndKeepsTheRegion) {
  left().publishInfo(kFocalLength);
  ASSERT_TRUE(trackUntilIntrinsics(true));
  ASSERT_TRUE(selectWhileRunning(image_, kRoi).success);
  DiagnosticsListener diagnostics(left().node(), "left/tracker");
  const ros::Time last = nextStamp();
  ASSERT_TRUE(left().track(image_, last));
  const cv::Mat other = test_support::texture(cv::Size(320, 240), 5);
  for (const ros::Time& outlier :
       {ros::Time(500, 0), last - ros::Duration(0.005), ros::Time(0, 0), ros::Time::now() + ros::Duration(5.0)}) {
    left().send(other, outlier);
    const ros::Time stamp = nextStamp();
    const HomographyConstPtr homography = left().track(image_, stamp);
    ASSERT_TRUE(homography) << outlier;
    EXPECT_EQ(homography->state, Homography::TRACKING) << outlier;
    EXPECT_FALSE(left().homographies.at(outlier)) << "it is answered";
  }
  // The tracker's queue of one may have lost those of above to the images after them.
  int polls = 0;
  EXPECT_TRUE(waitFor([&] {
    if (++polls % 10 == 0) left().send(other, ros::Time(0, 0));
    for (const auto& entry : diagnostics.last().values) {
      if (entry.key == "images refused, by cause") return entry.value.find("stamp 0") == std::string::npos;
    }
    return false;
  }));
}

TEST_F(TrackerNodelet, HasNoTaskErrorOfPicturesThatRepeat) {
  left().publishInfo(kFocalLength);
  ASSERT_TRUE(trackUntilIntrinsics(true));
  ASSERT_TRUE(selectWhileRunning(image_, kRoi).success);
  DiagnosticsListener diagnostics(left().node(), "left/tracker");
  sensor_msgs::Image picture = *cv_bridge::CvImage(CameraBench::header(nextStamp()), "bgr8", image_).toImageMsg();
  for (int k = 0; k < 10; ++k) {
    picture.header.stamp = nextStamp();
    left().publish(picture);
    const HomographyConstPtr homography = left().homographies.waitFor(picture.header.stamp);
    const TaskErrorConstPtr error = left().task_errors.waitFor(picture.header.stamp);
    ASSERT_TRUE(homography && error) << k;
    if (k < 3) continue;
    EXPECT_EQ(homography->state, Homography::SEARCHING) << k;
    EXPECT_FALSE(error->valid) << k;
  }
  EXPECT_TRUE(diagnostics.waitForMessage(diagnostic_msgs::DiagnosticStatus::WARN, "the picture repeats"))
      << diagnostics.last();
  left().track(image_, nextStamp());
  const ros::Time stamp = nextStamp();
  EXPECT_EQ(left().track(image_, stamp)->state, Homography::TRACKING);
  EXPECT_TRUE(left().task_errors.waitFor(stamp)->valid);
}

TEST_F(TrackerNodelet, RefusesASecondPublisher) {
  ASSERT_TRUE(selectWhileRunning(image_, kRoi).success);
  DiagnosticsListener diagnostics(left().node(), "left/tracker");
  const test_support::SecondPublisher other("/left/image");
  bool named = false;
  EXPECT_TRUE(waitFor(
      [&] {
        // The other camera's image may take the place of this one in the queue of one.
        const ros::Time stamp = nextStamp();
        left().send(image_, stamp);
        HomographyConstPtr homography;
        waitFor([&] { return (homography = left().homographies.at(stamp)) != nullptr; }, 0.1);
        EXPECT_TRUE(!homography || homography->state == Homography::TRACKING);
        named =
            named || diagnostics.last().message.find("2 publishers of image: those of /rostopic") != std::string::npos;
        return named;
      },
      20.0))
      << diagnostics.last();
}

TEST_F(TrackerNodelet, SelectsTheParametersRoiByItselfAndFindsItAgainInALoop) {
  ASSERT_TRUE(right().ready());
  const HomographyConstPtr first = right().track(image_, ros::Time(2000, 7));
  ASSERT_TRUE(first);
  EXPECT_EQ(first->state, Homography::TRACKING);
  EXPECT_EQ(first->reference_stamp, ros::Time(2000, 7));
  const HomographyConstPtr second = right().track(image_, ros::Time(2001, 0));
  ASSERT_TRUE(second);
  EXPECT_EQ(second->reference_stamp, ros::Time(2000, 7));
  ros::Time stamp(1500, 3);
  HomographyConstPtr looped;
  EXPECT_TRUE(waitFor([&] {
    looped = trackUntilAnswered(right(), image_, [&] { return stamp += ros::Duration(0.04); });
    return looped && looped->state == Homography::TRACKING;
  }));
  EXPECT_EQ(looped->reference_stamp, ros::Time(2000, 7)) << "it is the same region";
}

TEST_F(TrackerNodelet, TwoInOneManagerDoNotMeet) {
  ASSERT_TRUE(right().ready());
  // One image confirms a pause; a queue of one may lose it.
  ros::Time stamp(3000, 0);
  ASSERT_TRUE(trackUntilAnswered(right(), image_, [&] { return stamp += ros::Duration(0.04); }));
  EXPECT_EQ(left().track(image_, nextStamp())->state, Homography::IDLE);
  const HomographyConstPtr next = right().track(image_, stamp + ros::Duration(0.04));
  ASSERT_TRUE(next);
  EXPECT_EQ(next->state, Homography::TRACKING);
}

TEST_F(TrackerNodelet, DrawsForWhoListens) {
  ASSERT_TRUE(selectWhileRunning(image_, kRoi).success);
  Inbox<sensor_msgs::Image> overlays(left().node(), "tracker/overlay");
  Inbox<sensor_msgs::Image> masks(left().node(), "tracker/occlusion_mask");
  Inbox<AreaSelection> areas(left().node(), "tracker/areas");
  Inbox<geometry_msgs::PolygonStamped> rois(left().node(), "tracker/roi");
  // The publisher may learn of a listener later than the listener of it.
  ros::Time stamp;
  ASSERT_TRUE(waitFor([&] {
    stamp = nextStamp();
    left().track(image_, stamp);
    return waitFor([&] { return overlays.at(stamp) && masks.at(stamp) && areas.at(stamp) && rois.at(stamp); }, 0.2);
  }));
  EXPECT_EQ(overlays.at(stamp)->encoding, "bgr8");
  EXPECT_EQ(overlays.at(stamp)->width, 320u);
  EXPECT_EQ(overlays.at(stamp)->header.frame_id, "optical_of_the_test");
  EXPECT_EQ(masks.at(stamp)->encoding, "mono8");
  EXPECT_EQ(masks.at(stamp)->height, 240u);
  EXPECT_EQ(areas.at(stamp)->occluded.size(), 196u);
  EXPECT_EQ(rois.at(stamp)->polygon.points.size(), 4u);
}

TEST_F(TrackerNodelet, TellsPeopleItsState) {
  ros::NodeHandle& node = left().node();
  std::mutex mutex;
  TrackerState last;
  const ros::Subscriber states = node.subscribe<TrackerState>("tracker/state", 10, [&](const TrackerStateConstPtr& m) {
    const std::lock_guard<std::mutex> lock(mutex);
    last = *m;
  });
  const auto state = [&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return last;
  };
  const ros::Time stamp = nextStamp();
  ASSERT_TRUE(left().track(image_, stamp));
  EXPECT_TRUE(waitFor([&] { return state().state == TrackerState::IDLE && state().width == 320; })) << state();
  ASSERT_TRUE(selectWhileRunning(image_, kRoi).success);
  EXPECT_TRUE(waitFor([&] { return state().state == TrackerState::TRACKING; })) << state();
  EXPECT_EQ(state().region[0], 100.0);
  EXPECT_EQ(state().region[4], 199.0);
  // Nobody sends an image now.
  EXPECT_TRUE(waitFor([&] { return state().state == TrackerState::NO_IMAGE; })) << state();
  EXPECT_NE(state().reason.find("before: TRACKING"), std::string::npos) << state();
}

TEST_F(TrackerNodelet, ShowsAPreviewToWhoListens) {
  Inbox<sensor_msgs::Image> previews(left().node(), "tracker/preview");
  ros::Time stamp;
  ASSERT_TRUE(waitFor([&] {
    stamp = nextStamp();
    left().track(image_, stamp);
    return waitFor([&] { return previews.at(stamp) != nullptr; }, 0.2);
  }));
  EXPECT_EQ(previews.at(stamp)->encoding, "bgr8");
  EXPECT_EQ(previews.at(stamp)->width, 320u);
  EXPECT_EQ(previews.at(stamp)->header.frame_id, "optical_of_the_test");
}

TEST_F(TrackerNodelet, StandsAsideWithWrongParametersAndNamesThemAll) {
  DiagnosticsListener diagnostics(left().node(), "wrong/tracker");
  ASSERT_TRUE(diagnostics.waitForMessage(diagnostic_msgs::DiagnosticStatus::ERROR, "not started"))
      << diagnostics.last();
  const TrackerStateConstPtr state =
      ros::topic::waitForMessage<TrackerState>("/wrong/tracker/state", ros::Duration(20.0));
  ASSERT_TRUE(state) << "who comes later is told, too";
  EXPECT_EQ(state->state, TrackerState::NOT_STARTED);
  EXPECT_NE(state->reason.find("/wrong/tracker/roi"), std::string::npos) << state->reason;
  for (const char* part : {"/wrong/tracker/roi", "/wrong/tracker/tracking/esm/levels", "99", "lvels"}) {
    EXPECT_NE(diagnostics.last().message.find(part), std::string::npos) << part << ": " << diagnostics.last().message;
  }
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "tracker_nodelet_test");
}
