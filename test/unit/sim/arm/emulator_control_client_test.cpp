// The client against a socket that answers what it is told to; against the emulator: emulator_server_test.cpp.
#include "laparoscope_servo/sim/emulator_control_client.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>
#include <functional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "support/error_text.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo::sim {
namespace {

using boost::asio::local::stream_protocol;
using test_support::errorText;

// Answers each line of one client; an empty answer is none.
class Answering {
 public:
  using Answer = std::function<std::string(const std::string&)>;

  explicit Answering(const Answer& answer)
      : acceptor_(context_, stream_protocol::endpoint(folder_.file("control"))),
        thread_([this, answer] { run(answer); }) {}
  ~Answering() { heard(); }
  std::string path() const { return folder_.file("control"); }
  // Every line, once the client has gone.
  std::vector<std::string> heard() {
    if (thread_.joinable()) thread_.join();
    return lines_;
  }

 private:
  // Whether a client, a line or its end has come. One that never comes must not keep the test from ending.
  static bool isReady(int handle) {
    constexpr int kPatience = 20000;  // ms
    pollfd waiting{handle, POLLIN, 0};
    const bool ready = ::poll(&waiting, 1, kPatience) > 0;
    EXPECT_TRUE(ready) << "the client is silent";
    return ready;
  }

  void run(const Answer& answer) {
    stream_protocol::socket socket(context_);
    if (!isReady(acceptor_.native_handle())) return;
    acceptor_.accept(socket);
    std::string buffer;
    boost::system::error_code failure;
    while (isReady(socket.native_handle())) {
      const std::size_t size = boost::asio::read_until(socket, boost::asio::dynamic_buffer(buffer), '\n', failure);
      if (failure) return;
      lines_.push_back(buffer.substr(0, size - 1));
      buffer.erase(0, size);
      const std::string text = answer(lines_.back());
      if (text == "hang up") return;
      boost::asio::write(socket, boost::asio::buffer(text), failure);
    }
  }

  const test_support::TemporaryFolder folder_;
  boost::asio::io_context context_;
  stream_protocol::acceptor acceptor_;
  std::vector<std::string> lines_;
  std::thread thread_;
};

TEST(EmulatorControlClient, ReadsTheAnswersOfTheProtocol) {
  Answering server([](const std::string& line) -> std::string {
    if (line == "state") return "ok 12.5 0.25 1 2 3 4 5 -0.125\n";
    if (line == "motion") return "ok ENABLED 1 6 0.5 0 0 0 0 0 -0.25\n";
    return "ok 0.125 -1 0.75\n";
  });
  EmulatorControlClient client(server.path());
  const EmulatorState state = client.state();
  EXPECT_EQ(state.time, 12.5);
  EXPECT_EQ(state.q[0], 0.25);
  EXPECT_EQ(state.q[6], -0.125);
  const EmulatorMotion motion = client.motion();
  EXPECT_EQ(motion.state, "ENABLED");
  EXPECT_TRUE(motion.moving);
  EXPECT_EQ(motion.faults, 6);
  EXPECT_EQ(motion.qdot[0], 0.5);
  EXPECT_EQ(motion.qdot[6], -0.25);
  const EmulatorRecord record = client.record();
  EXPECT_EQ(record.velocity_age, 0.125);
  EXPECT_EQ(record.motion_age, -1.0);
  EXPECT_EQ(record.longest_motion, 0.75);
}

TEST(EmulatorControlClient, AsksInALineWithAllDigitsThatCount) {
  Answering server([](const std::string&) { return "ok\n"; });
  {
    EmulatorControlClient client(server.path());
    client.hand({0.1, -0.2, 1.23456789012, 0.001}, 0.5);
    client.fault("trocar");
    client.fault("delay", 0.123456789012);
    EXPECT_EQ(client.request("forget"), "");
  }
  EXPECT_EQ(server.heard(), (std::vector<std::string>{"hand 0.1 -0.2 1.23456789012 0.001 0.5", "fault trocar",
                                                      "fault delay 0.123456789012", "forget"}));
}

// A refusal is an error with the request and the answer, and the connection goes on.
TEST(EmulatorControlClient, ARefusalIsAnErrorAndNoEnd) {
  Answering server(
      [](const std::string& line) { return line == "dance" ? "error there is no request\n" : "ok 1 2\n"; });
  EmulatorControlClient client(server.path());
  const std::string refused = errorText<std::runtime_error>([&] { client.request("dance"); });
  EXPECT_NE(refused.find("'dance'"), std::string::npos) << refused;
  EXPECT_NE(refused.find("there is no request"), std::string::npos) << refused;
  EXPECT_EQ(client.request("anything"), "1 2");
  EXPECT_NE(errorText<std::runtime_error>([&] { client.request("state\nstate"); }), "") << "two lines have two answers";
  EXPECT_EQ(client.request("anything"), "1 2");
}

// Too few numbers, or words: named as they came.
TEST(EmulatorControlClient, AnAnswerThatCannotBeReadIsSaid) {
  Answering server([](const std::string&) { return "ok ENABLED 1 6 0.5 0 0 zero\n"; });
  EmulatorControlClient client(server.path());
  for (const auto& call :
       {std::function<void()>([&] { client.state(); }), std::function<void()>([&] { client.motion(); }),
        std::function<void()>([&] { client.record(); })}) {
    const std::string error = errorText<std::runtime_error>(call);
    EXPECT_NE(error.find("cannot read 'ENABLED 1 6 0.5 0 0 zero'"), std::string::npos) << error;
  }
}

// After that a late answer would be taken for that of the next request, so there is none.
TEST(EmulatorControlClient, SilenceEndsTheConnection) {
  Answering server([](const std::string& line) { return line == "first" ? "ok\n" : ""; });
  EmulatorControlClient client(server.path(), 0.2);
  EXPECT_EQ(client.request("first"), "");
  EXPECT_NE(errorText<std::runtime_error>([&] { client.request("second"); }).find("no answer to 'second' in time"),
            std::string::npos);
  EXPECT_NE(errorText<std::runtime_error>([&] { client.request("first"); }).find("has failed before"),
            std::string::npos);
}

TEST(EmulatorControlClient, SaysThatTheEmulatorHasGoneOrNeverWas) {
  std::string gone;
  {
    Answering server([](const std::string&) { return "hang up"; });
    gone = server.path();
    EmulatorControlClient client(server.path(), 5.0);
    EXPECT_NE(errorText<std::runtime_error>([&] { client.request("state"); }).find("has aesop_emulator ended?"),
              std::string::npos);
    EXPECT_NE(errorText<std::runtime_error>([&] { client.request("state"); }).find("has failed before"),
              std::string::npos);
  }
  const std::string error = errorText<std::runtime_error>([&] { EmulatorControlClient client(gone); });
  EXPECT_NE(error.find("control socket '" + gone + "'"), std::string::npos) << error;
  EXPECT_NE(error.find("is aesop_emulator running?"), std::string::npos) << error;
}

}  // namespace
}  // namespace laparoscope_servo::sim
