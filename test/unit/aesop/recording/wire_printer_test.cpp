#include "laparoscope_servo/aesop/wire_printer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <sstream>

#include "aesop/protocol/own_codec.h"
#include "laparoscope_servo/aesop/operating_state.h"
#include "unit/aesop/messages.h"
#include "unit/aesop/recorded_session.h"

namespace laparoscope_servo::aesop {
namespace {

constexpr std::int64_t kStart = 5000000000;  // ns

class Printed {
 public:
  std::string add(WireEvent event, double seconds, const Bytes& payload) {
    std::ostringstream out;
    printer_.print({event, kStart + static_cast<std::int64_t>(std::llround(seconds * 1e9)), payload}, kStart, out);
    return out.str();
  }
  std::string summary() const {
    std::ostringstream out;
    printer_.printSummary(out);
    return out.str();
  }

 private:
  WirePrinter printer_{makeOwnCodec};
};

TEST(WirePrinter, EachMessageHasAWordOfItsOwn) {
  std::set<std::string> words;
  const std::vector<Message> all = oneOfEach();
  for (const Message& message : all) words.insert(typeOf(message));
  EXPECT_EQ(words.size(), all.size());
  EXPECT_EQ(all.size(), std::variant_size_v<Message>);
  for (const std::string& word : words) EXPECT_EQ(word.find_first_of(" ,:"), std::string::npos) << word;
}

TEST(WirePrinter, DescribesTheNumbersOfAMessage) {
  EXPECT_EQ(describe(Velocity{{0.5, -0.25, 0.0, 1e-3}, 0.2}), "velocity for 0.2 s: 0.5 -0.25 0 0.001");
  EXPECT_EQ(describe(Identity{7, 0x0F, "AESOP"}), "identity 7 joints, driven 0xf, 'AESOP'");
  Status status;
  status.state = RobotState::kFault;
  status.homed = true;
  status.faults = kFaultMotor;
  status.echo = 77;
  status.time = 4294967.295;  // to the millisecond also after 49 days
  status.position[6] = 0.125;
  EXPECT_EQ(describe(status),
            "status FAULT homed faults: motor; echo 77 time 4294967.295 q 0 0 0 0 0 0 0.125 qdot 0 0 0 0 0 0 0");
}

TEST(WirePrinter, ALineForEachFrameWithItsTimeAndWay) {
  Printed printed;
  const Bytes request = encode({7, Enable()});
  EXPECT_EQ(printed.add(WireEvent::kSent, 0.25, request), "     0.250000 > #7 enable\n");
  EXPECT_EQ(printed.add(WireEvent::kSent, 0.5, {}), "") << "a turn in which nothing is sent";
  EXPECT_EQ(printed.add(WireEvent::kReceived, 1.0, encode({9, Identity{7, 0, "x"}})).substr(0, 24),
            "     1.000000 < #9 ident");
  // A frame in two pieces comes with its second one, two in one piece together.
  const Bytes stop = encode({10, Stop()}), poll = encode({11, Poll()});
  EXPECT_EQ(printed.add(WireEvent::kSent, 2.0, Bytes(stop.begin(), stop.begin() + 4)), "");
  Bytes rest(stop.begin() + 4, stop.end());
  rest.insert(rest.end(), poll.begin(), poll.end());
  EXPECT_EQ(printed.add(WireEvent::kSent, 3.0, rest), "     3.000000 > #10 stop\n     3.000000 > #11 poll\n");
}

// Requests and replies have decoders of their own: a broken request does not spoil the reply.
TEST(WirePrinter, SaysWhatWasSkippedWithTheBytesThatCame) {
  Printed printed;
  Bytes damaged = encode({7, Enable()});
  damaged.back() ^= 0x01;
  const std::string line =
      printed.add(WireEvent::kReceived, 0.0, damaged) + printed.add(WireEvent::kReceived, 0.1, encode({8, Stop()}));
  EXPECT_NE(line.find("CRC errors 1"), std::string::npos) << line;
  EXPECT_NE(line.find("these came: "), std::string::npos) << line;
  EXPECT_NE(line.find("< #8 stop"), std::string::npos) << line;
  EXPECT_EQ(printed.add(WireEvent::kSent, 0.2, encode({9, Poll()})), "     0.200000 > #9 poll\n");
  EXPECT_NE(printed.summary().find("to the controller: 9 bytes, frames 1, poll 1; skipped 0 bytes"), std::string::npos)
      << printed.summary();
}

TEST(WirePrinter, NamesEachEvent) {
  Printed printed;
  const auto words = [&](WireEvent event, const Bytes& payload) { return printed.add(event, 0.0, payload).substr(13); };
  EXPECT_EQ(words(WireEvent::kOpened, {}), " * port opened\n");
  EXPECT_EQ(words(WireEvent::kClosed, payloadOf(std::string("cable"))), " * port closed: cable\n");
  EXPECT_EQ(words(WireEvent::kEnable, payloadOf({1.0})), " * asked to enable\n");
  EXPECT_EQ(words(WireEvent::kDisable, {}), " * asked to disable\n");
  EXPECT_EQ(words(WireEvent::kDisable, payloadOf(std::string("by hand"))), " * asked to disable: by hand\n");
  EXPECT_EQ(words(WireEvent::kClearFault, {}), " * asked to clear a fault\n");
  EXPECT_EQ(words(WireEvent::kPause, payloadOf(std::string("by /x"))), " * asked to pause: by /x\n");
  EXPECT_EQ(words(WireEvent::kResume, payloadOf({1.0})), " * asked to resume\n");
  EXPECT_EQ(words(WireEvent::kCommand, payloadOf({0.1, 0.2, 0.3, 0.4, 1700000000.25, 1700000000.5})),
            " * command 0.1 0.2 0.3 0.4 1700000000.25 1700000000.5\n")
      << "stamps keep their fractions";
  EXPECT_EQ(words(WireEvent::kInsertionPoint, payloadOf({1.0, 2.0, 3.0})), " * insertion point 1 2 3\n");
  EXPECT_EQ(words(WireEvent::kState, payloadOf(OperatingState{OperatingMode::kPaused, true, true, "why"})),
            " * state PAUSED homed busy: why\n");
  EXPECT_EQ(words(WireEvent::kState, payloadOf(OperatingState{})), " * state DISABLED\n");
}

// A request is answered by the status that echoes its number.
TEST(WirePrinter, SummaryCountsTurnsAndRoundTrips) {
  Printed printed;
  const auto status = [](std::uint16_t echo) {
    Status reply;
    reply.echo = echo;
    return encode({1, reply});
  };
  printed.add(WireEvent::kSent, 1.0, encode({1, Poll()}));
  printed.add(WireEvent::kReceived, 1.01, status(1));
  printed.add(WireEvent::kReceived, 1.5, status(1));  // again: no other round trip
  printed.add(WireEvent::kSent, 2.0, encode({2, Poll()}));
  printed.add(WireEvent::kSent, 2.25, encode({3, Poll()}));  // not answered
  printed.add(WireEvent::kReceived, 2.03, status(2));
  printed.add(WireEvent::kSent, 2.35, encode({4, Poll()}));
  printed.add(WireEvent::kReceived, 2.37, status(4));
  const std::string summary = printed.summary();
  EXPECT_NE(summary.find("turns of the driver 4, longest time between two 1 s"), std::string::npos) << summary;
  EXPECT_NE(summary.find("round trips 3, median 0.02 s, longest 0.03 s"), std::string::npos) << summary;
  EXPECT_EQ(Printed().summary().find("round trips"), std::string::npos) << "without one";
}

// Whatever a driver records can be printed: a line for each event, and as many frames as the line has carried.
TEST(WirePrinter, PrintsAWholeSession) {
  const RecordedSession session;
  WirePrinter printer(makeOwnCodec);
  std::ostringstream out;
  std::size_t events = 0;
  for (const WireRecord& record : session.tap.records) {
    const auto before = out.tellp();
    printer.print(record, session.tap.records.front().time, out);
    const bool is_event = record.event != WireEvent::kSent && record.event != WireEvent::kReceived;
    events += is_event ? 1 : 0;
    if (is_event) {
      EXPECT_GT(out.tellp(), before) << static_cast<int>(record.event);
    }
  }
  const std::string text = out.str();
  std::size_t stars = 0, damages = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    ASSERT_GT(line.size(), 15u) << line;
    stars += line[14] == '*' ? 1 : 0;
    damages += line.find("these came:") != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(stars, events);
  EXPECT_GT(damages, 0u) << "its line was damaged for a second";
}

}  // namespace
}  // namespace laparoscope_servo::aesop
