#include "tracking/roi_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "support/error_text.h"
#include "support/synthetic_tissue.h"

namespace laparoscope_servo::tracking {
namespace {

const cv::Mat kImage(120, 160, CV_8UC1, cv::Scalar(90));

// What is said against the ROI; empty when nothing is.
std::string refusal(const geometry::Rectangle& roi, const image::Lens* lens = nullptr) {
  return test_support::errorText<std::invalid_argument>([&] { checkedRoi(kImage, roi, 16, lens); });
}

image::Lens barrel() {
  image::LensParameters parameters;
  parameters.coefficients = {-0.3};
  parameters.raw.fx = parameters.raw.fy = 120.0;
  parameters.raw.cx = 79.5;
  parameters.raw.cy = 59.5;
  parameters.rectified = parameters.raw;
  return image::Lens(parameters);
}

TEST(CheckImage, RefusesWhatIsEmptyOrOfAnotherTypeByName) {
  EXPECT_NO_THROW(checkImage(kImage));
  EXPECT_NO_THROW(checkImage(cv::Mat(4, 4, CV_8UC3)));
  EXPECT_THROW(checkImage(cv::Mat()), std::invalid_argument);
  EXPECT_THROW(checkImage(cv::Mat(4, 4, CV_32FC1)), std::invalid_argument);
  EXPECT_THROW(checkImage(cv::Mat(4, 4, CV_8UC4)), std::invalid_argument);
}

TEST(CheckedRoi, IsInWholePixels) {
  const geometry::Rectangle roi = checkedRoi(kImage, {10.9, 20.2, 30.7, 16.0}, 16, nullptr);
  EXPECT_EQ(roi.x, 10.0);
  EXPECT_EQ(roi.y, 20.0);
  EXPECT_EQ(roi.width, 30.0);
  EXPECT_EQ(roi.height, 16.0);
}

TEST(CheckedRoi, MayFillTheImageAndNoMore) {
  EXPECT_EQ(refusal({0, 0, 160, 120}), "");
  EXPECT_NE(refusal({0, 0, 161, 120}), "");
  EXPECT_NE(refusal({0, 1, 160, 120}), "");
  EXPECT_NE(refusal({-1, 0, 100, 100}), "");
}

TEST(CheckedRoi, NamesTheRoiAndWhatWasExpected) {
  EXPECT_EQ(refusal({1, 2, 15.5, 50}),
            "ROI x=1 y=2 width=15.5 height=50 is too small, expected at least 16 px in width and height");
  EXPECT_EQ(refusal({100, 2, 90, 50}), "ROI x=100 y=2 width=90 height=50 is not inside the image of 160 x 120 px");
}

TEST(CheckedRoi, RefusesWhatIsNotFinite) {
  const double nan = std::nan("");
  const double infinity = std::numeric_limits<double>::infinity();
  const image::Lens lens = barrel();
  for (const image::Lens* through : {static_cast<const image::Lens*>(nullptr), &lens}) {
    for (const double value : {nan, infinity, -infinity}) {
      EXPECT_NE(refusal({value, 30, 40, 40}, through), "");
      EXPECT_NE(refusal({30, value, 40, 40}, through), "");
      EXPECT_NE(refusal({30, 30, value, 40}, through), "");
      EXPECT_NE(refusal({30, 30, 40, value}, through), "");
    }
  }
}

// A barrel shows more than a pinhole camera: rectified pixels beyond the size of the image.
TEST(CheckedRoi, WithALensIsInsideWhatTheLensShows) {
  const image::Lens lens = barrel();
  const geometry::Rectangle beside = {-6, 40, 40, 40};
  EXPECT_NE(refusal(beside), "");
  EXPECT_EQ(refusal(beside, &lens), "");
  EXPECT_NE(refusal({-200, 40, 40, 40}, &lens).find("rectified"), std::string::npos);
  EXPECT_NE(refusal({0, 0, 1e9, 1e9}, &lens), "");
}

TEST(CheckClearOfInstruments, RefusesWhatIsMostlyCoveredAndSaysByHowMuch) {
  cv::Mat instruments = cv::Mat::zeros(kImage.size(), CV_8UC1);
  instruments(cv::Rect(0, 0, 80, 120)).setTo(255);
  EXPECT_NO_THROW(checkClearOfInstruments({70, 20, 40, 40}, instruments, nullptr));
  EXPECT_NO_THROW(checkClearOfInstruments({100, 20, 40, 40}, instruments, nullptr));
  EXPECT_NO_THROW(checkClearOfInstruments({10, 20, 40, 40}, cv::Mat(), nullptr));
  try {
    checkClearOfInstruments({50, 20, 40, 40}, instruments, nullptr);
    FAIL() << "a region on an instrument was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()),
              "ROI x=50 y=20 width=40 height=40 lies on an instrument by 75 %, expected at most 50 %");
  }
}

// A barrel shows what lies at the border of the rectified image further inside: there the instrument has to be.
TEST(CheckClearOfInstruments, WithALensTheRegionIsWhereItIsSeen) {
  const image::Lens lens = barrel();
  const geometry::Rectangle roi = {0, 40, 16, 40};
  cv::Mat instruments = cv::Mat::zeros(kImage.size(), CV_8UC1);
  instruments(image::seenBox(&lens, roi.corners(), 0.0)).setTo(255);
  EXPECT_NO_THROW(checkClearOfInstruments(roi, instruments, nullptr));
  EXPECT_THROW(checkClearOfInstruments(roi, instruments, &lens), std::invalid_argument);
}

TEST(CheckedCornerError, IsLargerTheLessTextureThereIs) {
  const geometry::Rectangle roi = {40, 30, 80, 80};
  const cv::Mat scene = test::tissue(cv::Size(160, 140), 5);
  cv::Mat faint;
  scene.convertTo(faint, CV_8UC3, 0.25, 60.0);
  RegionAligner clear_one{TrackerConfig()}, faint_one{TrackerConfig()}, flat{TrackerConfig()};
  clear_one.setReference(scene, roi);
  faint_one.setReference(faint, roi);
  flat.setReference(cv::Mat(scene.size(), CV_8UC3, cv::Scalar(90, 90, 90)), roi);
  const double clear_error = checkedCornerError(clear_one, 100.0);
  const double faint_error = checkedCornerError(faint_one, 100.0);
  EXPECT_GT(clear_error, 0.0);
  EXPECT_GT(faint_error, 2.0 * clear_error);
  EXPECT_THROW(checkedCornerError(faint_one, 0.9 * faint_error), std::invalid_argument);
  try {
    checkedCornerError(flat, 100.0);
    FAIL() << "a region without texture was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("width=80"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("expected at most 100"), std::string::npos) << error.what();
  }
}

// Noise has gradients, too, and by them a smooth region in a noisy image would be as good as any.
TEST(CheckedCornerError, DoesNotTakeNoiseForTexture) {
  const geometry::Rectangle roi = {40, 30, 80, 80};
  for (const double sigma : {2.0, 5.0, 10.0}) {
    RegionAligner noisy{TrackerConfig()};
    const cv::Mat flat(140, 160, CV_8UC3, cv::Scalar(90, 90, 90));
    noisy.setReference(test::view(flat, Eigen::Matrix3d::Identity(), 1.0, 0.0, sigma, 7), roi);
    EXPECT_THROW(checkedCornerError(noisy, 10.0), std::invalid_argument) << sigma;
  }
}

TEST(CheckedCornerError, IsThatOfTheImagesOwnNoiseWhereThatIsMoreThanUsual) {
  const geometry::Rectangle roi = {40, 30, 80, 80};
  const cv::Mat scene = test::tissue(cv::Size(160, 140), 5);
  RegionAligner clean{TrackerConfig()}, noisy{TrackerConfig()};
  clean.setReference(scene, roi);
  noisy.setReference(test::view(scene, Eigen::Matrix3d::Identity(), 1.0, 0.0, 20.0, 7), roi);
  const double clean_error = checkedCornerError(clean, 100.0);
  const double noisy_error = checkedCornerError(noisy, 100.0);
  EXPECT_GT(noisy_error, 2.0 * clean_error);
  try {
    checkedCornerError(noisy, 0.5 * noisy_error);
    FAIL() << "the limit was not kept";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()).find(" 2 grey levels"), std::string::npos) << error.what();
  }
}

