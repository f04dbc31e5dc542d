#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace laparoscope_servo::validation {

// Adds the errors of a part of a configuration to `all`, each with "group/" in front.
inline void addGroup(const std::string& group, const std::vector<std::string>& errors, std::vector<std::string>& all) {
  for (const std::string& error : errors) all.push_back(group + "/" + error);
}

// Throws std::invalid_argument that names `what` and lists all errors, if there are any.
inline void throwErrors(const std::string& what, const std::vector<std::string>& errors) {
  if (errors.empty()) return;
  std::string text = what + ": ";
  for (std::size_t k = 0; k < errors.size(); ++k) text += (k == 0 ? "" : "; ") + errors[k];
  throw std::invalid_argument(text);
}

}  // namespace laparoscope_servo::validation
