// describe_recording as a user runs it.
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "support/command_output.h"
#include "support/synthetic_sequence.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

class DescribeRecording : public testing::Test {
 protected:
  DescribeRecording() {
    const cv::Mat texture = test_support::texture(cv::Size(160, 120));
    for (int k = 0; k < 4; ++k) cv::imwrite(images_.file(std::to_string(k) + ".png"), texture);
  }

  test_support::CommandOutput describe(const std::string& options = "") {
    return test_support::outputOf(DESCRIBE_RECORDING " " + images_.path() + " " + options);
  }

  test_support::TemporaryFolder images_;
  test_support::TemporaryFolder out_;
};

TEST_F(DescribeRecording, PrintsSizeLengthRateAndARegion) {
  const auto told = describe("--rate 10");
  ASSERT_EQ(told.status, 0) << told.text;
  for (const char* fact : {"\"width\": 160", "\"height\": 120", "\"images\": 4", "\"rate\": 10", "\"first_image\": 0",
                           "\"roi\": \"60,40,40,40\"", "\"refusal\": \"\""}) {
    EXPECT_NE(told.text.find(fact), std::string::npos) << fact << " in " << told.text;
  }
}

TEST_F(DescribeRecording, SaysWhyARegionWouldBeRefused) {
  const auto outside = describe("--roi 150,40,40,40");
  ASSERT_EQ(outside.status, 0) << outside.text;
  EXPECT_NE(outside.text.find("160 x 120"), std::string::npos) << outside.text;
  EXPECT_NE(describe("--roi 50,40,50,40").text.find("\"refusal\": \"\""), std::string::npos);
  EXPECT_EQ(describe("--roi 50,40,50").status, 1);
}

TEST_F(DescribeRecording, KnowsNothingButThePartThatIsCropped) {
  const auto told = describe("--crop 20,10,100,80");
  ASSERT_EQ(told.status, 0) << told.text;
  EXPECT_NE(told.text.find("\"width\": 100"), std::string::npos) << told.text;
  EXPECT_NE(told.text.find("\"height\": 80"), std::string::npos) << told.text;
  const auto outside = describe("--crop 100,0,100,80");
  EXPECT_EQ(outside.status, 1);
  EXPECT_NE(outside.text.find("the image has 160x120 px, expected at least 200x80"), std::string::npos) << outside.text;
  const auto half = describe("--crop 1.5,0,10,10");
  EXPECT_NE(half.status, 0);
  EXPECT_NE(half.text.find("crop '1.5,0,10,10', expected whole px"), std::string::npos) << half.text;
}

TEST_F(DescribeRecording, AsksForNoRegionWhereThereIsNoTexture) {
  for (int k = 0; k < 4; ++k)
    cv::imwrite(images_.file(std::to_string(k) + ".png"), cv::Mat(120, 160, CV_8UC3, cv::Scalar(40, 60, 120)));
  const auto told = describe();
  ASSERT_EQ(told.status, 0) << told.text;
  EXPECT_NE(told.text.find("\"roi\": \"\""), std::string::npos) << told.text;
}

TEST_F(DescribeRecording, WritesThePictureWithTheRegion) {
  const std::string picture = out_.file("a.png");
  ASSERT_EQ(describe("--roi 50,40,50,40 --picture " + picture).status, 0);
  const cv::Mat image = cv::imread(picture);
  ASSERT_EQ(image.size(), cv::Size(160, 120));
  EXPECT_EQ(image.at<cv::Vec3b>(40, 75), cv::Vec3b(255, 255, 255));
  EXPECT_NE(image.at<cv::Vec3b>(60, 75), cv::Vec3b(255, 255, 255));
  EXPECT_EQ(describe("--picture " + out_.file("no/such/folder.png")).status, 1);
}

TEST_F(DescribeRecording, PrintsTheScenesBetweenCutsWhenItIsAskedFor) {
  for (int k = 4; k < 12; ++k)
    cv::imwrite(images_.file(std::to_string(k) + ".png"), test_support::texture(cv::Size(160, 120), 2));
  const auto told = describe("--cuts");
  ASSERT_EQ(told.status, 0) << told.text;
  for (const char* fact : {"\"start\": 0,", "\"end\": 0.14", "\"start\": 0.14"})
    EXPECT_NE(told.text.find(fact), std::string::npos) << fact << " in " << told.text;
  EXPECT_EQ(describe().text.find("scenes"), std::string::npos);
}

TEST_F(DescribeRecording, NamesWhatCannotBeRead) {
  std::ofstream(out_.file("noise.mp4")) << "no video";
  const auto told = test_support::outputOf(DESCRIBE_RECORDING " " + out_.file("noise.mp4"));
  EXPECT_EQ(told.status, 1);
  EXPECT_NE(told.text.find("noise.mp4"), std::string::npos) << told.text;
  EXPECT_EQ(describe("--end 0").status, 1);
  EXPECT_EQ(describe("--nonsense").status, 2);
}

}  // namespace
}  // namespace laparoscope_servo
