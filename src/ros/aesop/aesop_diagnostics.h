// The diagnostics of the aesop node.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <cstdint>
#include <string>

#include "laparoscope_servo/aesop/driver.h"
#include "ros/common/input_owner.h"

namespace laparoscope_servo {

// Facts of the node that the driver does not have.
struct AesopReport {
  const InputOwner& command_owner;
  std::uint32_t publishers = 0;  // number of connections on which commands may come
  double next_attempt = 0.0;     // s until the port is tried again, while it is closed
};

// Times are seconds of a steady clock.
class AesopDiagnostics {
 public:
  // `line_warning`: error in the settings of the line; empty if there is none.
  AesopDiagnostics(const std::string& port, const std::string& line_warning)
      : port_(port), line_warning_(line_warning) {}

  const std::string& lineWarning() const { return line_warning_; }
  // Level: ERROR without a link or in FAULT; WARN when the line cannot carry the rate or has lost bytes since the last
  // call, or when other nodes than the owner publish commands. Rates are those since the last call.
  void fill(double now, const aesop::Driver& driver, const AesopReport& report,
            diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  void summarise(const aesop::OperatingState& state, const aesop::Session& session, Status& status);
  static void addMaster(double now, const AesopReport& report, Status& status);
  static void addCommands(double now, const aesop::CommandGuard& guard, Status& status);
  void addLine(double now, const aesop::Link& link, Status& status);
  static void addDelay(const aesop::MotionDelay& delay, Status& status);

  std::string port_;
  std::string line_warning_;
  std::uint64_t errors_reported_ = 0;
  aesop::LinkStatistics before_;  // at the last call
  double called_at_ = 0.0;        // s
};

}  // namespace laparoscope_servo
