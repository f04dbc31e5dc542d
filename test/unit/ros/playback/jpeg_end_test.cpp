#include "ros/playback/jpeg_end.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

namespace laparoscope_servo {
namespace {

std::string jpeg(const std::vector<int>& options) {
  cv::Mat image(24, 32, CV_8UC3);
  cv::randu(image, 0, 255);
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", image, bytes, options);
  return {bytes.begin(), bytes.end()};
}

// A header of EXIF's kind with a whole small JPEG in it.
std::string withPreview(const std::string& bytes) {
  const std::string preview = std::string("\xFF\xD8\xFF\xD9", 4);
  const std::string header = std::string("\xFF\xE1\x00\x06", 4) + preview;
  return bytes.substr(0, 2) + header + bytes.substr(2);
}

TEST(JpegEnd, IsFoundInWholeOnesAndInNoneThatIsCutAnywhere) {
  for (const std::vector<int>& options : {std::vector<int>{}, std::vector<int>{cv::IMWRITE_JPEG_PROGRESSIVE, 1},
                                          std::vector<int>{cv::IMWRITE_JPEG_RST_INTERVAL, 4}}) {
    for (const std::string& whole : {jpeg(options), withPreview(jpeg(options))}) {
      EXPECT_TRUE(isJpeg(whole));
      EXPECT_TRUE(hasJpegEnd(whole));
      EXPECT_TRUE(hasJpegEnd(whole + std::string(100, '\0'))) << "what follows does not matter";
      for (std::size_t size = 0; size < whole.size(); ++size) ASSERT_FALSE(hasJpegEnd(whole.substr(0, size))) << size;
      std::string half = whole;
      half.replace(whole.size() / 2, std::string::npos, whole.size() - whole.size() / 2, '\0');
      EXPECT_FALSE(hasJpegEnd(half)) << "the space was there before the bytes were";
    }
  }
  EXPECT_FALSE(isJpeg("\x89PNG"));
  EXPECT_FALSE(isJpeg(""));
}

}  // namespace
}  // namespace laparoscope_servo
