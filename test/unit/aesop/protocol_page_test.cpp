// doc/aesop_protocol.md against the codec: its examples, and a decoder written from it alone.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "messages.h"
#include "support/codec_check.h"
#include "support/page_examples.h"
#include "support/stream_mutator.h"

namespace laparoscope_servo::aesop {
namespace {

using test_support::PageDecoder;
using test_support::PageFrame;

std::map<std::string, Bytes> examples() {
  return test_support::pageExamples(PROTOCOL_DOCUMENT);
}

template <typename T>
T decodeExample(const std::string& name, std::uint16_t sequence) {
  const Bytes bytes = examples()[name];
  const std::vector<Frame> frames = Decoder().push(bytes);
  if (frames.size() != 1 || !std::holds_alternative<T>(frames[0].message))
    throw std::runtime_error("no such example: " + name);
  EXPECT_EQ(frames[0].sequence, sequence) << name;
  EXPECT_EQ(encode(frames[0]), bytes) << name << " is not what the encoder writes";
  return std::get<T>(frames[0].message);
}

TEST(ProtocolPage, examplesOfEveryType) {
  decodeExample<Identify>("identify", 0);
  decodeExample<Enable>("enable", 1);
  decodeExample<Disable>("disable", 259);
  decodeExample<Stop>("stop", 260);
  decodeExample<ClearFault>("clear fault", 261);
  decodeExample<Poll>("poll", 262);
  const Velocity velocity = decodeExample<Velocity>("velocity", 258);
  EXPECT_DOUBLE_EQ(velocity.time_to_live, 0.2);
  EXPECT_DOUBLE_EQ(velocity.speed[0], -0.0004);
  EXPECT_DOUBLE_EQ(velocity.speed[2], -0.0033);
  const Identity identity = decodeExample<Identity>("identity", 0);
  EXPECT_EQ(identity.joints, 7);
  EXPECT_EQ(identity.driven, 0x47);
  EXPECT_EQ(identity.model, "EMULATED AESOP");
  const Status status = decodeExample<Status>("status", 258);
  EXPECT_EQ(status.state, RobotState::kEnabled);
  EXPECT_TRUE(status.homed && status.moving);
  EXPECT_EQ(status.faults, 0);
  EXPECT_EQ(status.echo, 258);
  EXPECT_DOUBLE_EQ(status.time, 12.345);
  EXPECT_DOUBLE_EQ(status.position[1], -0.9);
  EXPECT_DOUBLE_EQ(status.velocity[6], 0.005);
  std::set<std::size_t> types;
  for (const auto& [name, bytes] : examples()) {
    const std::vector<Frame> frames = Decoder().push(bytes);
    if (frames.size() == 1) types.insert(frames[0].message.index());
  }
  EXPECT_EQ(types.size(), std::variant_size_v<Message>) << "a type has no example";
}

TEST(ProtocolPage, exampleOfABadLine) {
  Decoder decoder;
  const std::vector<Frame> frames = decoder.push(examples()["stream"]);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<Poll>(frames[0].message));
  EXPECT_EQ(frames[0].sequence, 263);
  EXPECT_TRUE(std::holds_alternative<Disable>(frames[1].message));
  EXPECT_EQ(frames[1].sequence, 265);
  EXPECT_EQ(decoder.statistics().crc_errors, 1u);
  EXPECT_EQ(decoder.statistics().skipped_bytes, 32u);
  EXPECT_EQ(decoder.pending(), 0u);
}

TEST(ProtocolPage, sumOfTheNineCharacters) {
  const Bytes check = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(PageDecoder::crc(check.data(), check.size()), 0x29B1u);
}

std::int64_t micro(double value) {
  return std::llround(value * 1e6);
}

// What the page's tables call the fields, from the message.
PageFrame asPageFrame(const Frame& frame) {
  PageFrame page;
  page.sequence = frame.sequence;
  constexpr std::array<unsigned, 9> kTypes = {1, 2, 3, 4, 5, 6, 7, 0x81, 0x82};
  page.type = kTypes.at(frame.message.index());
  if (const auto* velocity = std::get_if<Velocity>(&frame.message)) {
    page.fields.push_back(std::llround(velocity->time_to_live * 1e3));
    for (const double speed : velocity->speed) page.fields.push_back(micro(speed));
  } else if (const auto* identity = std::get_if<Identity>(&frame.message)) {
    page.fields = {identity->joints, identity->driven};
    page.text = identity->model;
  } else if (const auto* status = std::get_if<Status>(&frame.message)) {
    page.fields = {static_cast<int>(status->state), (status->homed ? 1 : 0) + (status->moving ? 2 : 0), status->faults,
                   status->echo, std::llround(status->time * 1e3)};
    for (int k = 0; k < kJoints; ++k) page.fields.push_back(micro(status->position[k]));
    for (int k = 0; k < kJoints; ++k) page.fields.push_back(micro(status->velocity[k]));
  }
  return page;
}

void expectSame(const Frame& frame, const PageFrame& page) {
  const PageFrame expected = asPageFrame(frame);
  EXPECT_EQ(page.sequence, expected.sequence);
  EXPECT_EQ(page.type, expected.type);
  EXPECT_EQ(page.fields, expected.fields);
  EXPECT_EQ(page.text, expected.text);
}

TEST(ProtocolPage, aDecoderWrittenFromItReadsTheExamples) {
  for (const auto& [name, bytes] : examples()) {
    SCOPED_TRACE(name);
    const std::vector<Frame> ours = Decoder().push(bytes);
    const test_support::PageResult page = PageDecoder::decode(bytes);
    ASSERT_EQ(page.frames.size(), ours.size());
    for (std::size_t k = 0; k < ours.size(); ++k) expectSame(ours[k], page.frames[k]);
  }
}

TEST(ProtocolPage, aDecoderWrittenFromItReadsWhatIsEncoded) {
  test_support::StreamMutator random(3);
  for (int k = 0; k < 20000; ++k) {
    const Frame frame{static_cast<std::uint16_t>(random.below(65536)), random.message()};
    const test_support::PageResult page = PageDecoder::decode(encode(frame));
    ASSERT_EQ(page.frames.size(), 1u);
    expectSame(frame, page.frames[0]);
    if (HasFailure()) break;
  }
}

// The fuzz target's first inputs, in pieces of all lengths.
TEST(ProtocolPage, bothDecodersAgreeOnTheCorpus) {
  std::map<std::string, Bytes> corpus = examples();
  for (const auto& entry : std::filesystem::directory_iterator(FUZZ_CORPUS)) {
    std::stringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    corpus[entry.path().filename().string()] = test_support::bytesOf(text.str());
  }
  EXPECT_GE(corpus.size(), examples().size() + 8);
  for (const auto& [name, bytes] : corpus) {
    SCOPED_TRACE(name);
    ASSERT_FALSE(bytes.empty());
    const test_support::PageResult page = PageDecoder::decode(bytes);
    for (std::size_t piece = 1; piece <= bytes.size(); ++piece) {
      EXPECT_EQ(test_support::checkCodec(bytes, {piece}, page).violation, "") << "in pieces of " << piece;
    }
  }
}

}  // namespace
}  // namespace laparoscope_servo::aesop
