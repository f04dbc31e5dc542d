// The tracker as a node of its own: the same numbers as the offline tool's, and its refusal to start.
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "camera_bench.h"
#include "ros/playback/tracker_offline.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

using test_support::CameraBench;

const geometry::Rectangle kRoi{100.0, 70.0, 100.0, 90.0};

// An instrument crosses while the camera moves, so that gates and states have something to do.
std::vector<cv::Mat> sequence() {
  const cv::Mat texture = test_support::texture(cv::Size(320, 240));
  std::vector<cv::Mat> images;
  for (const Eigen::Matrix3d& g : test_support::motion(25, kRoi, 8.0)) {
    images.push_back(test_support::view(texture, g));
    const int left = 10 * static_cast<int>(images.size()) - 40;
    cv::rectangle(images.back(), cv::Rect(left, 0, 40, 240), cv::Scalar(120, 120, 120), cv::FILLED);
  }
  return images;
}

TEST(TrackerNode, GivesTheSameNumbersAsTheOfflineTool) {
  const test_support::TemporaryFolder folder;
  CameraBench bench("/");
  ASSERT_TRUE(bench.ready());
  const std::vector<cv::Mat> images = sequence();
  std::vector<HomographyConstPtr> online;
  {
    rosbag::Bag bag(folder.file("in.bag"), rosbag::bagmode::Write);
    for (std::size_t k = 0; k < images.size(); ++k) {
      const ros::Time stamp = ros::Time(1600000000, 123456789) + ros::Duration(0, 40000000 * static_cast<int>(k));
      const sensor_msgs::ImagePtr image =
          cv_bridge::CvImage(CameraBench::header(stamp), "bgr8", images[k]).toImageMsg();
      bench.publish(*image);
      online.push_back(bench.homographies.waitFor(stamp));
      ASSERT_TRUE(online.back()) << k;
      bag.write("/image", stamp, *image);
    }
  }
  OfflineOptions options;
  options.inputs = {folder.file("in.bag")};
  options.bag = folder.file("out.bag");
  options.parameters.roi = kRoi;
  trackOffline(
      options, [](const OfflineSummary&, std::size_t) {}, [](std::size_t, const std::string&) {});
  rosbag::Bag out(options.bag);
  std::size_t count = 0;
  for (const rosbag::MessageInstance& instance : rosbag::View(out, rosbag::TopicQuery("/tracker/homography"))) {
    const HomographyConstPtr offline = instance.instantiate<Homography>();
    ASSERT_LT(count, online.size());
    EXPECT_EQ(offline->header.stamp, online[count]->header.stamp);
    EXPECT_EQ(offline->state, online[count]->state);
    EXPECT_EQ(offline->g, online[count]->g) << count;
    EXPECT_EQ(offline->zncc, online[count]->zncc);
    EXPECT_EQ(offline->visible_fraction, online[count]->visible_fraction);
    ++count;
  }
  EXPECT_EQ(count, images.size());
  EXPECT_EQ(online[5]->state, Homography::TRACKING);
  EXPECT_NE(online[5]->g, online[0]->g);
}

TEST(TrackerNode, RefusesToStartWithWrongParameters) {
  const int status = std::system("rosrun laparoscope_servo tracker __name:=refused _select_timeout:=-1 _roi:=nonsense");
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1);
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runTests(argc, argv, "tracker_node_test");
}
