// What an exception says, for tests that look at its words.
#pragma once

#include <exception>
#include <string>

namespace laparoscope_servo::test_support {

// Of the `Error` that `call` throws; empty: it throws nothing. Another exception goes on, and fails the test.
template <class Error = std::exception, class Call>
std::string errorText(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace laparoscope_servo::test_support
