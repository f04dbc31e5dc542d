// What the aesop node says on /diagnostics.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <cstdint>
#include <string>

#include "laparoscope_servo/aesop/driver.h"

namespace laparoscope_servo::skin {

// Times are seconds of a steady clock.
class AesopDiagnostics {
 public:
  // `line_warning`: what is wrong with the settings of the line; empty when nothing is.
  AesopDiagnostics(const std::string& port, const std::string& line_warning)
      : port_(port), line_warning_(line_warning) {}

  const std::string& lineWarning() const { return line_warning_; }
  // Level: ERROR without a link or in FAULT, WARN when the line cannot carry the rate or has lost bytes since the last
  // call.
  void fill(double now, const aesop::Driver& driver, diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  std::string port_;
  std::string line_warning_;
  std::uint64_t errors_reported_ = 0;
};

}  // namespace laparoscope_servo::skin
