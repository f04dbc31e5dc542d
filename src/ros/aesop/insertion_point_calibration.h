// One calibration of the insertion point after the other: collects poses from the driver's statuses, drives the pattern
// where that is the method, judges, saves, and gives the new point to the driver.
//
// No messages, no clock: `now` is seconds of a steady clock, `stamp_now` of the one that stamps commands. The arm never
// turns about another point than the one it was enabled with: the driver takes the new one while DISABLED and at rest.
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
  // `driver` has to outlive this.
  InsertionPointCalibration(const CalibrationParameters& parameters, aesop::Driver& driver)
      : parameters_(parameters), driver_(driver), fitter_(parameters.fit) {}

  // Each says why not, or nothing.
  std::string start(CalibrationMethod method, double now);
  // Of the method HAND. When it is refused for what the poses miss, they are kept, and collecting goes on.
  std::string finish(double now);
  std::string cancel(double now);

  // Call often, and after every status. True when the driver has another insertion point from now on.
  bool step(double stamp_now, double now);

  // The pattern is under way: commands of others do not reach the driver. One that is not zero ends it.
  bool drives() const { return pattern_.has_value(); }
  void otherCommand(const scope::Velocity& velocity, double now);

  // A new insertion point waits for the arm to be DISABLED and at rest: it must not be enabled with the old one.
  bool waits() const { return pending_.has_value(); }

  CalibrationStage stage() const { return stage_; }
  // Nothing before the first start.
  std::optional<CalibrationMethod> method() const { return method_; }
  const servo::InsertionPointFit& fit() const { return fitter_.fit(); }
  // What is missing, what has come of it, or why it has failed.
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
  std::vector<aesop::JointVector> poses_;  // those that the fitter has taken
  std::optional<aesop::CalibrationPattern> pattern_;
  CalibrationStage stage_ = CalibrationStage::kIdle;
  std::optional<CalibrationMethod> method_;
  std::string message_ = "none yet";
  std::optional<Eigen::Vector3d> pending_;  // for the driver, as soon as it takes it
  std::uint64_t seen_ = 0;                  // statuses, when the last one was looked at
};

}  // namespace laparoscope_servo
