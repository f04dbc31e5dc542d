#include "ros/recording/image_encoders.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <opencv2/imgcodecs.hpp>

#include "ros/tracker/image_conversion.h"
#include "ros/tracker/result_messages.h"

namespace laparoscope_servo {
namespace {

sensor_msgs::ImagePtr picture(int type, int grey) {
  std_msgs::Header header;
  header.stamp = ros::Time(5, 6);
  header.frame_id = "scope";
  return imageMessage(header, cv::Mat(48, 64, type, cv::Scalar::all(grey)));
}

TEST(Compressed, IsNamedAsTheTransportsPluginNamesIt) {
  const auto colour = compressed(*picture(CV_8UC3, 100), 90);
  EXPECT_EQ(colour->format, "bgr8; jpeg compressed bgr8");
  EXPECT_EQ(colour->header.stamp, ros::Time(5, 6));
  EXPECT_EQ(colour->header.frame_id, "scope");
  const cv::Mat decoded = cv::imdecode(colour->data, cv::IMREAD_UNCHANGED);
  EXPECT_EQ(decoded.type(), CV_8UC3);
  EXPECT_NEAR(decoded.at<cv::Vec3b>(20, 20)[0], 100, 2);
  const auto grey = compressed(*picture(CV_8UC1, 100), 90);
  EXPECT_EQ(grey->format, "mono8; jpeg compressed ");
  EXPECT_EQ(cv::imdecode(grey->data, cv::IMREAD_UNCHANGED).type(), CV_8UC1);
}

TEST(ImageEncoders, DropAndCountWhatNoneIsFreeFor) {
  std::promise<void> may_go_on;
  const std::shared_future<void> gate = may_go_on.get_future().share();
  std::promise<void> started;
  std::atomic<int> done{0};
  std::atomic<bool> first{true};
  {
    ImageEncoders encoders(1, 2, 90, [&](const sensor_msgs::CompressedImagePtr& image, const ros::Time& time) {
      if (first.exchange(false)) started.set_value();
      gate.wait();
      EXPECT_FALSE(image->data.empty());
      EXPECT_EQ(time, ros::Time(7, 0));
      ++done;
    });
    EXPECT_TRUE(encoders.add(picture(CV_8UC3, 1), ros::Time(7, 0)));
    started.get_future().wait();
    EXPECT_TRUE(encoders.add(picture(CV_8UC3, 2), ros::Time(7, 0)));
    EXPECT_TRUE(encoders.add(picture(CV_8UC3, 3), ros::Time(7, 0)));
    EXPECT_FALSE(encoders.add(picture(CV_8UC3, 4), ros::Time(7, 0)));
    EXPECT_EQ(encoders.counts().dropped, 1u);
    may_go_on.set_value();
  }
  EXPECT_EQ(done, 3) << "what waits at the end comes out";
}

TEST(ImageEncoders, AnImageThatCannotBeUsedIsCountedWithItsReason) {
  const auto bayer = picture(CV_8UC1, 5);
  bayer->encoding = "bayer_rggb8";
  EXPECT_THROW(compressed(*bayer, 90), ImageError);
  std::promise<void> second;
  ImageEncoders encoders(1, 8, 90,
                         [&](const sensor_msgs::CompressedImagePtr&, const ros::Time&) { second.set_value(); });
  encoders.add(bayer, ros::Time(1, 0));
  encoders.add(picture(CV_8UC3, 5), ros::Time(1, 0));
  second.get_future().wait();
  EXPECT_EQ(encoders.counts().refused, 1u);
  EXPECT_NE(encoders.counts().refusal.find("bayer"), std::string::npos) << encoders.counts().refusal;
}

}  // namespace
}  // namespace laparoscope_servo
