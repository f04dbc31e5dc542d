// The emulator as it runs: a port, a control socket, their clients.
#include "laparoscope_servo/sim/emulator_server.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <thread>

#include "aesop/protocol/own_codec.h"
#include "laparoscope_servo/aesop/transport.h"
#include "laparoscope_servo/sim/emulator_control_client.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo::sim {
namespace {

ServerConfig server(const std::string& link, const std::string& control) {
  ServerConfig config;
  config.link = link;
  config.control = control;
  return config;
}

class EmulatorServerTest : public ::testing::Test {
 protected:
  ~EmulatorServerTest() override { end(); }
  void start(int baud_rate = 0, const std::vector<ScheduledFault>& script = {}) {
    ServerConfig config = server(path("port"), path("control"));
    config.baud_rate = baud_rate;
    config.script = script;
    server_ = std::make_unique<EmulatorServer>(EmulatorConfig(), config);
    thread_ = std::thread([this] { server_->run(stop_); });
  }
  void end() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    server_.reset();
  }
  std::string path(const std::string& name) const { return folder_.file(name); }

  template <typename Condition>
  static bool waitFor(Condition condition) {
    const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(3);
    while (!condition()) {
      if (std::chrono::steady_clock::now() > limit) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
  }

  const test_support::TemporaryFolder folder_;
  std::atomic<bool> stop_{false};
  std::unique_ptr<EmulatorServer> server_;
  std::thread thread_;
};

TEST_F(EmulatorServerTest, answersOnThePort) {
  start();
  aesop::SerialTransport transport;
  transport.open(path("port"), 38400);
  transport.write(aesop::encode({1, aesop::Identify()}));
  aesop::Decoder decoder;
  std::vector<aesop::Frame> frames;
  EXPECT_TRUE(waitFor([&] {
    frames = decoder.push(transport.read());
    return !frames.empty();
  }));
  EXPECT_TRUE(std::holds_alternative<aesop::Identity>(frames.at(0).message));
}

TEST_F(EmulatorServerTest, theLineTakesItsTime) {
  start(1200);
  aesop::SerialTransport transport;
  transport.open(path("port"), 38400);
  const auto begin = std::chrono::steady_clock::now();
  transport.write(aesop::encode({1, aesop::Identify()}));
  aesop::Decoder decoder;
  ASSERT_TRUE(waitFor([&] { return !decoder.push(transport.read()).empty(); }));
  const double passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_GE(passed, (9 + 27) * 10.0 / 1200.0);
}

TEST_F(EmulatorServerTest, aScriptRunsByItself) {
  ScheduledFault cut;
  cut.at = 0.1;
  cut.fault.name = "hangup";
  cut.fault.duration = 0.1;
  start(0, {cut});
  const auto is_there = [&] { return ::access(path("port").c_str(), F_OK) == 0; };
  EXPECT_TRUE(waitFor([&] { return !is_there(); }));
  EXPECT_TRUE(waitFor(is_there));
  cut.fault.name = "rust";
  ServerConfig wrong = server(path("other"), "");
  wrong.script = {cut};
  EXPECT_THROW(EmulatorServer(EmulatorConfig(), wrong), std::invalid_argument);
}

TEST_F(EmulatorServerTest, clientOfTheControlSocket) {
  start();
  EmulatorControlClient client(path("control"));
  EmulatorControlClient other(path("control"));
  const EmulatorState before = client.state();
  EXPECT_NEAR(before.q[0], 0.25, 1e-9);
  client.hand({0.0, 0.0, 0.0, 0.01}, 0.1);
  EXPECT_TRUE(waitFor([&] { return !other.motion().moving; }));
  EXPECT_NEAR(other.state().q[0], 0.24, 1e-4);
  EXPECT_GT(other.state().time, before.time);
  EXPECT_THROW(client.request("dance"), std::runtime_error);
  EXPECT_THROW(client.request("state\nstate"), std::runtime_error);
  EXPECT_NO_THROW(client.state()) << "a refusal does not end the connection";
}

// Its requests move the arm by hand.
TEST_F(EmulatorServerTest, controlSocketIsForItsUserAlone) {
  start();
  struct stat found {};
  ASSERT_EQ(::stat(path("control").c_str(), &found), 0);
  EXPECT_TRUE(S_ISSOCK(found.st_mode));
  EXPECT_EQ(found.st_mode & 0777, 0600u);
}

TEST_F(EmulatorServerTest, hangupTakesThePortAwayAndBringsItBack) {
  start();
  EmulatorControlClient client(path("control"));
  aesop::SerialTransport transport;
  transport.open(path("port"), 38400);
  client.fault("hangup");
  EXPECT_TRUE(waitFor([&] { return ::access(path("port").c_str(), F_OK) != 0; }));
  EXPECT_THROW(waitFor([&] { return !transport.read().empty(); }), aesop::TransportError);
  client.fault("return");
  EXPECT_TRUE(waitFor([&] { return ::access(path("port").c_str(), F_OK) == 0; }));
  EXPECT_NO_THROW(transport.open(path("port"), 38400));
}

TEST_F(EmulatorServerTest, endsCleanlyAndTheClientSaysSo) {
  start();
  EmulatorControlClient client(path("control"), 0.5);
  client.state();
  end();
  EXPECT_THROW(client.state(), std::runtime_error);
  EXPECT_THROW(client.state(), std::runtime_error);
  EXPECT_THROW(EmulatorControlClient{path("control")}, std::runtime_error) << "the socket is gone";
  EXPECT_NE(::access(path("port").c_str(), F_OK), 0);
}

TEST_F(EmulatorServerTest, namesThatAreTaken) {
  std::ofstream(path("file")) << "precious";
  EXPECT_THROW(EmulatorServer(EmulatorConfig(), server(path("file"), "")), std::runtime_error);
  EXPECT_THROW(EmulatorServer(EmulatorConfig(), server(path("port"), path("file"))), std::runtime_error);
  EXPECT_THROW(EmulatorServer(EmulatorConfig(), server(path("port"), path("no/such/folder"))), std::runtime_error);
  EXPECT_NE(::access(path("port").c_str(), F_OK), 0) << "no port stays behind";
}

}  // namespace
}  // namespace laparoscope_servo::sim
