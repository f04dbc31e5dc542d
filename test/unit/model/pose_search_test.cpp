// Candidates about a pose that is known badly.
#include "model/pose_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/synthetic_model.h"

namespace laparoscope_servo::model {
namespace {

class PoseSearchTest : public ::testing::Test {
 protected:
  PoseSearchTest()
      : model_(test::modelOf(test::kCube)), truth_(test::viewOf(*model_, 0.45)), renderer_(*model_, scene_) {
    image_ = renderer_.draw(truth_, 1);
  }
  // Turned about the model's centre, and moved.
  Outline start(const Eigen::Vector3d& turn, const Eigen::Vector3d& shift) const {
    Eigen::Isometry3d pose = truth_;
    pose.linear() = geometry::so3Exp(turn) * pose.linear();
    pose.translation() = truth_ * model_->centre + shift - pose.linear() * model_->centre;
    return Outline(model_, scene_.camera, scene_.size, pose);
  }
  double best(const Outline& outline, const PoseRange& range) {
    const auto found = search_.find(image_, outline, range, 8.0, 8);
    double least = 1e9;
    for (const PoseCandidate& one : found) {
      least = std::min(least, Outline(model_, scene_.camera, scene_.size, one.camera_T_object).apart(truth_));
    }
    return least;
  }

  test::ModelScene scene_;
  std::shared_ptr<const CadModel> model_;
  Eigen::Isometry3d truth_;
  test::ModelRenderer renderer_;
  cv::Mat image_;
  PoseSearch search_;
};

TEST_F(PoseSearchTest, theTruthIsAmongTheCandidates) {
  const PoseRange range{0.52, 1.0};
  EXPECT_LT(best(start({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}), range), 2.5);
  EXPECT_LT(best(start({0.4, -0.3, 0.2}, {0.0, 0.0, 0.0}), range), 2.5);
  EXPECT_LT(best(start({-0.5, 0.4, -0.4}, {0.03, -0.02, 0.04}), range), 2.5);
}

// However large the model is in the image: what follows looks for edges within 6 px.
TEST_F(PoseSearchTest, theTruthOfALargeModelIsAmongTheCandidates) {
  const auto model = test::modelOf(test::kCubeAndTube);
  test::ModelScene scene;
  scene.camera = {547.0, 547.0, 319.5, 239.5};
  scene.size = {640, 480};
  scene.texture = scene.clutter = 8.0;
  const test::ModelRenderer renderer(*model, scene);
  for (int view = 0; view < 4; ++view) {
    const Eigen::Isometry3d truth = test::viewOf(*model, 0.4 + 0.04 * view, 0.5 + 0.2 * view);
    const cv::Mat image = renderer.draw(truth, 1);
    for (const Eigen::Vector3d& turn : {Eigen::Vector3d(0.2, -0.1, 0.15), Eigen::Vector3d(-0.3, 0.2, -0.25)}) {
      Eigen::Isometry3d pose = truth;
      pose.linear() = geometry::so3Exp(turn) * pose.linear();
      pose.translation() = truth * model->centre - pose.linear() * model->centre;
      const auto found = search_.find(image, Outline(model, scene.camera, scene.size, pose), {0.52, 1.0}, 8.0, 12);
      double least = 1e9;
      for (const PoseCandidate& one : found) {
        least = std::min(least, Outline(model, scene.camera, scene.size, one.camera_T_object).apart(truth));
      }
      EXPECT_LT(least, 1.2) << view << ": " << turn.transpose();
    }
  }
}

TEST_F(PoseSearchTest, noCandidateIsTurnedFurtherThanAsked) {
  const Outline outline = start({0.2, 0.0, 0.0}, {0.0, 0.0, 0.0});
  for (const PoseCandidate& one : search_.find(image_, outline, {0.2, 0.5}, 8.0, 20)) {
    const Eigen::Vector3d turned = geometry::so3Log(one.camera_T_object.linear() * outline.pose().linear().transpose());
    EXPECT_LT(turned.cwiseAbs().maxCoeff(), 0.2 + 8.0 * M_PI / 180.0);
  }
}

TEST_F(PoseSearchTest, candidatesAreSortedAndApart) {
  const Outline outline = start({0.3, 0.2, 0.1}, {0.0, 0.0, 0.0});
  const auto found = search_.find(image_, outline, {0.52, 1.0}, 8.0, 8);
  ASSERT_GT(found.size(), 1u);
  for (std::size_t k = 1; k < found.size(); ++k) {
    EXPECT_GE(found[k - 1].score, found[k].score);
    const Outline other(model_, scene_.camera, scene_.size, found[k].camera_T_object);
    for (std::size_t i = 0; i < k; ++i) EXPECT_GT(other.apart(found[i].camera_T_object), 1.0);
  }
}

TEST_F(PoseSearchTest, outsideOfTheImageThereIsNone) {
  EXPECT_TRUE(search_.find(image_, start({0.0, 0.0, 0.0}, {2.0, 0.0, 0.0}), {0.5, 1.0}, 8.0, 8).empty());
}

TEST_F(PoseSearchTest, aPoseThatIsNotFiniteHasNoCandidates) {
  const double nan = std::nan("");
  EXPECT_TRUE(search_.find(image_, start({0.0, 0.0, 0.0}, {nan, 0.0, 0.0}), PoseRange{0.52, 1.0}, 8.0, 8).empty());
  EXPECT_TRUE(search_.find(image_, start({0.0, 0.0, 0.0}, {0.0, 0.0, nan}), PoseRange{0.52, 1.0}, 8.0, 8).empty());
}

}  // namespace
}  // namespace laparoscope_servo::model
