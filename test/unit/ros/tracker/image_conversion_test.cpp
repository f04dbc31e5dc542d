#include "ros/tracker/image_conversion.h"

#include <gtest/gtest.h>
#include <sensor_msgs/image_encodings.h>

#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "support/error_text.h"

namespace laparoscope_servo {
namespace {

// A message of 2 x 2 pixels with `bytes` in each, rows padded by `padding` bytes.
sensor_msgs::Image message(const std::string& encoding, const std::vector<std::uint8_t>& pixel, unsigned padding = 0) {
  sensor_msgs::Image image;
  image.encoding = encoding;
  image.width = image.height = 2;
  image.step = static_cast<std::uint32_t>(2 * pixel.size() + padding);
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) image.data.insert(image.data.end(), pixel.begin(), pixel.end());
    image.data.insert(image.data.end(), padding, 0xEE);
  }
  return image;
}

std::string errorOf(const sensor_msgs::Image& image) {
  return test_support::errorText<ImageError>([&] { trackerImage(image); });
}

struct Case {
  const char* encoding;
  std::vector<std::uint8_t> pixel;  // little endian
  int channels;
  cv::Vec3b expected;  // blue, green, red
};

class EveryEncoding : public testing::TestWithParam<Case> {};

TEST_P(EveryEncoding, GivesGreyOrBlueGreenRed) {
  for (const unsigned padding : {0u, 2u, 6u}) {
    const sensor_msgs::Image image = message(GetParam().encoding, GetParam().pixel, padding);
    const cv::Mat result = trackerImage(image);
    ASSERT_EQ(result.size(), cv::Size(2, 2));
    ASSERT_EQ(result.type(), CV_MAKETYPE(CV_8U, GetParam().channels));
    for (int row = 0; row < 2; ++row) {
      for (int column = 0; column < 2; ++column) {
        if (GetParam().channels == 1) {
          EXPECT_EQ(result.at<std::uint8_t>(row, column), GetParam().expected[0]);
        } else {
          EXPECT_EQ(result.at<cv::Vec3b>(row, column), GetParam().expected);
        }
      }
    }
  }
}

// 16 bit: 257 n becomes n, so that both bytes are n; 0xFE80 = 65152 is 253.5 levels, 0x0180 = 384 rounds to 1.
INSTANTIATE_TEST_SUITE_P(
    All, EveryEncoding,
    testing::Values(Case{"mono8", {77}, 1, {77, 0, 0}}, Case{"8UC1", {77}, 1, {77, 0, 0}},
                    Case{"bgr8", {10, 20, 30}, 3, {10, 20, 30}}, Case{"8UC3", {10, 20, 30}, 3, {10, 20, 30}},
                    Case{"rgb8", {30, 20, 10}, 3, {10, 20, 30}}, Case{"bgra8", {10, 20, 30, 99}, 3, {10, 20, 30}},
                    Case{"8UC4", {10, 20, 30, 99}, 3, {10, 20, 30}}, Case{"rgba8", {30, 20, 10, 99}, 3, {10, 20, 30}},
                    Case{"mono16", {0x80, 0x01}, 1, {1, 0, 0}}, Case{"16UC1", {255, 255}, 1, {255, 0, 0}},
                    Case{"bgr16", {10, 10, 20, 20, 30, 30}, 3, {10, 20, 30}},
                    Case{"16UC3", {10, 10, 20, 20, 30, 30}, 3, {10, 20, 30}},
                    Case{"rgb16", {30, 30, 20, 20, 10, 10}, 3, {10, 20, 30}},
                    Case{"bgra16", {10, 10, 20, 20, 30, 30, 9, 9}, 3, {10, 20, 30}},
                    Case{"16UC4", {10, 10, 20, 20, 30, 30, 9, 9}, 3, {10, 20, 30}},
                    Case{"rgba16", {30, 30, 20, 20, 10, 10, 9, 9}, 3, {10, 20, 30}}),
    [](const auto& test) { return std::string(test.param.encoding); });

TEST(ImageConversion, ConvertsYuv422InBothOrders) {
  // Two pixels share U and V. Y 16 is black and 235 white of video levels; U = V = 128 is grey.
  sensor_msgs::Image image = message("yuv422", {128, 16});  // U Y0 V Y1: every first byte is a colour
  image.data = {128, 16, 128, 235, 128, 16, 128, 235};
  const cv::Mat uyvy = trackerImage(image);
  EXPECT_EQ(uyvy.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(uyvy.at<cv::Vec3b>(1, 1), cv::Vec3b(255, 255, 255));
  image.encoding = "yuv422_yuy2";
  image.data = {16, 128, 235, 128, 16, 128, 235, 128};
  const cv::Mat yuyv = trackerImage(image);
  EXPECT_EQ(yuyv.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 0, 0));
  EXPECT_EQ(yuyv.at<cv::Vec3b>(1, 1), cv::Vec3b(255, 255, 255));
}

