#include "ros/playback/picture_conversion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace laparoscope_servo {
namespace {

libav::Frame yuv(int width, int height, int y, int u, int v) {
  libav::Frame frame(av_frame_alloc());
  frame->format = AV_PIX_FMT_YUV444P;
  frame->width = width;
  frame->height = height;
  av_frame_get_buffer(frame.get(), 0);
  const int values[] = {y, u, v};
  for (int plane = 0; plane < 3; ++plane) {
    for (int row = 0; row < height; ++row) {
      std::fill_n(frame->data[plane] + row * frame->linesize[plane], width, static_cast<std::uint8_t>(values[plane]));
    }
  }
  return frame;
}

cv::Vec3b centre(const cv::Mat& image) {
  return image.at<cv::Vec3b>(image.rows / 2, image.cols / 2);
}

void expectNear(const cv::Vec3b& got, const cv::Vec3b& wanted) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], wanted[k], 2) << got << wanted;
}

TEST(PictureConversion, OrientationIsOfTheEightThatAMatrixCanHave) {
  for (int degrees = 0; degrees < 360; degrees += 90) {
    std::array<std::int32_t, 9> matrix{};
    av_display_rotation_set(matrix.data(), degrees);
    const Orientation turned = orientationOf(matrix);
    EXPECT_EQ(turned.transposed, degrees % 180 == 90) << degrees;
    EXPECT_EQ(turned.mirrored_x, degrees == 90 || degrees == 180) << degrees;
    EXPECT_EQ(turned.mirrored_y, degrees == 180 || degrees == 270) << degrees;
    av_display_matrix_flip(matrix.data(), 1, 0);  // after it is turned
    const Orientation both = orientationOf(matrix);
    EXPECT_EQ(both.transposed, turned.transposed);
    EXPECT_NE(both.mirrored_x, turned.mirrored_x) << degrees;
    EXPECT_EQ(both.mirrored_y, turned.mirrored_y) << degrees;
  }
  const Orientation none = orientationOf({});
  EXPECT_FALSE(none.transposed || none.mirrored_x || none.mirrored_y);
}

// Kr = 0.299, Kb = 0.114 or Kr = 0.2126, Kb = 0.0722 by hand, for Y = 120, U = 110, V = 160.
TEST(PictureConversion, UsesTheMatrixAndTheRangeOfTheTags) {
  PictureConverter converter({});
  const libav::Frame frame = yuv(64, 48, 120, 110, 160);
  expectNear(centre(converter.convert(*frame)), {85, 102, 172});
  frame->colorspace = AVCOL_SPC_SMPTE170M;
  expectNear(centre(converter.convert(*frame)), {85, 102, 172});
  frame->colorspace = AVCOL_SPC_BT709;
  expectNear(centre(converter.convert(*frame)), {83, 108, 178});
  frame->color_range = AVCOL_RANGE_JPEG;
  expectNear(centre(converter.convert(*frame)), {87, 108, 170});
  frame->colorspace = AVCOL_SPC_UNSPECIFIED;
  expectNear(centre(converter.convert(*frame)), {88, 103, 165});
}

TEST(PictureConversion, AnyWidthIsWholeAndAMatrixOfItsOwn) {
  PictureConverter converter({});
  for (const int width : {1, 2, 31, 33, 63, 510}) {
    const libav::Frame frame = yuv(width, 7, 126, 128, 128);
    const cv::Mat first = converter.convert(*frame);
    const cv::Mat second = converter.convert(*frame);
    ASSERT_EQ(first.size(), cv::Size(width, 7));
    EXPECT_NE(first.data, second.data);
    for (int x = 0; x < width; ++x) expectNear(first.at<cv::Vec3b>(6, x), {128, 128, 128});
  }
}

TEST(PictureConversion, SaysWhatItCannotConvert) {
  const libav::Frame frame = yuv(64, 48, 120, 128, 128);
  frame->format = AV_PIX_FMT_VAAPI;
  EXPECT_THROW(PictureConverter({}).convert(*frame), std::runtime_error);
}

}  // namespace
}  // namespace laparoscope_servo
