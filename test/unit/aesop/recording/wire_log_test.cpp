#include "laparoscope_servo/aesop/wire_log.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "support/page_examples.h"
#include "unit/aesop/recorded_session.h"

namespace laparoscope_servo::aesop {
namespace {

const WireLogHeader kHeader{1234567890123456, 5000000000, "some format"};

bool same(const WireRecord& a, const WireRecord& b) {
  return a.event == b.event && a.time == b.time && a.payload == b.payload;
}

void expectError(const Bytes& bytes, const std::string& part) {
  try {
    decoded(bytes);
    FAIL() << "expected an error that says: " << part;
  } catch (const WireLogError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(WireLog, recordsComeBack) {
  const std::vector<WireRecord> records = {
      {WireEvent::kOpened, 5000000000, {}},
      {WireEvent::kSent, 5000000000, {}},
      {WireEvent::kReceived, 5000000127, {0xA5, 0x5A, 0x00}},
      {WireEvent::kCommand, 5000000128 + 16384, payloadOf({0.1, -0.2, 1e-300, -0.0, 1.7e9, 1.7e9})},
      {WireEvent::kState, 9000000000000000000, payloadOf(std::string("text"))},
      {WireEvent::kInsertionPoint, 9000000000000000000, payloadOf({1.0, 2.0, 3.0})},
  };
  const Bytes bytes = encoded(records, kHeader);
  std::istringstream stream(std::string(bytes.begin(), bytes.end()));
  WireLogReader reader(stream);
  EXPECT_EQ(reader.header().wall_time, kHeader.wall_time);
  EXPECT_EQ(reader.header().time, kHeader.time);
  EXPECT_EQ(reader.header().codec, kHeader.codec);
  for (const WireRecord& record : records) {
    const auto read = reader.next();
    ASSERT_TRUE(read);
    EXPECT_TRUE(same(*read, record));
  }
  EXPECT_FALSE(reader.next());
  EXPECT_FALSE(reader.truncated());
  EXPECT_EQ(numbersOf(records[3], 6)[2], 1e-300);
  EXPECT_EQ(textOf(records[4]), "text");
}

TEST(WireLog, isWrittenAsDocumented) {
  const Bytes bytes = encoded({{WireEvent::kOpened, 1000, {}}, {WireEvent::kSent, 1300, {0x42}}}, {2, 1000, "own"});
  EXPECT_EQ(bytes, test_support::pageExamples(WIRE_LOG_DOCUMENT)["recording"]);
}

TEST(WireLog, everyNumberComesBackBitForBit) {
  for (const double value : {0.0, -0.0, 1.0 / 3.0, std::numeric_limits<double>::infinity(), 5e-324, -1.7e308}) {
    const std::vector<double> read = numbersOf({WireEvent::kEnable, 0, payloadOf({value})}, 1);
    EXPECT_EQ(payloadOf({read[0]}), payloadOf({value}));
  }
  EXPECT_TRUE(std::isnan(numbersOf({WireEvent::kEnable, 0, payloadOf({std::nan("")})}, 1)[0]));
  EXPECT_THROW(numbersOf({WireEvent::kEnable, 0, Bytes(7)}, 1), std::invalid_argument);
}

TEST(WireLog, timeNeverGoesBack) {
  const std::vector<WireRecord> read = decoded(encoded(
      {{WireEvent::kSent, 6000000000, {}}, {WireEvent::kPause, 0, {}}, {WireEvent::kSent, 6000000001, {}}}, kHeader));
  EXPECT_EQ(read[1].time, 6000000000);
  EXPECT_EQ(read[2].time, 6000000001);
}

// A process that was killed: the file ends anywhere.
TEST(WireLog, whatBreaksOffIsReadUpToThere) {
  const std::vector<WireRecord> records = {{WireEvent::kSent, 5000000000, Bytes(200, 7)},
                                           {WireEvent::kReceived, 5000300000, Bytes(3, 8)}};
  const Bytes whole = encoded(records, kHeader);
  const std::size_t header = encoded({}, kHeader).size();
  const std::size_t first = encoded({records[0]}, kHeader).size();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    if (size < header) {
      expectError(part, size < 8 ? "no wire log" : "breaks off");
      continue;
    }
    std::istringstream stream(std::string(part.begin(), part.end()));
    WireLogReader reader(stream);
    std::size_t count = 0;
    while (reader.next()) ++count;
    EXPECT_EQ(count, size < first ? 0u : 1u);
    EXPECT_EQ(reader.truncated(), size != header && size != first);
  }
}

TEST(WireLog, whatIsNoRecordingIsNamed) {
  const Bytes good = encoded({{WireEvent::kSent, 5000000000, {1}}}, kHeader);
  const std::size_t header = encoded({}, kHeader).size();
  Bytes bad = good;
  bad[0] = 'X';
  expectError(bad, "byte 8: this is no wire log");
  bad = good;
  bad[8] = 2;
  expectError(bad, "version 2, expected 1");
  bad = good;
  bad[header] = 13;
  expectError(bad, "event 13");
  bad[header] = 0;
  expectError(bad, "event 0");
  bad = encoded({}, kHeader);
  for (const std::uint8_t byte : {4, 0, 0x81, 0x80, 0x04}) bad.push_back(byte);
  expectError(bad, "65537 bytes");
  bad = encoded({}, kHeader);
  bad.push_back(4);
  bad.insert(bad.end(), 10, 0xFF);
  expectError(bad, "63 bits");
  bad.resize(header + 1);
  bad.insert(bad.end(), 8, 0xFF);
  bad.push_back(0x7F);
  bad.push_back(0);
  expectError(bad, "beyond all times");
}

TEST(WireLog, anyDamageEndsInRecordsOrAnError) {
  const Bytes good = encoded(RecordedSession().tap.records, kHeader);
  std::mt19937 random(1);
  for (int k = 0; k < 300; ++k) {
    Bytes bad(good.begin(), good.begin() + 4000);
    for (int m = 0; m < 3; ++m) bad[random() % bad.size()] = static_cast<std::uint8_t>(random());
    try {
      EXPECT_LE(decoded(bad).size(), bad.size());
    } catch (const WireLogError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("byte ", 0), 0u);
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo::aesop
