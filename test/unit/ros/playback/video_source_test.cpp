// Videos as they come, whole and damaged.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "support/test_video.h"
#include "unit/ros/image_source_fixture.h"

namespace laparoscope_servo {
namespace {

using test_support::TestVideo;
using test_support::writeVideo;

constexpr int kPictures = 20;

class VideoSourceTest : public ImageSourceTest {
 protected:
  static std::vector<cv::Mat> pictures(int count = kPictures) {
    std::vector<cv::Mat> result;
    for (int k = 0; k < count; ++k) result.push_back(numbered(k));
    return result;
  }
  // With something to damage in every block.
  static std::vector<cv::Mat> noise(int count) {
    std::vector<cv::Mat> result;
    cv::RNG dice(7);
    for (int k = 0; k < count; ++k) {
      cv::Mat picture(48, 64, CV_8UC3);
      dice.fill(picture, cv::RNG::UNIFORM, 0, 255);
      result.push_back(picture);
    }
    return result;
  }
  std::string write(const std::string& name, const TestVideo& video, const std::vector<cv::Mat>& images) {
    writeVideo(folder_.file(name), images, video);
    return folder_.file(name);
  }
  static std::size_t lostOf(const std::vector<SourceImage>& images) {
    std::size_t lost = 0;
    for (const SourceImage& image : images) lost += image.error.empty() ? 0 : image.lost;
    return lost;
  }
};

struct Kind {
  const char* name;
  const char* codec;
  int between;
};
const std::vector<Kind> kKinds{{"a.mp4", "mpeg4", 0},     {"b.mp4", "mpeg4", 2},      {"a.mkv", "mpeg4", 2},
                               {"b.mkv", "ffv1", 0},      {"c.mkv", "mjpeg", 0},      {"fast.mp4", "mpeg4", 2},
                               {"a.mp4", "libx264", 2},   {"fast.mp4", "libx264", 2}, {"d.mkv", "libx264", 2},
                               {"a.ts", "mpeg2video", 2}, {"a.avi", "mjpeg", 0}};

TestVideo of(const Kind& kind) {
  TestVideo video;
  video.codec = kind.codec;
  video.between = kind.between;
  video.index_first = std::string(kind.name).find("fast") == 0;
  if (video.codec == "mjpeg") video.pixels = AV_PIX_FMT_YUVJ420P;
  if (video.codec == "mpeg2video" || std::string(kind.name) == "a.avi") {
    video.time_base = {1, 25};
    for (int k = 0; k < kPictures; ++k) video.times.push_back(k);
  }
  return video;
}

TEST_F(VideoSourceTest, GivesEveryPictureOnceWithItsTime) {
  for (const Kind& kind : kKinds) {
    if (!test_support::canEncode(kind.codec)) continue;
    SCOPED_TRACE(std::string(kind.name) + " " + kind.codec);
    const std::string path = write(kind.name, of(kind), pictures());
    const auto images = readAll(path);
    ASSERT_EQ(images.size(), static_cast<std::size_t>(kPictures));
    for (int k = 0; k < kPictures; ++k) {
      EXPECT_EQ(images[k].error, "");
      EXPECT_EQ(numberOf(images[k]), k);
      EXPECT_NEAR(images[k].header.stamp.toSec(), 0.04 * k, 1e-9);
      EXPECT_EQ(images[k].frame, static_cast<std::size_t>(k));
    }
    EXPECT_NEAR(openImageSource(path, {})->rate(), 25.0, 0.1);
    EXPECT_NEAR(static_cast<double>(openImageSource(path, {})->size()), kPictures, 1.0);
    EXPECT_TRUE(openImageSource(path, {})->notes().empty());
  }
}

TEST_F(VideoSourceTest, VariableRateIsAsTheContainerSays) {
  for (const char* name : {"a.mp4", "a.mkv"}) {
    TestVideo video;
    for (int k = 0; k < kPictures; ++k) video.times.push_back(1000 + 10 * k * k);
    const auto images = readAll(write(name, video, pictures()));
    ASSERT_EQ(images.size(), static_cast<std::size_t>(kPictures)) << name;
    for (int k = 0; k < kPictures; ++k) EXPECT_NEAR(images[k].header.stamp.toSec(), 0.01 * k * k, 1e-9) << name << k;
    SourceOptions options;
    options.start = 0.36;  // picture 6
    const auto later = readAll(folder_.file(name), options);
    ASSERT_EQ(later.size(), 14u) << name;
    EXPECT_EQ(later[0].frame, 6u);
    EXPECT_EQ(numberOf(later[0]), 6);
  }
}

// `rate`: units of time a second.
TestVideo mjpegOf(int rate) {
  TestVideo video;
  video.codec = "mjpeg";
  video.pixels = AV_PIX_FMT_YUVJ420P;
  video.time_base = {1, rate};
  video.rate = {rate, 1};
  return video;
}

TEST_F(VideoSourceTest, AnAviMayLeaveOutPicturesAndHoldH264) {
  TestVideo video = mjpegOf(20);
  for (int k = 0; k < kPictures; ++k) video.times.push_back(k < 10 ? k : k + 7);
  auto images = readAll(write("gap.avi", video, pictures()));
  ASSERT_EQ(images.size(), static_cast<std::size_t>(kPictures));
  for (int k = 0; k < kPictures; ++k) EXPECT_NEAR(images[k].header.stamp.toSec(), (k < 10 ? k : k + 7) / 20.0, 1e-9);
  if (!test_support::canEncode("libx264")) GTEST_SKIP() << "this libav has no encoder for H.264";
  video.codec = "libx264";
  video.pixels = AV_PIX_FMT_YUV420P;
  video.times.clear();
  for (int k = 0; k < kPictures; ++k) video.times.push_back(k);
  for (const int between : {0, 2}) {
    video.between = between;
    images = readAll(write("h264.avi", video, pictures()));
    ASSERT_EQ(images.size(), static_cast<std::size_t>(kPictures));
    for (int k = 0; k < kPictures; ++k) {
      EXPECT_EQ(images[k].error, "");
      EXPECT_NEAR(images[k].header.stamp.toSec(), k / 20.0, 1e-9) << between;
      EXPECT_EQ(numberOf(images[k]), k);
    }
    EXPECT_NEAR(openImageSource(folder_.file("h264.avi"), {})->rate(), 20.0, 0.1);
  }
}

// As of H.264, whose unit of time is half a picture.
TEST_F(VideoSourceTest, AnAviWhosePicturesLastLongerThanItsUnitOfTimeIsWholeOrNot) {
  TestVideo video = mjpegOf(50);
  for (const int units : {2, 3, 5}) {
    SCOPED_TRACE(units);
    video.times.clear();
    for (int k = 0; k < kPictures; ++k) video.times.push_back(units * k);
    const std::string path = write("whole.avi", video, pictures());
    // The muxer ends with the last picture; other programs count all of its units.
    for (const std::int32_t length : {units * (kPictures - 1) + 1, units * kPictures}) {
      test_support::setAviLength(path, length);
      const auto images = readAll(path);
      EXPECT_EQ(images.size(), static_cast<std::size_t>(kPictures)) << length;
      EXPECT_EQ(lostOf(images), 0u) << images.back().error;
    }
    test_support::setAviLength(path, units * (kPictures + 3));
    const auto cut = readAll(path);
    EXPECT_EQ(lostOf(cut), 3u) << cut.back().error;
    EXPECT_NE(cut.back().error.find("breaks off"), std::string::npos) << cut.back().error;
  }
}

// An arrow that points right, red on the left.
TEST_F(VideoSourceTest, IsTurnedAsAPlayerTurnsIt) {
  cv::Mat stored(48, 64, CV_8UC3, cv::Scalar::all(128));
  stored(cv::Rect(0, 0, 16, 16)) = cv::Scalar(0, 0, 255);   // top left: red
  stored(cv::Rect(48, 0, 16, 16)) = cv::Scalar(255, 0, 0);  // top right: blue
  for (const bool mirrored : {false, true}) {
    for (const int degrees : {0, 90, 180, 270}) {
      SCOPED_TRACE(std::to_string(degrees) + (mirrored ? " mirrored" : ""));
      TestVideo video;
      video.degrees = degrees;
      video.mirrored = mirrored;
      const auto images = readAll(write("turned.mp4", video, {stored, stored}));
      ASSERT_EQ(images.size(), 2u);
      cv::Mat shown = stored.clone();
      if (degrees == 90) cv::rotate(shown, shown, cv::ROTATE_90_CLOCKWISE);
      if (degrees == 180) cv::rotate(shown, shown, cv::ROTATE_180);
      if (degrees == 270) cv::rotate(shown, shown, cv::ROTATE_90_COUNTERCLOCKWISE);
      if (mirrored) cv::flip(shown, shown, 1);
      ASSERT_EQ(images[0].decoded.size(), shown.size());
      EXPECT_LT(cv::norm(images[0].decoded, shown, cv::NORM_L1) / static_cast<double>(shown.total()), 15.0);
    }
  }
}

TEST_F(VideoSourceTest, ColoursAreThoseOfItsTags) {
  const cv::Mat colour(48, 64, CV_8UC3, cv::Scalar(40, 60, 200));
  for (const AVColorSpace matrix : {AVCOL_SPC_UNSPECIFIED, AVCOL_SPC_BT470BG, AVCOL_SPC_BT709}) {
    for (const AVColorRange range : {AVCOL_RANGE_UNSPECIFIED, AVCOL_RANGE_MPEG, AVCOL_RANGE_JPEG}) {
      TestVideo video;
      video.codec = "ffv1";
      video.matrix = matrix;
      video.range = range;
      const auto images = readAll(write("colour.mkv", video, {colour, colour}));
      ASSERT_EQ(images.size(), 2u);
      const cv::Scalar mean = cv::mean(images[0].decoded);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], (cv::Scalar(40, 60, 200)[k]), 4.0) << matrix << ' ' << range;
    }
  }
}

