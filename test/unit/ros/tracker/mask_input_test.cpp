#include "ros/tracker/mask_input.h"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <string>

#include "ros/tracker/image_conversion.h"
#include "support/error_text.h"

namespace laparoscope_servo {
namespace {

const cv::Size kSize(64, 48);
constexpr double kPeriod = 0.04;  // s

sensor_msgs::ImagePtr message(double stamp, std::uint32_t width = 64, std::uint32_t height = 48) {
  auto result = boost::make_shared<sensor_msgs::Image>();
  result->header.stamp = ros::Time(stamp);
  result->encoding = "mono8";
  result->width = width;
  result->height = height;
  result->step = width;
  result->data.assign(std::size_t{width} * height, 255);
  return result;
}

class MaskInputTest : public testing::Test {
 protected:
  static MaskInputConfig config() {
    MaskInputConfig config;
    config.owner = "/instrument";
    config.max_age = 0.1;
    return config;
  }
  MaskInput::Arrival from(const std::string& sender, double now = 10.0) const {
    return {sender, own_, now, ros::Time(100.02)};
  }
  // Why it is refused; empty: it is not.
  std::string refusal(const sensor_msgs::ImageConstPtr& mask, const MaskInput::Arrival& arrival) {
    return test_support::errorText<ImageError>([&] { input_.take(mask, arrival); });
  }
  std::string refusal(const sensor_msgs::ImageConstPtr& mask) { return refusal(mask, from("/instrument")); }