// Stripes that repeat within the range that blocks are searched in determine a motion, up to a period.
TEST(CheckTellingBlocks, RefusesWhereEveryPieceLooksLikeItsNeighbour) {
  cv::Mat scene(140, 160, CV_8UC3);
  for (int j = 0; j < scene.rows; ++j) {
    for (int i = 0; i < scene.cols; ++i)
      scene.at<cv::Vec3b>(j, i) = cv::Vec3b::all(cv::saturate_cast<uchar>(110 + 30 * std::sin(i) + 30 * std::sin(j)));
  }
  RegionAligner periodic{TrackerConfig()}, tissue{TrackerConfig()}, small{TrackerConfig()};
  periodic.setReference(scene, {40, 30, 80, 80});
  EXPECT_NO_THROW(checkedCornerError(periodic, 0.5));
  try {
    checkTellingBlocks(periodic);
    FAIL() << "a region that repeats was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(
        std::string(error.what()),
        "ROI x=40 y=30 width=80 height=80 has too little texture: 0 of 36 pieces differ from what surrounds them, "
        "expected at least 8");
  }
  tissue.setReference(test::tissue(cv::Size(160, 140), 5), {40, 30, 80, 80});
  EXPECT_NO_THROW(checkTellingBlocks(tissue));
  small.setReference(scene, {40, 30, 24, 80});  // without room for blocks
  EXPECT_NO_THROW(checkTellingBlocks(small));
}