TEST_F(VideoSourceTest, PixelsThatAreNotSquareStayAndAreTold) {
  TestVideo video;
  video.pixel_aspect = {16, 11};
  const std::string path = write("wide.mp4", video, pictures());
  const auto source = openImageSource(path, {});
  const auto image = source->next();
  ASSERT_TRUE(image);
  EXPECT_EQ(image->decoded.size(), cv::Size(64, 48));
  ASSERT_EQ(source->notes().size(), 1u);
  EXPECT_TRUE(mentions(source->notes()[0], "1.455 times as wide as high"));
}

TEST_F(VideoSourceTest, AFileThatIsCutOffTellsWhatIsMissing) {
  for (const Kind& kind : kKinds) {
    if (std::string(kind.name).find(".ts") != std::string::npos) continue;  // says nowhere how long it is
    if (!test_support::canEncode(kind.codec)) continue;
    for (const double share : {0.25, 0.5, 0.9}) {
      SCOPED_TRACE(std::string(kind.name) + " " + kind.codec + " " + std::to_string(share));
      const std::string path = write(kind.name, of(kind), noise(kPictures));
      std::string bytes = test_support::bytesOf(path);
      const auto places = test_support::packetsOf(path);
      // Behind the header of an MP4, which then has to come first.
      const std::size_t end = places.back().at + places.back().size;
      std::string cut =
          bytes.substr(0, places[0].at + static_cast<std::size_t>(share * static_cast<double>(end - places[0].at)));
      test_support::writeBytes(path, cut);
      std::vector<SourceImage> images;
      const std::string error = errorOf(path);
      if (!error.empty()) {  // an MP4 without its index
        EXPECT_TRUE(mentions(error, kind.name)) << error;
        continue;
      }
      images = readAll(path);
      ASSERT_FALSE(images.empty());
      EXPECT_FALSE(images.back().error.empty());
      EXPECT_TRUE(mentions(images.back().error, "breaks off")) << images.back().error;
      const std::size_t lost = lostOf(images);
      EXPECT_NEAR(static_cast<double>(lost), (1.0 - share) * kPictures, 4.0);
      for (const SourceImage& image : images) EXPECT_TRUE(image.error.empty() || image.decoded.empty());
    }
  }
}

