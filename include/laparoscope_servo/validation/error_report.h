#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace laparoscope_servo::validation {

// Throws std::invalid_argument that names `what` and lists all errors; does nothing when there is none.
inline void throwErrors(const std::string& what, const std::vector<std::string>& errors) {
  if (errors.empty()) return;
  std::string text = what + ": ";
  for (std::size_t k = 0; k < errors.size(); ++k) text += (k == 0 ? "" : "; ") + errors[k];
  throw std::invalid_argument(text);
}

}  // namespace laparoscope_servo::validation