TEST(TakeReference, MakesEveryCheckAndLeavesTheMasksPixelsOut) {
  const cv::Mat scene = test::tissue(cv::Size(160, 140), 5);
  const geometry::Rectangle wanted = {40.6, 30.2, 80.0, 80.9};
  TrackerConfig config;
  RegionAligner aligner(config);
  const double error = takeReference(scene, wanted, cv::Mat(), config, nullptr, aligner);
  EXPECT_EQ(aligner.roi().x, 40.0);
  EXPECT_EQ(aligner.roi().height, 80.0);
  EXPECT_GT(error, 0.0);

  cv::Mat1b mask = cv::Mat1b::zeros(scene.size());
  mask(cv::Rect(40, 30, 40, 80)).setTo(255);
  RegionAligner half(config);
  EXPECT_GT(takeReference(scene, wanted, mask, config, nullptr, half), error);
  EXPECT_LT(cv::mean(half.weights())[0], 0.6 * cv::mean(aligner.weights())[0]);

  const auto refused = [&](const cv::Mat& image, const geometry::Rectangle& roi, const cv::Mat& covered) {
    RegionAligner other(config);
    EXPECT_THROW(takeReference(image, roi, covered, config, nullptr, other), std::invalid_argument);
  };
  refused(cv::Mat(), wanted, cv::Mat());
  refused(scene, {100, 30, 80, 80}, cv::Mat());
  refused(scene, wanted, cv::Mat1b::zeros(10, 10));
  refused(cv::Mat(scene.size(), CV_8UC3, cv::Scalar(90, 90, 90)), wanted, cv::Mat());
  config.min_texture = 0.9 * error;
  refused(scene, wanted, cv::Mat());
}

}  // namespace
}  // namespace laparoscope_servo::tracking
