// Which of several poses is taken, and which is refused.
#include "model/model_start.h"

#include <gtest/gtest.h>

#include "support/synthetic_model.h"

namespace laparoscope_servo::model {
namespace {

using features::Reason;

class ModelStartTest : public ::testing::Test {
 protected:
  Outline startOf(const std::shared_ptr<const CadModel>& model, const Eigen::Isometry3d& truth,
                  const Eigen::Vector3d& turn) const {
    Eigen::Isometry3d pose = truth;
    pose.linear() = geometry::so3Exp(turn) * pose.linear();
    pose.translation() = truth * model->centre - pose.linear() * model->centre;
    return Outline(model, scene_.camera, scene_.size, pose);
  }
  test::ModelScene scene_;
  ModelConfig config_;
};

TEST_F(ModelStartTest, aWrongStartEndsAtTheTruth) {
  const auto model = test::modelOf(test::kCube);
  const Eigen::Isometry3d truth = test::viewOf(*model, 0.42);
  const cv::Mat image = test::ModelRenderer(*model, scene_).draw(truth, 1);
  for (const Eigen::Vector3d& turn :
       {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.45, -0.4, 0.3), Eigen::Vector3d(-0.5, -0.2, -0.5)}) {
    Outline outline = startOf(model, truth, turn);
    features::EdgeFit fit(config_.edges);
    const StartResult result = ModelStart(config_).find(image, outline, fit);
    EXPECT_EQ(result.report.reason, Reason::kNone) << features::reasonText(result.report.reason);
    EXPECT_LT(outline.apart(truth), 0.3) << turn.transpose();
    EXPECT_GT(result.report.share, 0.75);
  }
}

// Two equal pictures of a cube side by side, the start between them: the image does not say which one is meant.
TEST_F(ModelStartTest, whatCannotBeToldApartIsRefusedByName) {
  const auto model = test::modelOf(test::kCube);
  const Eigen::Isometry3d middle = test::viewOf(*model, 0.7);
  const cv::Mat one = test::ModelRenderer(*model, scene_).draw(middle, 1);
  constexpr int kShift = 44;  // px
  cv::Mat image(scene_.size, CV_8UC1, cv::Scalar(90));
  one(cv::Rect(kShift, 0, 160, 240)).copyTo(image(cv::Rect(0, 0, 160, 240)));
  one(cv::Rect(160 - kShift, 0, 160, 240)).copyTo(image(cv::Rect(160, 0, 160, 240)));
  config_.start_shift = 1.8;
  Outline outline(model, scene_.camera, scene_.size, middle);
  features::EdgeFit fit(config_.edges);
  const StartResult result = ModelStart(config_).find(image, outline, fit);
  EXPECT_EQ(result.report.reason, Reason::kAmbiguous) << features::reasonText(result.report.reason);
  EXPECT_GT(result.other_evidence, 0.8 * result.report.evidence);
}

// A texture without the model: some pose agrees with it best, none by more than chance.
TEST_F(ModelStartTest, anImageWithoutTheModelIsRefused) {
  const auto model = test::modelOf(test::kCube);
  const Eigen::Isometry3d pose = test::viewOf(*model, 0.42);
  for (unsigned seed = 1; seed <= 40; ++seed) {
    cv::Mat1f grain(scene_.size);
    cv::RNG rng(seed);
    rng.fill(grain, cv::RNG::NORMAL, 0.0, 1.0);
    cv::GaussianBlur(grain, grain, cv::Size(), 3.0);
    cv::Mat image;
    grain.convertTo(image, CV_8UC1, 25.0 * 3.545 * 3.0, 110.0);
    Outline outline(model, scene_.camera, scene_.size, pose);
    features::EdgeFit fit(config_.edges);
    EXPECT_NE(ModelStart(config_).find(image, outline, fit).report.reason, Reason::kNone) << seed;
  }
  Outline outline(model, scene_.camera, scene_.size, pose);
  features::EdgeFit fit(config_.edges);
  const cv::Mat grey(scene_.size, CV_8UC1, cv::Scalar(100));
  EXPECT_EQ(ModelStart(config_).find(grey, outline, fit).report.reason, Reason::kNotSeen);
}

}  // namespace
}  // namespace laparoscope_servo::model
