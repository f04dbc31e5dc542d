// What the cart sees: the tracker of the situation, what is selected for it, and how far that is from its place.
#include <algorithm>
#include <limits>

#include "fault_cart.h"
#include "laparoscope_servo/SelectFeatures.h"
#include "laparoscope_servo/SelectRoi.h"
#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/sim/arm.h"
#include "support/service_call.h"

namespace laparoscope_servo::test {

namespace {

constexpr int kRoiX = 260, kRoiY = 180, kRoiSide = 120;  // px
constexpr double kPan = 0.16;                            // rad, from where the region is seen in its place
constexpr double kHand = 0.4;                            // s, that a hand takes
// s, where features are tracked from image to image and must not be lost on the way, which is 140 px.
constexpr double kSlowHand = 2.0;

}  // namespace

double FaultCart::offset() const {
  if (by_features_ != nullptr)
    return features_ ? by_features_->offset(*features_) : std::numeric_limits<double>::infinity();
  if (!homography_ || homography_->state != Homography::TRACKING) return std::numeric_limits<double>::infinity();
  double x = 0.0, y = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    x += homography_->corners[2 * k] / 4.0;
    y += homography_->corners[2 * k + 1] / 4.0;
  }
  const double middle = (kRoiSide - 1) / 2.0;
  return std::hypot(x - kRoiX - middle, y - kRoiY - middle);
}

// Only one tracker runs: they would take each other's time.
void FaultCart::use(Situation situation) {
  const FeatureTask* wanted = nullptr;
  if (situation == Situation::kFollow) wanted = &kFollowTask;
  if (situation == Situation::kPoints) wanted = &kPointsTask;
  if (wanted == by_features_) return;
  by_features_ = wanted;
  tracker.reset();
  startTracker();
}

// Features are selected anew each time: of an object that was lost nothing is believed any more.
std::string FaultCart::select() {
  const std::string node = by_features_->node, file = bench.file("home.png");
  if (!ros::service::waitForService(node + "/select_features", 10000)) return node + " does not start";
  const ros::Time arrived = ros::Time::now();
  const auto is_seen = [&] {
    const auto last = relay->last(1);
    return !last.empty() && last.front()->header.stamp > arrived;
  };
  if (!bench.waitFor(is_seen)) return "no image comes";
  sensor_msgs::Image image = *relay->last(1).front();
  keepPicture(image_faults::pixels(image), file);
  features_.reset();
  SelectFeatures select;
  select.request.selection = by_features_->selection(file);
  const auto selected = [&] {
    return test_support::callWithin(node + "/select_features", select) && select.response.success;
  };
  return bench.waitFor(selected, 20.0) ? "" : "no features: " + select.response.message;
}

// The region in its place first, where it is not tracked; then the scope a little to the side of it.
std::string FaultCart::see() {
  hand(home_);
  // Within a second when it was never lost, later where it has to be found again.
  homography_.reset();
  if (by_features_ != nullptr) {
    const std::string problem = select();
    if (!problem.empty()) return problem;
  } else if (!bench.waitFor([this] { return offset() < 10.0; }, 1.5)) {
    if (!ros::service::waitForService("tracker/select_roi", 10000)) return "the tracker does not start";
    SelectRoi select;
    select.request.roi.x_offset = kRoiX;
    select.request.roi.y_offset = kRoiY;
    select.request.roi.width = select.request.roi.height = kRoiSide;
    const auto selected = [&] {
      return test_support::callWithin("tracker/select_roi", select) && select.response.success;
    };
    if (!bench.waitFor(selected, 20.0)) return "no region: " + select.response.message;
  }
  const std::string problem = waitFor("what is tracked in its place", [this] { return offset() < 5.0; });
  if (!problem.empty()) return problem;
  bench.truth().hand({kPan, 0.02, 0.0, 0.0}, by_features_ == nullptr ? kHand : kSlowHand);
  bench.waitFor([this] { return !bench.truth().motion().moving; });
  return waitFor("what is tracked beside its place", [this] { return std::isfinite(offset()) && offset() > 50.0; });
}

// By a hand about the trocar, to where the scope was with these joints.
void FaultCart::hand(const aesop::JointVector& goal) {
  const aesop::JointVector now = bench.truth().state().q;
  if ((now - goal).cwiseAbs().maxCoeff() < 1e-4) return;
  const Eigen::Vector3d trocar = sim::ArmConfig().insertion_point;
  const Eigen::Isometry3d from = kinematics_.optical(now), to = kinematics_.optical(goal);
  const Eigen::Vector3d turn = geometry::so3Log(from.linear().transpose() * to.linear());
  const double deeper = (to.translation() - trocar).norm() - (from.translation() - trocar).norm();
  bench.truth().hand({turn.y(), turn.x(), turn.z(), deeper}, kHand);
  bench.waitFor([this] { return !bench.truth().motion().moving; });
}

}  // namespace laparoscope_servo::test