TEST(ImageConversion, HasTheChannelsOfYuv422InTheirPlaces) {
  sensor_msgs::Image image = message("yuv422", {0, 0});
  image.data = {90, 100, 240, 100, 90, 100, 240, 100};  // much V: red
  const cv::Vec3b pixel = trackerImage(image).at<cv::Vec3b>(0, 0);
  EXPECT_GT(pixel[2], 200);
  EXPECT_LT(pixel[0], 100);
}

// Of 4:2:0: Y of 4 x 2 pixels, then U and V of two.
sensor_msgs::Image planes(const std::string& encoding, unsigned padding = 0) {
  const bool two = encoding.substr(0, 2) == "nv" || encoding.substr(0, 2) == "NV";
  const bool v_first = encoding == "nv21" || encoding == "NV21" || encoding == "yv12";
  sensor_msgs::Image image;
  image.encoding = encoding;
  image.width = 4;
  image.height = 2;
  image.step = 4 + padding;
  const std::uint8_t u = 90;
  const std::uint8_t v = 240;
  for (int row = 0; row < 2; ++row) {
    image.data.insert(image.data.end(), 4, 100);
    image.data.insert(image.data.end(), padding, 0xEE);
  }
  const std::uint8_t first = v_first ? v : u;
  const std::uint8_t second = v_first ? u : v;
  if (two) {
    image.data.insert(image.data.end(), {first, second, first, second});
    image.data.insert(image.data.end(), padding, 0xEE);
  } else {
    for (const std::uint8_t value : {first, second}) {
      image.data.insert(image.data.end(), 2, value);
      image.data.insert(image.data.end(), padding / 2, 0xEE);
    }
  }
  return image;
}

TEST(ImageConversion, TakesYuvByTheNamesThatDriversUse) {
  sensor_msgs::Image packed = message("uyvy", {0, 0});
  packed.data = {90, 100, 240, 100, 90, 100, 240, 100};
  const cv::Vec3b expected = trackerImage(packed).at<cv::Vec3b>(0, 0);
  EXPECT_GT(expected[2], 200) << "much V is red";
  const auto near = [&](const cv::Mat& image, const std::string& name) {
    for (int column = 0; column < image.cols; ++column) {
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(image.at<cv::Vec3b>(1, column)[k], expected[k], 1) << name;
    }
  };
  for (const char* name : {"yuv422", "uyvy", "UYVY"}) {
    packed.encoding = name;
    near(trackerImage(packed), name);
  }
  packed.data = {100, 90, 100, 240, 100, 90, 100, 240};
  for (const char* name : {"yuv422_yuy2", "yuyv", "YUYV", "yuy2", "YUY2"}) {
    packed.encoding = name;
    near(trackerImage(packed), name);
  }
  packed.data = {100, 240, 100, 90, 100, 240, 100, 90};
  packed.encoding = "YVYU";
  near(trackerImage(packed), "YVYU");
  for (const char* name : {"nv12", "NV12", "nv21", "NV21", "i420", "I420", "yuv420", "yuv420p", "yv12"}) {
    for (const unsigned padding : {0u, 6u}) {
      const cv::Mat image = trackerImage(planes(name, padding));
      ASSERT_EQ(image.size(), cv::Size(4, 2)) << name;
      near(image, name);
    }
  }
}

TEST(ImageConversion, RefusesPlanesThatDoNotFit) {
  for (const char* name : {"nv12", "i420"}) {
    sensor_msgs::Image image = planes(name);
    image.data.pop_back();
    EXPECT_NE(errorOf(image).find("11 bytes of data, expected 12"), std::string::npos) << errorOf(image);
    image = planes(name);
    image.height = 1;
    EXPECT_NE(errorOf(image).find("odd height"), std::string::npos) << errorOf(image);
    image = planes(name);
    image.width = 3;
    EXPECT_NE(errorOf(image).find("odd width"), std::string::npos) << errorOf(image);
    image = planes(name);
    image.step = 2;
    EXPECT_NE(errorOf(image).find("step 2, expected at least 4"), std::string::npos) << errorOf(image);
  }
  sensor_msgs::Image odd = planes("i420", 2);
  odd.step = 5;
  EXPECT_NE(errorOf(odd).find("even"), std::string::npos) << errorOf(odd);
}