TEST_F(VideoSourceTest, AFileThatIsCutBetweenTwoPicturesTellsItToo) {
  for (const Kind& kind : kKinds) {
    const std::string name = kind.name;
    if (!test_support::canEncode(kind.codec) || name == "a.mp4" || name == "b.mp4" || name == "a.ts") continue;
    SCOPED_TRACE(name + " " + kind.codec);
    const std::string path = write(name, of(kind), noise(kPictures));
    const auto places = test_support::packetsOf(path);
    test_support::writeBytes(path, test_support::bytesOf(path).substr(0, places[10].at));
    const auto images = readAll(path);
    ASSERT_FALSE(images.empty());
    EXPECT_TRUE(mentions(images.back().error, "breaks off")) << images.back().error;
    EXPECT_NEAR(static_cast<double>(lostOf(images)), kPictures - 10.0, 2.0) << "some came in another order";
  }
}

TEST_F(VideoSourceTest, DamagedPicturesAreNamedWithTheirPlace) {
  for (const Kind& kind : kKinds) {
    if (!test_support::canEncode(kind.codec)) continue;
    SCOPED_TRACE(std::string(kind.name) + " " + kind.codec);
    const std::string path = write(kind.name, of(kind), noise(kPictures));
    const auto places = test_support::packetsOf(path);
    std::string bytes = test_support::bytesOf(path);
    const auto& place = places.at(places.size() / 2);
    // From its beginning on: noise in the middle may by chance be a picture to a decoder.
    for (std::size_t k = 0; k < place.size * 3 / 4; ++k) bytes[place.at + k] = static_cast<char>(0xA5 + 37 * k);
    test_support::writeBytes(path, bytes);
    const auto images = readAll(path);
    EXPECT_GE(lostOf(images), 1u);
    EXPECT_LE(lostOf(images), 12u);
    std::size_t count = 0;
    for (const SourceImage& image : images) {
      if (!image.error.empty()) {
        EXPECT_TRUE(mentions(image.error, kind.name) && mentions(image.error, " s of ")) << image.error;
        EXPECT_NEAR(image.header.stamp.toSec(), 0.4, 0.3);
      }
      count += image.error.empty() ? 1 : image.lost;
    }
    EXPECT_EQ(count, static_cast<std::size_t>(kPictures)) << "each is either given or told";
    EXPECT_TRUE(images.back().error.empty());
  }
}

