// A recorded session, replayed and printed.
#include "laparoscope_servo/aesop/wire_replay.h"

#include <gtest/gtest.h>

#include <set>

#include "laparoscope_servo/aesop/wire_printer.h"
#include "recorded_session.h"

namespace laparoscope_servo::aesop {
namespace {

class WireReplayTest : public ::testing::Test {
 protected:
  // Once through the file's format and back.
  std::vector<WireRecord> records_ = decoded(encoded(session_().tap.records, {0, 100000000000, "own"}));

  static const RecordedSession& session_() {
    static const RecordedSession session;
    return session;
  }
};

TEST_F(WireReplayTest, theSessionHasEverythingInIt) {
  std::set<OperatingMode> modes;
  for (const OperatingState& state : session_().states) modes.insert(state.mode);
  EXPECT_EQ(modes.size(), 4u);
  std::set<WireEvent> events;
  for (const WireRecord& record : records_) events.insert(record.event);
  EXPECT_EQ(events.size(), 12u);
}

TEST_F(WireReplayTest, goesThroughTheSameStatesAndSendsTheSameBytes) {
  WireReplay replay{DriverConfig()};
  std::size_t turn = 0;
  for (const WireRecord& record : records_) {
    replay.feed(record);
    if (record.event != WireEvent::kSent) continue;
    ASSERT_TRUE(replay.state() == session_().states.at(turn)) << "turn " << turn << ": " << replay.state().reason;
    ++turn;
  }
  replay.end();
  EXPECT_EQ(turn, session_().states.size());
  EXPECT_EQ(replay.statistics().turns, turn);
  EXPECT_EQ(replay.statistics().other_bytes, 0u);
  EXPECT_EQ(replay.statistics().other_states, 0u);
  EXPECT_FALSE(replay.statistics().first_other);
  EXPECT_GT(replay.driver().session().link().statistics().decoder.crc_errors, 0u);
}

TEST_F(WireReplayTest, anotherConfigurationShows) {
  DriverConfig config;
  config.command.timeout = 0.03;
  WireReplay replay(config);
  for (const WireRecord& record : records_) replay.feed(record);
  replay.end();
  EXPECT_GT(replay.statistics().other_bytes, 0u);
  EXPECT_GT(replay.statistics().other_states, 0u);
  ASSERT_TRUE(replay.statistics().first_other);
  EXPECT_GT(*replay.statistics().first_other, 100.5);
}

TEST_F(WireReplayTest, aRecordingThatBeginsInTheMiddleCountsFromTheNextOpening) {
  std::size_t openings = 0;
  WireReplay replay{DriverConfig()};
  for (std::size_t k = records_.size() / 3; k < records_.size(); ++k) {
    openings += records_[k].event == WireEvent::kOpened ? 1 : 0;
    replay.feed(records_[k]);
  }
  replay.end();
  EXPECT_EQ(openings, 1u);
  EXPECT_GT(replay.statistics().turns, 400u);
  EXPECT_EQ(replay.statistics().other_bytes, 0u);
  EXPECT_EQ(replay.statistics().other_states, 0u);
}

TEST_F(WireReplayTest, aRecordThatIsNoneIsRefused) {
  WireReplay replay{DriverConfig()};
  EXPECT_THROW(replay.feed({WireEvent::kEnable, 0, {}}), std::invalid_argument);
  EXPECT_THROW(replay.feed({WireEvent::kState, 0, {9, 0}}), std::invalid_argument);
  EXPECT_THROW(replay.feed({WireEvent::kState, 0, {0}}), std::invalid_argument);
}

TEST_F(WireReplayTest, withoutATapNothingElseHappens) {
  Driver with{DriverConfig()};
  Driver without{DriverConfig()};
  RecordedTap tap;
  with.setTap(&tap);
  for (Driver* driver : {&with, &without}) driver->opened(1.0);
  for (double now = 1.0; now < 2.0; now += 0.005) EXPECT_EQ(with.transmit(now), without.transmit(now));
  const std::size_t records = tap.records.size();
  EXPECT_GT(records, 199u);
  with.setTap(nullptr);
  with.transmit(3.0);
  EXPECT_EQ(tap.records.size(), records);
}

TEST_F(WireReplayTest, isPrintedForPeople) {
  WirePrinter printer(makeOwnCodec);
  std::ostringstream text;
  for (const WireRecord& record : records_) printer.print(record, records_[0].time, text);
  for (const char* part :
       {"0.000000 * port opened", "> #1 identify", "< #1 identity 7 joints, driven 0x47, 'EMULATED AESOP'", "> #2 poll",
        "* asked to enable", "status ENABLED homed moving echo", "velocity for 0.2 s:", "* asked to pause",
        "state PAUSED", "skipped ", "CRC errors 1", "faults: motor", "* command 0.05 0 0.01 0 ",
        "* command nan 0 0.01 0 ", "port closed: cable pulled", "state DISABLED homed: disabled on request",
        "* asked to disable: stopped by /somebody", "DISABLED homed: stopped by /somebody"}) {
    EXPECT_NE(text.str().find(part), std::string::npos) << part;
  }
  std::ostringstream summary;
  printer.printSummary(summary);
  for (const char* part : {"turns of the driver", "velocity ", "identity 2", "round trips ", "median 0.00"}) {
    EXPECT_NE(summary.str().find(part), std::string::npos) << part << " in:\n" << summary.str();
  }
}

TEST_F(WireReplayTest, anEmptyRecordingHasASummary) {
  std::ostringstream summary;
  WirePrinter(makeOwnCodec).printSummary(summary);
  EXPECT_NE(summary.str().find("0 records in 0 s"), std::string::npos) << summary.str();
}

}  // namespace
}  // namespace laparoscope_servo::aesop
