#include "aesop/protocol/own_codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "unit/aesop/messages.h"

namespace laparoscope_servo::aesop {
namespace {

TEST(OwnCodec, valuesComeBackToAMillionth) {
  Decoder decoder;
  const Status sent = someStatus();
  const Status got = std::get<Status>(decoder.push(encode({7, sent}))[0].message);
  EXPECT_EQ(got.state, sent.state);
  EXPECT_EQ(got.homed, sent.homed);
  EXPECT_EQ(got.moving, sent.moving);
  EXPECT_EQ(got.faults, sent.faults);
  EXPECT_EQ(got.echo, sent.echo);
  EXPECT_NEAR(got.time, sent.time, 5e-4);
  EXPECT_LE((got.position - sent.position).lpNorm<Eigen::Infinity>(), 0.5e-6 + 1e-12);
  EXPECT_LE((got.velocity - sent.velocity).lpNorm<Eigen::Infinity>(), 0.5e-6 + 1e-12);
  const Velocity velocity{{0.001, -0.3, 0.2, -0.5}, 0.2};
  const Velocity back = std::get<Velocity>(decoder.push(encode({8, velocity}))[0].message);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(back.speed[k], velocity.speed[k], 1e-9);
  EXPECT_DOUBLE_EQ(back.time_to_live, 0.2);
  const Identity identity{7, 0x47, "sixteen letters!"};
  EXPECT_EQ(std::get<Identity>(decoder.push(encode({9, identity}))[0].message).model, identity.model);
}

TEST(OwnCodec, encoderRefusesWhatHasNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf, 2001.0, 1e300}) {
    EXPECT_THROW(encode({1, Velocity{{0.0, bad, 0.0, 0.0}, 0.1}}), std::invalid_argument);
    EXPECT_THROW(encode({1, Velocity{{0.0, 0.0, 0.0, 0.0}, bad}}), std::invalid_argument);
    Status status = someStatus();
    status.position[3] = bad;
    EXPECT_THROW(encode({1, status}), std::invalid_argument);
    status = someStatus();
    status.velocity[6] = bad;
    EXPECT_THROW(encode({1, status}), std::invalid_argument);
  }
  EXPECT_THROW(encode({1, Velocity{{}, 0.0}}), std::invalid_argument);
  EXPECT_THROW(encode({1, Identity{7, 0, "seventeen letters"}}), std::invalid_argument);
  EXPECT_THROW(encode({1, Identity{7, 0, "tab\t"}}), std::invalid_argument);
}

TEST(Messages, unknownFaultBitsAreFaults) {
  EXPECT_EQ(describeFaults(0), "");
  EXPECT_EQ(describeFaults(kFaultMotor), "motor");
  EXPECT_EQ(describeFaults(kFaultMotor | 0x8000), "motor, unknown fault bits 0x8000");
}

}  // namespace
}  // namespace laparoscope_servo::aesop