// The decoder conceals it with the picture before, so that it looks like a picture; the tracker must not see it.
TEST_F(VideoSourceTest, DamageInTheMiddleOfAPictureIsTold) {
  if (!test_support::canEncode("libx264")) GTEST_SKIP() << "libav cannot write H.264 here";
  cv::Mat scene(540, 720, CV_8UC3), noise(480, 640, CV_8UC3);
  cv::RNG dice(3);
  dice.fill(scene, cv::RNG::UNIFORM, 0, 255);
  cv::GaussianBlur(scene, scene, cv::Size(), 2.0);
  cv::normalize(scene, scene, 20, 235, cv::NORM_MINMAX);
  std::vector<cv::Mat> images;
  for (int k = 0; k < kPictures; ++k) {
    dice.fill(noise, cv::RNG::UNIFORM, 0, 20);
    images.push_back(scene(cv::Rect(2 * k, k, 640, 480)) + noise);
  }
  TestVideo video;
  video.codec = "libx264";
  video.between = 2;
  const std::string path = write("film.mp4", video, images);
  const auto places = test_support::packetsOf(path);
  const std::string whole = test_support::bytesOf(path);
  int damaged = 0, told = 0;
  for (const auto& place : places) {
    if (place.size < 800) continue;  // bits of few blocks may by chance be others
    std::string bytes = whole;
    for (std::size_t k = place.size / 3; k < place.size * 2 / 3; ++k) bytes[place.at + k] ^= 0x5A;
    test_support::writeBytes(path, bytes);
    ++damaged;
    told += lostOf(readAll(path)) > 0 ? 1 : 0;
  }
  EXPECT_GE(damaged, 5);
  EXPECT_GE(told, 0.8 * damaged) << damaged << " pictures were damaged, one a time";
}