TEST(ImageConversion, TakesTheFullRangeOfYuvWhereToldSo) {
  const ImageFormat full{16, YuvRange::kFull};
  for (const int level : {0, 1, 16, 100, 200, 235, 254, 255}) {
    const auto y = static_cast<std::uint8_t>(level);
    sensor_msgs::Image image = message("uyvy", {0, 0});
    image.data = {128, y, 128, y, 128, y, 128, y};
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(trackerImage(image, full).at<cv::Vec3b>(0, 0)[k], level, 1) << level;
    image.encoding = "yuyv";
    image.data = {y, 128, y, 128, y, 128, y, 128};
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(trackerImage(image, full).at<cv::Vec3b>(0, 0)[k], level, 1) << level;
    sensor_msgs::Image nv12 = planes("nv12");
    nv12.data = {y, y, y, y, y, y, y, y, 128, 128, 128, 128};
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(trackerImage(nv12, full).at<cv::Vec3b>(1, 3)[k], level, 1) << level;
  }
}

TEST(ImageConversion, TakesTheBitsThatAreUsed) {
  const struct {
    int depth;
    unsigned value;
    int expected;
  } cases[] = {{8, 255, 255},   {10, 1023, 255},  {10, 512, 128},   {12, 4095, 255},
               {12, 2048, 128}, {14, 16383, 255}, {16, 65535, 255}, {10, 2000, 255}};
  for (const auto& test : cases) {
    const sensor_msgs::Image image =
        message("mono16", {static_cast<std::uint8_t>(test.value & 0xFF), static_cast<std::uint8_t>(test.value >> 8)});
    EXPECT_EQ(trackerImage(image, {test.depth, YuvRange::kLimited}).at<std::uint8_t>(0, 0), test.expected)
        << test.depth << ": " << test.value;
  }
}

TEST(BitDepthTest, GrowsToTheLargestValueSeenAndNeverShrinks) {
  BitDepth depth;
  depth.see(cv::Mat(8, 8, CV_8UC1, cv::Scalar(255)));
  EXPECT_EQ(depth.value(), 8);
  for (const auto& [value, expected] : {std::make_pair(10, 8),
                                        {255, 8},
                                        {256, 10},
                                        {3, 10},
                                        {1023, 10},
                                        {1024, 12},
                                        {4095, 12},
                                        {9000, 14},
                                        {65535, 16},
                                        {0, 16}}) {
    cv::Mat image(8, 8, CV_16UC3, cv::Scalar::all(0));
    image.at<cv::Vec3w>(4, 7)[2] = static_cast<std::uint16_t>(value);
    depth.see(image);
    EXPECT_EQ(depth.value(), expected) << value;
  }
}

TEST(ImageConversion, SharesTheDataWhereNothingHasToBeDone) {
  for (const char* encoding : {"mono8", "8UC1", "bgr8", "8UC3"}) {
    const bool grey = std::string(encoding) == "mono8" || std::string(encoding) == "8UC1";
    const sensor_msgs::Image image =
        message(encoding, grey ? std::vector<std::uint8_t>{1} : std::vector<std::uint8_t>{1, 2, 3});
    EXPECT_EQ(trackerImage(image).data, image.data.data()) << encoding;
  }
}

TEST(ImageConversion, LeavesTheMessageAsItWas) {
  for (const char* encoding : {"rgb8", "bgr16"}) {
    sensor_msgs::Image image = message(encoding, {1, 2, 3, 4, 5, 6});
    if (std::string(encoding) == "rgb8") image.width = 4;
    image.is_bigendian = 1;
    const auto before = image.data;
    trackerImage(image);
    EXPECT_EQ(image.data, before) << encoding;
  }
}

TEST(ImageConversion, MindsTheOrderOfBytes) {
  sensor_msgs::Image image = message("mono16", {0x40, 0x20});
  EXPECT_EQ(trackerImage(image).at<std::uint8_t>(0, 0), (0x2040 + 128) / 257);
  image.is_bigendian = 1;
  EXPECT_EQ(trackerImage(image).at<std::uint8_t>(1, 1), (0x4020 + 128) / 257);
}

