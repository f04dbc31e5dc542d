#include "laparoscope_servo/sim/texture.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace laparoscope_servo::sim {
namespace {

double largestDifference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_INF);
}

TEST(TissueTexture, IsTheSameForTheSameSeedAndAnotherForAnother) {
  EXPECT_EQ(largestDifference(tissueTexture(256, 7), tissueTexture(256, 7)), 0.0);
  EXPECT_GT(largestDifference(tissueTexture(256, 7), tissueTexture(256, 8)), 0.0);
  EXPECT_GT(largestDifference(tissueTexture(256, 0), tissueTexture(256, 1)), 0.0);
}

TEST(TissueTexture, IsReddish) {
  const cv::Scalar mean = cv::mean(tissueTexture(512, 1));
  EXPECT_GT(mean[2], 1.3 * mean[1]);
  EXPECT_GT(mean[2], 1.3 * mean[0]);
}

// A tracker needs gradient in every part of the image, at every level of its pyramid.
TEST(TissueTexture, HasGradientEverywhereAtEveryScale) {
  cv::Mat level;
  cv::cvtColor(tissueTexture(1024, 1), level, cv::COLOR_BGR2GRAY);
  for (; level.cols >= 64; cv::pyrDown(level, level)) {
    const int side = level.cols / 8;
    for (int row = 0; row < 8; ++row) {
      for (int column = 0; column < 8; ++column) {
        cv::Mat dx, dy;
        const cv::Mat part = level(cv::Rect(column * side, row * side, side, side));
        cv::Sobel(part, dx, CV_32F, 1, 0, 3, 1.0 / 8.0);
        cv::Sobel(part, dy, CV_32F, 0, 1, 3, 1.0 / 8.0);
        const double rms = std::sqrt((dx.dot(dx) + dy.dot(dy)) / static_cast<double>(part.total()));
        EXPECT_GT(rms, 2.0) << "at " << level.cols << " px, part " << row << ", " << column;
      }
    }
  }
}

TEST(TissueTexture, RefusesSizesThatMakeNoSense) {
  for (const int side : {-1, 0, 63, 8193}) EXPECT_THROW(tissueTexture(side, 1), std::invalid_argument) << side;
}

TEST(TextureFromFile, ReadsAnImageAndNamesTheFileThatItCannotRead) {
  const std::string image = testing::TempDir() + "texture_test.png", text = testing::TempDir() + "texture_test.txt";
  cv::Mat grey(20, 30, CV_8UC1, cv::Scalar(77));
  ASSERT_TRUE(cv::imwrite(image, grey));
  const cv::Mat read = textureFromFile(image);
  EXPECT_EQ(read.type(), CV_8UC3);
  EXPECT_EQ(read.size(), cv::Size(30, 20));
  EXPECT_EQ(read.at<cv::Vec3b>(10, 10), cv::Vec3b(77, 77, 77));

  std::ofstream(text) << "no image";
  for (const std::string& file : {text, std::string("/there/is/no/such/file.png")}) {
    try {
      textureFromFile(file);
      ADD_FAILURE() << file;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
    }
  }
  std::remove(image.c_str());
  std::remove(text.c_str());
}

}  // namespace
}  // namespace laparoscope_servo::sim