// Where the damage is in what the container says of its packets, nothing comes of them at all.
TEST_F(VideoSourceTest, PicturesThatADamagedContainerHidesAreToldToo) {
  for (const char* codec : {"mjpeg", "mpeg4"}) {
    TestVideo video;
    video.codec = codec;
    if (video.codec == "mjpeg") video.pixels = AV_PIX_FMT_YUVJ420P;
    const std::string path = write("film.mkv", video, noise(kPictures));
    const auto places = test_support::packetsOf(path);
    std::string bytes = test_support::bytesOf(path);
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(places[8].at), places[8].size, 'Z');
    test_support::writeBytes(path, bytes);
    const auto images = readAll(path);
    EXPECT_GE(lostOf(images), 1u);
    std::size_t count = 0;
    for (const SourceImage& image : images) {
      const double time = image.header.stamp.toSec();
      EXPECT_TRUE(image.error.empty() || std::abs(time - 0.32) < 0.1) << image.error;
      EXPECT_TRUE(count < 12 || std::abs(time - 0.04 * static_cast<double>(image.frame)) < 1e-6) << time;
      count += image.error.empty() ? 1 : image.lost;
    }
    EXPECT_EQ(count, static_cast<std::size_t>(kPictures)) << codec;
  }
}

TEST_F(VideoSourceTest, AChangeOfSizeIsGivenAsItIs) {
  std::vector<cv::Mat> large;
  for (int k = 10; k < 20; ++k) large.push_back(cv::Mat(96, 128, CV_8UC3, cv::Scalar::all(10 * (k + 1))));
  for (const auto& [codec, ending] : {std::pair{"mjpeg", ".mjpg"}, {"libx264", ".ts"}}) {
    if (!test_support::canEncode(codec)) continue;
    SCOPED_TRACE(codec);
    TestVideo video;
    video.codec = codec;
    if (video.codec == "mjpeg") video.pixels = AV_PIX_FMT_YUVJ420P;
    const std::string small = write(std::string("small") + ending, video, pictures(10));
    const std::string big = write(std::string("large") + ending, video, large);
    const std::string both = folder_.file(std::string("both") + ending);
    test_support::writeBytes(both, test_support::bytesOf(small) + test_support::bytesOf(big));
    const auto source = openImageSource(both, {});
    std::vector<SourceImage> images;
    while (auto image = source->next()) images.push_back(*image);
    ASSERT_EQ(images.size(), 20u);
    for (int k = 0; k < 20; ++k) {
      EXPECT_EQ(images[k].error, "");
      EXPECT_EQ(images[k].decoded.size(), k < 10 ? cv::Size(64, 48) : cv::Size(128, 96)) << k;
      EXPECT_EQ(numberOf(images[k]), k);
      EXPECT_NEAR(images[k].header.stamp.toSec(), 0.04 * k, 1e-6) << "times that begin again go on";
    }
    // Of a raw stream libav counts the times itself.
    EXPECT_EQ(source->notes().size(), std::string(ending) == ".ts" ? 1u : 0u);
  }
}

TEST_F(VideoSourceTest, ANameIsAFileAndNoAddress) {
  const std::string path = write("plain.mkv", {}, pictures(3));
  for (const char* name : {"10:00:00.mkv", "http:", "concat:x|y", "%d.mkv", "a b'c.mkv", "-"}) {
    std::filesystem::copy_file(path, folder_.file(name));
    EXPECT_EQ(readAll(folder_.file(name)).size(), 3u) << name;
  }
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder_.path());
  EXPECT_EQ(readAll("10:00:00.mkv").size(), 3u);
  std::filesystem::current_path(before);
}

TEST_F(VideoSourceTest, APlaylistDoesNotReachTheNetwork) {
  const std::string list = writeFile("list.m3u8",
                                     "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\nhttp://127.0.0.1:9/x.ts\n"
                                     "#EXT-X-ENDLIST\n");
  EXPECT_TRUE(mentions(errorOf(list), "list.m3u8"));
}

}  // namespace
}  // namespace laparoscope_servo