  const InputOwner::Connection own_ = boost::make_shared<int>(1);
  MaskInput input_{config(), tracking::InputConfig()};
};

TEST_F(MaskInputTest, IsUsedForItsOwnImageWithoutACopy) {
  const sensor_msgs::ImagePtr mask = message(100.0);
  EXPECT_EQ(refusal(mask), "");
  const tracking::ExternalMask used = input_.at(ros::Time(100.0), kSize);
  EXPECT_EQ(used.mask.data, mask->data.data());
  EXPECT_EQ(used.mask.size(), kSize);
  EXPECT_EQ(used.age, 0.0);
}

TEST_F(MaskInputTest, KeepsTheMessage) {
  sensor_msgs::ImagePtr mask = message(100.0);
  const boost::weak_ptr<sensor_msgs::Image> watched = mask;
  EXPECT_EQ(refusal(mask), "");
  mask.reset();
  EXPECT_FALSE(watched.expired());
  input_.clockJumpedBack();
  EXPECT_TRUE(watched.expired());
}

TEST_F(MaskInputTest, AnEarlierOneIsUsedAsPredicted) {
  EXPECT_EQ(refusal(message(100.0)), "");
  EXPECT_NEAR(input_.at(ros::Time(100.04), kSize).age, kPeriod, 1e-6);
  EXPECT_TRUE(input_.at(ros::Time(100.2), kSize).mask.empty());
}

TEST_F(MaskInputTest, RefusesOtherEncodingsAndAmounts) {
  sensor_msgs::ImagePtr colour = message(100.0);
  colour->encoding = "bgr8";
  EXPECT_NE(refusal(colour).find("encoding 'bgr8', expected mono8"), std::string::npos) << refusal(colour);
  EXPECT_NE(refusal(message(100.0, 0, 48)).find("0x48 px, expected sides of 1 to"), std::string::npos);
  sensor_msgs::ImagePtr lacks = message(100.0);
  lacks->data.resize(100);
  EXPECT_NE(refusal(lacks).find("100 bytes in lines of 64, expected at least 64 in each of 48 lines"),
            std::string::npos)
      << refusal(lacks);
  sensor_msgs::ImagePtr narrow = message(100.0);
  narrow->step = 63;
  EXPECT_NE(refusal(narrow), "");
  EXPECT_TRUE(input_.at(ros::Time(100.0), kSize).mask.empty());
  EXPECT_EQ(refusal(message(100.0)), "") << "the next one counts";
}

TEST_F(MaskInputTest, RefusesAnotherSizeThanTheImages) {
  input_.at(ros::Time(100.0), cv::Size(32, 24));
  EXPECT_NE(refusal(message(100.0)).find("size 64x48 px, expected that of the images, 32x24 px"), std::string::npos);
  input_.at(ros::Time(100.04), kSize);
  EXPECT_EQ(refusal(message(100.0)), "");
}

TEST_F(MaskInputTest, RefusesStampsThatAreZeroAheadRepeatedOrBefore) {
  EXPECT_NE(refusal(message(0.0)).find("stamp of zero"), std::string::npos);
  EXPECT_NE(refusal(message(103.0)).find("ahead of this machine's clock, expected at most"), std::string::npos);
  EXPECT_EQ(refusal(message(100.0)), "");
  EXPECT_NE(refusal(message(100.0)).find("repeats the stamp"), std::string::npos);
  EXPECT_NE(refusal(message(90.0)).find("s before the one before it"), std::string::npos);
  EXPECT_EQ(input_.at(ros::Time(100.0), kSize).age, 0.0) << "the one before stays";
  EXPECT_FALSE(input_.at(ros::Time(100.0), kSize).mask.empty());
}

TEST_F(MaskInputTest, ATimeThatGoesOnElsewhereIsBelievedAfterSomeMasks) {
  EXPECT_EQ(refusal(message(100.0)), "");
  int needed = 0;
  while (needed < 10 && !refusal(message(50.0 + kPeriod * needed)).empty()) ++needed;
  EXPECT_EQ(needed, tracking::InputConfig().restart_images - 1);
  EXPECT_TRUE(input_.at(ros::Time(100.0), kSize).mask.empty()) << "those of the other time are forgotten";
  EXPECT_EQ(input_.at(ros::Time(50.0 + kPeriod * needed), kSize).age, 0.0);
}

TEST_F(MaskInputTest, AClockThatJumpsBackIsBelievedAtOnce) {
  EXPECT_EQ(refusal(message(100.0)), "");
  input_.clockJumpedBack();
  EXPECT_TRUE(input_.at(ros::Time(100.0), kSize).mask.empty());
  EXPECT_EQ(refusal(message(50.0)), "");
}

TEST_F(MaskInputTest, RefusesASecondPublisherByName) {
  EXPECT_EQ(refusal(message(100.0)), "");
  const std::string why = refusal(message(100.01), from("/other"));
  EXPECT_NE(why.find("masks of /other are refused, only those of /instrument count (parameter external_mask/owner)"),
            std::string::npos)
      << why;
  EXPECT_EQ(refusal(message(100.02)), "");
}

TEST_F(MaskInputTest, AnotherConnectionCountsWhenTheOwnerWasSilent) {
  EXPECT_EQ(refusal(message(100.0), from("/instrument", 10.0)), "");
  MaskInput::Arrival anew = from("/instrument", 11.0);
  anew.connection = boost::make_shared<int>(2);
  EXPECT_NE(refusal(message(100.01), anew).find("a second connection of /instrument"), std::string::npos);
  anew.now = 12.5;
  EXPECT_EQ(refusal(message(100.01), anew), "");
}

TEST(MaskInput, WithoutAnOwnerTheFirstThatPublishesCounts) {
  MaskInputConfig config;
  config.owner = "";
  MaskInput input(config, tracking::InputConfig());
  const auto a = boost::make_shared<int>(1), b = boost::make_shared<int>(2);
  EXPECT_NO_THROW(input.take(message(100.0), {"/a", a, 1.0, ros::Time()}));
  EXPECT_THROW(input.take(message(100.04), {"/b", b, 1.0, ros::Time()}), ImageError);
  EXPECT_NO_THROW(input.take(message(100.04), {"/b", b, 5.0, ros::Time()})) << "a is silent";
}

}  // namespace
}  // namespace laparoscope_servo
