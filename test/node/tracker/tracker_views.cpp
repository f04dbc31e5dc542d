// The services of stored views: a camera that slides along tissue by the task error, through views that overlap.
#include <gtest/gtest.h>
#include <laparoscope_servo/ListViews.h>
#include <laparoscope_servo/TrackerState.h>

#include <algorithm>
#include <cmath>

#include "camera_bench.h"

namespace laparoscope_servo {
namespace {

using test_support::CameraBench;
using test_support::DiagnosticsListener;
using test_support::waitFor;

const geometry::Rectangle kRoi{110.0, 75.0, 100.0, 90.0};
constexpr double kFocalLength = 300.0;  // px
constexpr int kStep = 100;              // px between two views: the first and the third do not overlap

class TrackerViews : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(bench_.ready());
    bench_.publishInfo(kFocalLength);
    ASSERT_TRUE(waitFor([&] {
      const HomographyConstPtr homography = see(0);
      return homography && homography->has_intrinsics;
    }));
  }

  HomographyConstPtr see(int x) {
    stamp_ += ros::Duration(0.04);
    return bench_.track(scene_(cv::Rect(x, 0, 320, 240)), stamp_);
  }
  // Images come until the service has answered.
  template <class Response>
  Response answer(std::future<Response> future, int x) {
    while (future.wait_for(std::chrono::seconds(0)) != std::future_status::ready) see(x);
    return future.get();
  }
  void select(int x) {
    const SelectRoiResponse response = answer(bench_.select(kRoi), x);
    ASSERT_TRUE(response.success) << response.message;
  }
  StoredViewResponse ask(const std::string& service, const std::string& name, int x) {
    return answer(bench_.askForView(service, name), x);
  }
  // Where the task error leads to.
  int drive(int x, int images) {
    for (int k = 0; k < images; ++k) {
      see(x);
      const TaskErrorConstPtr error = bench_.task_errors.waitFor(stamp_);
      if (!error || !error->valid) continue;
      const double px = kFocalLength * (error->x - error->desired_x);
      if (std::abs(px) >= 1.0) x += static_cast<int>(std::lround(std::clamp(px, -5.0, 5.0)));
    }
    return x;
  }

  CameraBench bench_{"/"};
  DiagnosticsListener diagnostics_{bench_.node(), "tracker"};
  const cv::Mat scene_ = test_support::texture(cv::Size(900, 240));
  static inline ros::Time stamp_{1000, 0};  // the tracker is the same for all tests
};

TEST_F(TrackerViews, AreStoredAndReachedThroughOthersThatOverlap) {
  EXPECT_FALSE(ask("store_view", "a", 0).success);  // nothing is tracked
  for (const std::string name : {"a", "b", "c"}) {
    const int x = kStep * (name[0] - 'a');
    select(x);
    const StoredViewResponse stored = ask("store_view", name, x);
    ASSERT_TRUE(stored.success) << stored.message;
    EXPECT_NE(stored.message.find("'" + name + "' with ROI 110,75,100,90"), std::string::npos) << stored.message;
  }
  ListViewsRequest wanted;
  wanted.thumbnails = 1;
  const ListViewsResponse listed = bench_.ask<ListViews>("list_views", wanted).get();  // without an image
  ASSERT_EQ(listed.views.size(), 3u);
  EXPECT_EQ(listed.views[0].name, "a");
  EXPECT_EQ(listed.views[0].leads_to, std::vector<std::string>{"b"});
  EXPECT_EQ(listed.views[1].roi.x_offset, 110u);
  EXPECT_EQ(listed.views[1].width, 320u);
  EXPECT_EQ(listed.views[1].thumbnail.width, 160u);
  EXPECT_EQ(listed.views[1].thumbnail.height, 120u);
  EXPECT_LT(listed.views[0].stamp, listed.views[1].stamp);
  wanted.thumbnails = 0;
  EXPECT_TRUE(bench_.ask<ListViews>("list_views", wanted).get().views.at(0).thumbnail.data.empty());

  const StoredViewResponse unnamed = ask("store_view", "", 200);
  EXPECT_FALSE(unnamed.success);
  EXPECT_NE(unnamed.message.find("name"), std::string::npos) << unnamed.message;

  const StoredViewResponse recalled = ask("recall_view", "a", 200);
  ASSERT_TRUE(recalled.success) << recalled.message;
  EXPECT_EQ(recalled.message, "going by 'b', 'a'");
  EXPECT_EQ(drive(200, 80), 0);
  EXPECT_TRUE(diagnostics_.waitForMessage(diagnostic_msgs::DiagnosticStatus::OK, "arrived at view 'a'"))
      << diagnostics_.last();

  const StoredViewResponse unknown = ask("recall_view", "d", 0);
  EXPECT_FALSE(unknown.success);
  EXPECT_NE(unknown.message.find("expected one of 'a', 'b', 'c'"), std::string::npos) << unknown.message;
  const StoredViewResponse elsewhere = ask("recall_view", "a", 550);
  EXPECT_FALSE(elsewhere.success);
  EXPECT_EQ(elsewhere.message, "no stored view overlaps with the present image");

  EXPECT_TRUE(ask("recall_view", "c", 100).success);
  select(100);
  EXPECT_EQ(drive(100, 20), 100);
}

