// The link to the controller as a sequence of sessions: identification, sequence numbers, ages, losses.
//
// Pure: bytes in, bytes out, and `now`, seconds of a steady clock. While the link is not up, the state of the robot is
// unknown.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "laparoscope_servo/aesop/codec.h"
#include "laparoscope_servo/aesop/round_trips.h"
#include "laparoscope_servo/aesop/session_config.h"

namespace laparoscope_servo::aesop {

enum class LinkState {
  kClosed,       // no port
  kIdentifying,  // port open, no valid answer of the controller yet
  kUp,           // identified, receives statuses
};

const char* name(LinkState state);

struct LinkStatistics {
  DecoderStatistics decoder;
  std::uint64_t sent = 0;      // requests
  std::uint64_t received = 0;  // statuses
  std::uint64_t lost = 0;      // replies of the controller that did not arrive, by their sequence numbers
  std::uint64_t sessions = 0;  // number of times that the link came up
};

// Events of a read. The link may be lost and come up again within one read.
struct LinkUp {};
struct LinkLost {
  std::string reason;
};
using LinkEvent = std::variant<LinkUp, LinkLost, Status>;

class Link {
 public:
  // `driven`: bit k - 1 for each driven joint k of the configuration; the controller must report the same.
  Link(const SessionConfig& config, std::uint8_t driven) : config_(config), driven_(driven), codec_(config.codec()) {}

  void opened(double now);
  void closed(const std::string& reason);
  // Decodes these bytes and returns their events, oldest first; only statuses of this session.
  std::vector<LinkEvent> receive(const std::uint8_t* data, std::size_t size, double now);
  // Declares the link lost if no status has come for too long. Call before each sending.
  void watch(double now);
  // The request that begins the session (anew), if one is due; send it while the link is not up.
  Bytes identify(double now);
  // Encodes one request. Throws std::invalid_argument like Codec::encode().
  Bytes send(const Message& message, double now);
  // Whether it is time for the next request.
  bool due(double now) const { return now >= next_; }

  LinkState state() const { return state_; }
  bool isUp() const { return state_ == LinkState::kUp; }
  // Why the link is not up; empty when it is.
  const std::string& reason() const { return reason_; }
  // Sequence number of the request sent last.
  std::uint16_t sequence() const { return sequence_; }
  // Sets the sequence number, for a recording that begins in the middle.
  void setSequence(std::uint16_t sequence) { sequence_ = sequence; }
  // Last status of this session.
  const std::optional<Status>& status() const { return status_; }
  // s since the request that the last status answers was sent: an upper bound of its age. Infinite if there is none.
  double statusAge(double now) const;
  const LinkStatistics& statistics() const { return statistics_; }
  // Round trip times of the last statuses of this session.
  RoundTripSummary roundTrips() const { return round_trips_.summary(); }
  const std::string& model() const { return model_; }

 private:
  void begin(const std::string& reason, double now);
  void take(const Identity& identity, double now);
  void take(const Status& status, double now);
  void countLosses(std::uint16_t number);

  SessionConfig config_;
  std::uint8_t driven_;
  LinkState state_ = LinkState::kClosed;
  std::string reason_ = "the port is not open";
  std::string model_;
  std::unique_ptr<Codec> codec_;
  LinkStatistics statistics_;
  std::uint16_t sequence_ = 0;
  std::array<double, 1024> sent_at_{};  // s, when the last requests were sent, by sequence number modulo the size
  double next_ = 0.0;
  RoundTrips round_trips_;
  std::optional<Status> status_;
  double status_at_ = 0.0;
  std::optional<std::uint16_t> last_number_;
};

}  // namespace laparoscope_servo::aesop
