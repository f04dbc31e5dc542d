// Models behind the interface of features: what is told, refused and forgotten.
#include "laparoscope_servo/model/model_feature_tracker.h"

#include <gtest/gtest.h>

#include "support/error_text.h"
#include "support/synthetic_model.h"

namespace laparoscope_servo::model {
namespace {

using features::State;

class ModelFeatureTrackerTest : public ::testing::Test {
 protected:
  ModelFeatureTrackerTest()
      : model_(test::modelOf(test::kCube)),
        truth_(test::viewOf(*model_, 0.45)),
        image_(test::ModelRenderer(*model_, scene_).draw(truth_, 1)),
        tracker_(model_) {
    prior_.camera = scene_.camera;
    features::SelectedFeature cube;
    cube.id = "cube";
    cube.kind = features::FeatureKind::kPose;
    cube.pose = truth_;
    selection_.push_back(cube);
  }
  std::string refusal(const features::FeatureSelection& selection, const features::FeaturePrior& prior) {
    return test_support::errorText<std::invalid_argument>([&] { tracker_.select(image_, 0.0, selection, prior); });
  }

  test::ModelScene scene_;
  std::shared_ptr<const CadModel> model_;
  Eigen::Isometry3d truth_;
  cv::Mat image_;
  ModelFeatureTracker tracker_;
  features::FeaturePrior prior_;
  features::FeatureSelection selection_;
};

TEST_F(ModelFeatureTrackerTest, tellsThePoseWithItsCovarianceAndAnOutline) {
  EXPECT_EQ(tracker_.features().state, State::kIdle);
  tracker_.select(image_, 0.0, selection_, prior_);
  const features::TrackedFeatures& told = tracker_.track(image_, 0.04, prior_);
  EXPECT_EQ(told.state, State::kTracking) << told.reason;
  ASSERT_EQ(told.features.size(), 1u);
  const features::TrackedFeature& cube = told.features[0];
  EXPECT_EQ(cube.id, "cube");
  EXPECT_EQ(cube.kind, features::FeatureKind::kPose);
  EXPECT_LT((cube.parameters.head<3>() - truth_.translation()).norm(), 2e-3);
  EXPECT_LT((cube.parameters.tail<3>() - geometry::so3Log(truth_.linear())).norm(), 1e-2);
  EXPECT_GT(cube.covariance.diagonal().minCoeff(), 0.0);
  EXPECT_LT(cube.expected_error, 1.0);
  EXPECT_GT(cube.sites.size(), 30u);
  ASSERT_GE(cube.outline.size(), 7u);  // a cube that shows three faces has six corners around it
  EXPECT_EQ(cube.outline.front(), cube.outline.back());
  cv::Rect2d around(cube.outline.front().x(), cube.outline.front().y(), 0.0, 0.0);
  for (const Eigen::Vector2d& point : cube.outline) around |= cv::Rect2d(point.x() - 0.5, point.y() - 0.5, 1.0, 1.0);
  for (const features::TrackedSite& site : cube.sites)
    EXPECT_TRUE(around.contains({site.point.x(), site.point.y()})) << site.point.transpose();
}

TEST_F(ModelFeatureTrackerTest, nothingIsKnownOfWhatIsNotSeen) {
  tracker_.select(image_, 0.0, selection_, prior_);
  const cv::Mat grey(scene_.size, CV_8UC1, cv::Scalar(100));
  const features::TrackedFeatures& told = tracker_.track(grey, 0.04, prior_);
  EXPECT_EQ(told.state, State::kSearching);
  EXPECT_EQ(told.reason.rfind("cube: ", 0), 0u) << told.reason;
  EXPECT_TRUE(std::isinf(told.features[0].covariance(0, 0)));
}

TEST_F(ModelFeatureTrackerTest, theCamerasMotionInSpaceIsExpected) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = geometry::so3Exp({0.0, 0.0, 0.4});  // turns the image by 23 degrees
  const cv::Mat turned = test::ModelRenderer(*model_, scene_).draw(motion * truth_, 2);
  tracker_.select(image_, 0.0, selection_, prior_);
  EXPECT_NE(tracker_.track(turned, 0.04, prior_).state, State::kTracking);
  tracker_.select(image_, 0.0, selection_, prior_);
  features::FeaturePrior known = prior_;
  known.camera_motion = motion;
  EXPECT_EQ(tracker_.track(turned, 0.04, known).state, State::kTracking) << tracker_.features().reason;
}

TEST_F(ModelFeatureTrackerTest, whatCannotBeIsRefusedByNameAndTrackingGoesOn) {
  tracker_.select(image_, 0.0, selection_, prior_);
  EXPECT_NE(refusal({}, prior_).find("0 features"), std::string::npos);
  EXPECT_NE(refusal(selection_, {}).find("no camera"), std::string::npos);
  features::FeatureSelection without = selection_;
  without[0].pose.reset();
  EXPECT_EQ(refusal(without, prior_), "cube: no pose, expected one about which the object is looked for");
  without[0].kind = features::FeatureKind::kLine;
  EXPECT_NE(refusal(without, prior_).find("pose"), std::string::npos);
  EXPECT_EQ(tracker_.track(image_, 0.04, prior_).state, State::kTracking);
}

TEST_F(ModelFeatureTrackerTest, anotherCameraAndAnotherImageEndIt) {
  tracker_.select(image_, 0.0, selection_, prior_);
  features::FeaturePrior other = prior_;
  other.camera->fx += 1.0;
  EXPECT_EQ(tracker_.track(image_, 0.04, other).state, State::kIdle);
  EXPECT_NE(tracker_.features().reason.find("camera"), std::string::npos);
  tracker_.select(image_, 0.0, selection_, prior_);
  EXPECT_EQ(tracker_.track(image_(cv::Rect(0, 0, 300, 240)).clone(), 0.04, prior_).state, State::kIdle);
  EXPECT_TRUE(tracker_.features().features.empty());
  tracker_.select(image_, 0.0, selection_, prior_);
  tracker_.reset();
  EXPECT_EQ(tracker_.features().state, State::kIdle);
}

}  // namespace
}  // namespace laparoscope_servo::model
