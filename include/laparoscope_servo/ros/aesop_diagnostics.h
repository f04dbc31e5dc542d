// What the aesop node says on /diagnostics.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <cstdint>
#include <string>

#include "laparoscope_servo/aesop/driver.h"
#include "laparoscope_servo/ros/command_master.h"

namespace laparoscope_servo::skin {

// Times are seconds of a steady clock.
class AesopDiagnostics {
 public:
  // `line_warning`: what is wrong with the settings of the line; empty when nothing is.
  AesopDiagnostics(const std::string& port, const std::string& line_warning)
      : port_(port), line_warning_(line_warning) {}

  const std::string& lineWarning() const { return line_warning_; }
  // `publishers`: connections that carry commands. Level: ERROR without a link or in FAULT, WARN when the line cannot
  // carry the rate or has lost bytes since the last call, or when others than the master command.
  void fill(double now, const aesop::Driver& driver, const CommandMaster& master, std::uint32_t publishers,
            diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  std::string port_;
  std::string line_warning_;
  void addMaster(double now, const CommandMaster& master, std::uint32_t publishers,
                 diagnostic_updater::DiagnosticStatusWrapper& status) const;

  std::uint64_t errors_reported_ = 0;
};

}  // namespace laparoscope_servo::skin
