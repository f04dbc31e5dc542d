#include "ros/common/service_errors.h"

#include <gtest/gtest.h>
#include <std_srvs/Trigger.h>

#include <stdexcept>

namespace laparoscope_servo {
namespace {

using Response = std_srvs::Trigger::Response;

TEST(ServiceErrorsTest, AnswerOfAServiceThatThrowsNothingIsItsOwn) {
  ServiceErrors errors;
  Response response;
  errors.guard(response, [&] {
    response.success = 1;
    response.message = "enabled";
  });
  EXPECT_TRUE(response.success);
  EXPECT_EQ(response.message, "enabled");
  EXPECT_NO_THROW(errors.rethrow());
}

TEST(ServiceErrorsTest, WhatIsThrownIsTheAnswerAndNoSuccess) {
  ServiceErrors errors;
  Response response;
  errors.guard(response, [&] {
    response.success = 1;
    throw std::invalid_argument("a joint angle is nan");
  });
  EXPECT_FALSE(response.success);
  EXPECT_EQ(response.message, "a joint angle is nan");
}

TEST(ServiceErrorsTest, FirstErrorIsKeptWithItsType) {
  ServiceErrors errors;
  Response response;
  errors.guard(response, [] { throw std::invalid_argument("first"); });
  errors.guard(response, [] { throw std::logic_error("second"); });
  errors.guard(response, [&] { response.success = 1; });
  try {
    errors.rethrow();
    FAIL() << "nothing was kept";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "first");
  }
}

}  // namespace
}  // namespace laparoscope_servo