TEST(ImageConversion, RefusesBayerAndSaysWhatToDo) {
  using namespace sensor_msgs::image_encodings;
  for (const std::string& encoding : {BAYER_RGGB8, BAYER_BGGR8, BAYER_GBRG8, BAYER_GRBG8, BAYER_RGGB16, BAYER_GRBG16}) {
    const std::string error = errorOf(message(encoding, {1}));
    EXPECT_NE(error.find(encoding), std::string::npos) << error;
    EXPECT_NE(error.find("image_proc"), std::string::npos) << error;
  }
}

TEST(ImageConversion, RefusesOtherEncodingsAndListsThoseItTakes) {
  for (const char* encoding :
       {"", "rgb", "RGB8", "32FC1", "8SC3", "16SC1", "8UC2", "8UC", "bgr8 ", "nonsense; drop table"}) {
    const std::string error = errorOf(message(encoding, {1, 2, 3}));
    EXPECT_NE(error.find("'" + std::string(encoding) + "'"), std::string::npos) << error;
    EXPECT_NE(error.find("mono16"), std::string::npos) << error;
  }
}

TEST(ImageConversion, RefusesAnEmptyImage) {
  for (const bool width : {true, false}) {
    sensor_msgs::Image image = message("bgr8", {1, 2, 3});
    (width ? image.width : image.height) = 0;
    EXPECT_NE(errorOf(image).find("empty"), std::string::npos);
  }
}

TEST(ImageConversion, RefusesTruncatedDataAndNamesTheSizes) {
  sensor_msgs::Image image = message("bgr8", {1, 2, 3});
  image.data.resize(11);
  const std::string error = errorOf(image);
  EXPECT_NE(error.find("11 bytes"), std::string::npos) << error;
  EXPECT_NE(error.find("12"), std::string::npos) << error;
  EXPECT_NE(error.find("bgr8"), std::string::npos) << error;
  image.data.clear();
  EXPECT_NE(errorOf(image).find("truncated"), std::string::npos);
}

TEST(ImageConversion, RefusesSizesWhoseProductOverflows32Bits) {
  sensor_msgs::Image image = message("mono8", {1});
  image.width = 65536;
  image.step = 65536;
  image.height = 65537;  // 2^32 + 2^16 bytes: 65536 in 32 bits
  image.data.resize(70000);
  EXPECT_NE(errorOf(image).find("truncated"), std::string::npos);
  image.width = image.step = image.height = 0xFFFFFFFFu;
  EXPECT_NE(errorOf(image), "");
}

TEST(ImageConversion, TakesALastRowWithoutItsPadding) {
  sensor_msgs::Image image = message("bgr8", {1, 2, 3}, 4);
  image.data.resize(image.data.size() - 4);
  EXPECT_EQ(trackerImage(image).at<cv::Vec3b>(1, 1), cv::Vec3b(1, 2, 3));
}

TEST(ImageConversion, RefusesAStepThatDoesNotFit) {
  sensor_msgs::Image image = message("bgr8", {1, 2, 3});
  image.step = 5;
  EXPECT_NE(errorOf(image).find("step 5, expected at least 6"), std::string::npos) << errorOf(image);
  sensor_msgs::Image odd = message("mono16", {1, 2}, 1);
  EXPECT_NE(errorOf(odd).find("even"), std::string::npos) << errorOf(odd);
  sensor_msgs::Image yuv = message("yuv422", {1, 2});
  yuv.width = 1;
  EXPECT_NE(errorOf(yuv).find("odd width"), std::string::npos) << errorOf(yuv);
}

TEST(DecodedImage, BecomesGreyOrBlueGreenRed) {
  EXPECT_EQ(trackerImage(cv::Mat(2, 2, CV_8UC3, cv::Scalar(1, 2, 3))).at<cv::Vec3b>(0, 0), cv::Vec3b(1, 2, 3));
  EXPECT_EQ(trackerImage(cv::Mat(2, 2, CV_8UC4, cv::Scalar(1, 2, 3, 4))).at<cv::Vec3b>(0, 0), cv::Vec3b(1, 2, 3));
  EXPECT_EQ(trackerImage(cv::Mat(2, 2, CV_16UC1, cv::Scalar(257 * 9))).at<std::uint8_t>(0, 0), 9);
  EXPECT_THROW(trackerImage(cv::Mat()), ImageError);
  EXPECT_THROW(trackerImage(cv::Mat(2, 2, CV_32FC1)), ImageError);
  EXPECT_THROW(trackerImage(cv::Mat(2, 2, CV_8UC2)), ImageError);
}

}  // namespace
}  // namespace laparoscope_servo
