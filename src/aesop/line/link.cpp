#include "laparoscope_servo/aesop/link.h"

#include <algorithm>
#include <limits>
#include <sstream>

namespace laparoscope_servo::aesop {

namespace {

constexpr double kIdentifyPeriod = 0.2;      // s
constexpr double kRestartStep = 0.5;         // s: a controller's clock that goes back by more has restarted
constexpr double kClockRange = 4294967.296;  // s, where its 32 bits of milliseconds wrap

std::string jointList(std::uint8_t mask) {
  std::string text;
  for (int k = 0; k < 8; ++k) {
    if ((mask & (1u << k)) != 0) text += (text.empty() ? "" : ", ") + std::to_string(k + 1);
  }
  return text.empty() ? "none" : text;
}

}  // namespace

const char* name(LinkState state) {
  switch (state) {
    case LinkState::kClosed:
      return "closed";
    case LinkState::kIdentifying:
      return "identifying";
    case LinkState::kUp:
      return "up";
  }
  return "unknown";
}

void Link::opened(double now) {
  codec_->reset();
  begin("the controller has not answered yet; check its power, the cable and the baud rate", now);
}

void Link::closed(const std::string& reason) {
  state_ = LinkState::kClosed;
  reason_ = reason;
  status_.reset();
}

void Link::begin(const std::string& reason, double now) {
  state_ = LinkState::kIdentifying;
  reason_ = reason;
  status_.reset();
  last_number_.reset();
  next_ = now;
}

std::vector<LinkEvent> Link::receive(const std::uint8_t* data, std::size_t size, double now) {
  std::vector<LinkEvent> events;
  if (state_ == LinkState::kClosed) return events;
  const std::uint64_t versions = codec_->statistics().other_version;
  for (const Frame& frame : codec_->push(data, size)) {
    if (const auto* identity = std::get_if<Identity>(&frame.message)) {
      const bool was_up = isUp();
      take(*identity, now);
      if (!was_up && isUp()) events.push_back(LinkUp());
      last_number_ = frame.sequence;
    } else if (const auto* status = std::get_if<Status>(&frame.message)) {
      countLosses(frame.sequence);
      // A status from before this session is ignored.
      if (!isUp()) continue;
      take(*status, now);
      events.push_back(isUp() ? LinkEvent(*status) : LinkLost{reason_});
    }
  }
  statistics_.decoder = codec_->statistics();
  if (state_ == LinkState::kIdentifying && statistics_.decoder.other_version > versions) {
    reason_ = "the controller speaks version " + std::to_string(statistics_.decoder.version_heard) +
              " of the protocol, this driver " + codec_->name() + "; one of them has to be exchanged";
  }
  return events;
}

void Link::take(const Identity& identity, double now) {
  if (state_ != LinkState::kIdentifying) return;
  if (identity.joints != kJoints || identity.driven != driven_) {
    reason_ = "the controller has " + std::to_string(identity.joints) + " joints and drives " +
              jointList(identity.driven) + ", the configuration has 7 and drives " + jointList(driven_);
    return;
  }
  state_ = LinkState::kUp;
  reason_.clear();
  model_ = identity.model;
  ++statistics_.sessions;
  round_trips_.clear();
  status_at_ = now;
  next_ = now;
}

void Link::take(const Status& status, double now) {
  if (status_ && status.time < status_->time - kRestartStep && status_->time - status.time < 0.5 * kClockRange) {
    begin("the controller has restarted", now);
    return;
  }
  if (compareSequence(status.echo, sequence_) > 0) {
    begin("the controller answers requests that were never sent", now);
    return;
  }
  const bool answers = !status_ || status.echo != status_->echo;  // false: echoes the same request as the last status
  ++statistics_.received;
  status_ = status;
  // Its age counts from the request, since a line that holds bytes back may deliver old statuses regularly.
  const auto behind = static_cast<std::uint16_t>(sequence_ - status.echo);
  if (behind >= sent_at_.size()) {
    status_at_ = -std::numeric_limits<double>::infinity();
    return;
  }
  status_at_ = sent_at_[status.echo % sent_at_.size()];
  if (answers) round_trips_.add(now - status_at_);
}

void Link::countLosses(std::uint16_t number) {
  if (last_number_ && compareSequence(number, *last_number_) > 0) {
    statistics_.lost += static_cast<std::uint16_t>(number - *last_number_ - 1);
  }
  last_number_ = number;
}

void Link::watch(double now) {
  if (!isUp() || !(statusAge(now) > config_.status_timeout)) return;
  std::ostringstream text;
  text << "the controller has sent no status for " << config_.status_timeout << " s, or answers later than that";
  begin(text.str(), now);
}

Bytes Link::identify(double now) {
  if (state_ != LinkState::kIdentifying || !due(now)) return {};
  Bytes bytes = send(Identify(), now);
  next_ = now + kIdentifyPeriod;
  return bytes;
}

Bytes Link::send(const Message& message, double now) {
  Bytes bytes = codec_->encode({static_cast<std::uint16_t>(sequence_ + 1), message});
  ++sequence_;
  sent_at_[sequence_ % sent_at_.size()] = now;
  ++statistics_.sent;
  // Slots are periodic; missed ones are not made up for after a pause, and the period starts anew after a request
  // between slots.
  const double period = 1.0 / config_.rate;
  next_ = next_ <= now && next_ + period > now ? next_ + period : now + period;
  return bytes;
}

double Link::statusAge(double now) const {
  if (!isUp()) return std::numeric_limits<double>::infinity();
  return now - status_at_;
}

}  // namespace laparoscope_servo::aesop