sensor_msgs::RegionOfInterest message(const geometry::Rectangle& roi) {
  sensor_msgs::RegionOfInterest result;
  result.x_offset = static_cast<std::uint32_t>(roi.x);
  result.y_offset = static_cast<std::uint32_t>(roi.y);
  result.width = static_cast<std::uint32_t>(roi.width);
  result.height = static_cast<std::uint32_t>(roi.height);
  return result;
}

TEST_F(TrackerViews, ARegionIsCheckedWithoutBeingSelected) {
  ASSERT_TRUE(bench_.reset());
  CheckRoiRequest request;
  request.roi = message(kRoi);
  EXPECT_TRUE(answer(bench_.ask<CheckRoi>("check_roi", request), 0).success);
  request.roi.x_offset = 300;
  const CheckRoiResponse refused = answer(bench_.ask<CheckRoi>("check_roi", request), 0);
  EXPECT_FALSE(refused.success);
  EXPECT_NE(refused.message.find("not inside the image"), std::string::npos) << refused.message;
  EXPECT_EQ(see(0)->state, Homography::IDLE) << "nothing was selected";
}

TEST_F(TrackerViews, ARegionOfAFrozenPictureIsFoundInTheLiveOne) {
  ASSERT_TRUE(bench_.reset());
  const FreezeImageResponse frozen = answer(bench_.ask<FreezeImage>("freeze_image", {}), 100);
  ASSERT_TRUE(frozen.success) << frozen.message;
  EXPECT_EQ(frozen.width, 320u);
  EXPECT_EQ(frozen.preview.width, 320u);
  CheckRoiRequest request;
  request.roi = message(kRoi);
  request.stamp = frozen.preview.header.stamp;
  EXPECT_TRUE(bench_.ask<CheckRoi>("check_roi", request).get().success) << "needs no image";
  // The camera has gone on by 20 px meanwhile.
  const CheckRoiResponse selected = answer(bench_.ask<CheckRoi>("select_frozen_roi", request), 120);
  ASSERT_TRUE(selected.success) << selected.message;
  HomographyConstPtr result;
  EXPECT_TRUE(waitFor([&] {
    result = see(120);
    return result && result->state == Homography::TRACKING;
  }));
  EXPECT_EQ(result->reference_stamp, request.stamp);
  EXPECT_NEAR(result->corners[0], kRoi.x - 20.0, 0.5);
  EXPECT_EQ(drive(120, 20), 100) << "the scope returns to where the picture was frozen";

  request.stamp += ros::Duration(1.0);
  const CheckRoiResponse other = answer(bench_.ask<CheckRoi>("select_frozen_roi", request), 100);
  EXPECT_FALSE(other.success);
  EXPECT_NE(other.message.find("another one was frozen"), std::string::npos) << other.message;
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "tracker_views_test");
}
