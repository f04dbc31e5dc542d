#include "laparoscope_servo/sim/emulator.h"

#include <algorithm>

#include "laparoscope_servo/aesop/session_config.h"
#include "laparoscope_servo/parameters/table.h"
#include "laparoscope_servo/validation/error_report.h"

namespace laparoscope_servo::sim {

namespace {

using aesop::RobotState;

}  // namespace

void describe(parameters::Table& table, EmulatorConfig& c) {
  table.group("kinematics", "as for the node aesop", [&] { describe(table, c.kinematics); });
  describeEmulator(table, c);
}

void describeEmulator(parameters::Table& table, EmulatorConfig& c) {
  table.group("emulator", "the far end of the line", [&] {
    describe(table, c.arm);
    aesop::describeCodec(table, c.codec);
  });
}

std::vector<std::string> validate(const EmulatorConfig& config) {
  std::vector<std::string> errors;
  validation::addGroup("kinematics", aesop::validate(config.kinematics), errors);
  validation::addGroup("emulator", validate(config.arm), errors);
  if (!config.codec) errors.emplace_back("emulator/codec: there is none, expected one that makes a codec");
  return errors;
}

Emulator::Emulator(const EmulatorConfig& config, double now)
    : kinematics_(config.kinematics), arm_(kinematics_, config.arm), codec_(config.codec()), power_on_(now) {
  arm_.step(now);
}

aesop::Bytes Emulator::receive(const std::uint8_t* data, std::size_t size, double now) {
  step(now);
  aesop::Bytes replies;
  for (const aesop::Frame& request : codec_->push(data, size)) {
    heard_ = now;
    const aesop::Bytes reply = codec_->encode({++reply_sequence_, answer(request, now)});
    replies.insert(replies.end(), reply.begin(), reply.end());
  }
  return replies;
}

aesop::Message Emulator::answer(const aesop::Frame& request, double now) {
  if (std::holds_alternative<aesop::Identify>(request.message)) {
    session_ = true;
    last_sequence_ = request.sequence;
    if (state_ == RobotState::kEnabled) state_ = RobotState::kDisabled;
    stop(now);
    aesop::Identity identity;
    unsigned driven = 0;
    for (const int joint : kinematics_.driven()) driven |= 1u << joint;
    identity.driven = static_cast<std::uint8_t>(driven);
    identity.model = "EMULATED AESOP";
    return identity;
  }
  // Repeated and late requests are answered, but not executed.
  if (session_ && aesop::compareSequence(request.sequence, last_sequence_) > 0) {
    last_sequence_ = request.sequence;
    execute(request.message, now);
  }
  return liar_.tell(status(now));
}

void Emulator::execute(const aesop::Message& request, double now) {
  if (std::holds_alternative<aesop::Enable>(request)) {
    if (state_ == RobotState::kDisabled && !arm_.isMoving()) state_ = RobotState::kEnabled;
  } else if (std::holds_alternative<aesop::Disable>(request)) {
    if (state_ == RobotState::kEnabled) state_ = RobotState::kDisabled;
    stop(now);
  } else if (std::holds_alternative<aesop::Stop>(request)) {
    stop(now);
  } else if (std::holds_alternative<aesop::ClearFault>(request)) {
    if (state_ == RobotState::kFault && cause_ == 0) {
      faults_ = 0;
      state_ = RobotState::kDisabled;
    }
  } else if (const auto* velocity = std::get_if<aesop::Velocity>(&request)) {
    if (state_ != RobotState::kEnabled) return;
    arm_.command(velocity->speed, now);
    velocity_until_ = now + velocity->time_to_live;
    driven_ = true;
    if (velocity->speed != std::array<double, aesop::kDrivenJoints>{}) velocity_at_ = now;
  }
}

void Emulator::stop(double now) {
  if (driven_) arm_.command({}, now);
  driven_ = false;
}

void Emulator::fault(std::uint16_t bits) {
  faults_ = static_cast<std::uint16_t>(faults_ | bits);
  state_ = RobotState::kFault;
  driven_ = false;
  arm_.brake();
}

void Emulator::watchHost(double now) {
  const double silent = heard_ + kHostTimeout;
  if (driven_ && now >= std::min(velocity_until_, silent)) stop(std::min(velocity_until_, silent));
  if (state_ == RobotState::kEnabled && now >= silent) state_ = RobotState::kDisabled;
}

void Emulator::step(double now) {
  watchHost(now);
  arm_.step(now);
  longest_motion_ = std::max(longest_motion_, arm_.movedUntil() - velocity_at_);
  if (!arm_.stuck().empty()) fault(aesop::kFaultTrocar);
}

void Emulator::setFaultCause(std::uint16_t bits, double now) {
  step(now);
  cause_ = bits;
  if (bits != 0) fault(bits);
}

void Emulator::jam(int joint, double now) {
  step(now);
  arm_.jam(joint);
}

void Emulator::reverse(int joint, double now) {
  step(now);
  arm_.reverse(joint);
}

void Emulator::setGain(double gain, double now) {
  step(now);
  arm_.setGain(gain);
}

void Emulator::setLag(double lag, double now) {
  step(now);
  arm_.setLag(lag);
}

void Emulator::lie(Lie lie, double now) {
  step(now);
  liar_.begin(lie, status(now));
}

void Emulator::reboot(double now) {
  step(now);
  arm_.brake();
  codec_->reset();
  power_on_ = now;
  state_ = cause_ == 0 ? RobotState::kDisabled : RobotState::kFault;
  faults_ = cause_;
  session_ = false;
  driven_ = false;
}

std::string Emulator::hand(const scope::Velocity& displacement, double seconds, double now) {
  step(now);
  if (state_ != RobotState::kDisabled) return std::string("the arm is ") + aesop::name(state_) + ", not DISABLED";
  return arm_.hand(displacement, seconds, now);
}

aesop::Status Emulator::status(double now) const {
  aesop::Status status;
  status.state = state_;
  status.homed = true;
  status.moving = arm_.isMoving();
  status.faults = faults_;
  status.echo = last_sequence_;
  status.time = time(now);
  status.position = arm_.position();
  status.velocity = arm_.velocity();
  return status;
}

}  // namespace laparoscope_servo::sim
