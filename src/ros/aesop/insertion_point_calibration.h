// Calibrations of the insertion point, one after the other: collects poses from the driver's statuses, moves along the
// pattern with that method, checks and saves the result, and passes the new point to the driver.
//
// No messages, no clock: `now` is seconds of a steady clock, `stamp_now` of the one that stamps commands. The arm
// always turns about the point with which it was enabled: the driver takes a new one only while DISABLED and at rest.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ros/aesop/aesop_parameters.h"

namespace laparoscope_servo {

enum class CalibrationMethod { kHand, kPattern };
enum class CalibrationStage { kIdle, kCollecting, kStopping, kDone, kFailed };

const char* name(CalibrationMethod method);

class InsertionPointCalibration {
 public:
  // `driver` must outlive this.
  InsertionPointCalibration(const CalibrationParameters& parameters, aesop::Driver& driver)
      : parameters_(parameters), driver_(driver), fitter_(parameters.fit) {}

  // Each returns why it is refused, or an empty text.
  std::string start(CalibrationMethod method, double now);
  // For the method HAND. If it is refused because of the poses, they are kept, and collecting goes on.
  std::string finish(double now);
  std::string cancel(double now);

  // Call often, and after every status. Returns true if the driver has taken another insertion point.
  bool step(double stamp_now, double now);

  // Whether the arm moves along the pattern: commands of others do not reach the driver. A command other than zero ends
  // it.
  bool drives() const { return pattern_.has_value(); }
  void otherCommand(const scope::Velocity& velocity, double now);

  // Whether a new insertion point waits for the arm to be DISABLED and at rest. The arm must not be enabled with the
  // old one.
  bool waits() const { return pending_.has_value(); }

  CalibrationStage stage() const { return stage_; }
  // Empty before the first start.
  std::optional<CalibrationMethod> method() const { return method_; }
  const servo::InsertionPointFit& fit() const { return fitter_.fit(); }
  // What is missing, the result, or why it has failed.
  std::string message() const;

 private:
  std::string refusal(CalibrationMethod method, double now) const;
  std::string lostGround(double now) const;
  void collect(const aesop::Status& status);
  void drive(const aesop::Status& status, double stamp_now, double now);
  void stopArm(double now);
  void fail(const std::string& reason, double now);
  std::string conclude();
  std::string missing() const;

  CalibrationParameters parameters_;
  aesop::Driver& driver_;
  servo::InsertionPointFitter fitter_;
  std::vector<aesop::JointVector> poses_;  // poses that the fitter has kept
  std::optional<aesop::CalibrationPattern> pattern_;
  CalibrationStage stage_ = CalibrationStage::kIdle;
  std::optional<CalibrationMethod> method_;
  std::string message_ = "none yet";
  std::optional<Eigen::Vector3d> pending_;  // point to be passed to the driver as soon as it accepts it
  std::uint64_t seen_ = 0;                  // number of statuses at the last evaluation
};

}  // namespace laparoscope_servo
