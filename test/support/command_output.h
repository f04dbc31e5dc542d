// What a command of the shell prints, on both channels, and how it ended.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace laparoscope_servo::test_support {

struct CommandOutput {
  int status = -1;  // -1: killed
  std::string text;
};

inline CommandOutput outputOf(const std::string& command) {
  CommandOutput output;
  FILE* pipe = ::popen(("exec 2>&1; " + command).c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot run " + command);
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) output.text += buffer.data();
  const int status = ::pclose(pipe);
  if (WIFEXITED(status)) output.status = WEXITSTATUS(status);
  return output;
}

}  // namespace laparoscope_servo::test_support
