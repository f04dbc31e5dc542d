// The watch against a master that does what the test wants: refuses, hangs, lies, is another one.
#include "ros/common/master_watch.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "ros/common/clocks.h"

namespace laparoscope_servo {
namespace {

using State = MasterStatus::State;

const std::string kNode = "/arm";
const std::string kUri = "http://here:1234/";

// Answers getPid and lookupNode as a master does, one connection after the other.
class FakeMaster {
 public:
  explicit FakeMaster(int port = 0) { listen(port); }
  ~FakeMaster() { close(); }

  int port() const { return port_; }
  // What the watch sees when the process dies, and when it is there again.
  void close() {
    ending_ = true;
    if (thread_.joinable()) thread_.join();
    for (std::thread& connection : connections_) connection.join();
    connections_.clear();
    if (listener_ >= 0) ::close(listener_);
    listener_ = -1;
  }
  void listen(int port) {
    ending_ = false;
    listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int yes = 1;
    ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    sockaddr_in name{};
    name.sin_family = AF_INET;
    name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    name.sin_port = htons(static_cast<std::uint16_t>(port));
    if (::bind(listener_, reinterpret_cast<sockaddr*>(&name), sizeof(name)) != 0) throw std::runtime_error("bind");
    socklen_t size = sizeof(name);
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&name), &size);
    port_ = ntohs(name.sin_port);
    ::listen(listener_, 5);
    thread_ = std::thread([this] { serve(); });
  }

  std::atomic<int> pid_{100};
  std::atomic<bool> knows_{true};
  std::atomic<bool> hangs_{false};       // takes connections, and answers nothing while this holds
  std::atomic<bool> closes_{false};      // takes connections, and closes them
  std::atomic<bool> other_node_{false};  // of this name, at another address
  std::atomic<bool> is_web_server_{false};
  std::atomic<int> answers_{0};

 private:
  void serve() {
    while (!ending_) {
      pollfd entry{listener_, POLLIN, 0};
      if (::poll(&entry, 1, 10) <= 0) continue;
      const int connection = ::accept(listener_, nullptr, nullptr);
      connections_.emplace_back([this, connection] {
        answer(connection);
        ::close(connection);
      });
    }
  }
  void answer(int connection) {
    if (closes_) return;
    std::string question;
    char buffer[1024];
    while (question.find("</methodCall>") == std::string::npos) {
      pollfd entry{connection, POLLIN, 0};
      if (ending_) return;
      if (::poll(&entry, 1, 10) <= 0) continue;
      const ssize_t count = ::recv(connection, buffer, sizeof(buffer), 0);
      if (count <= 0) return;
      question.append(buffer, static_cast<std::size_t>(count));
    }
    while (hangs_ && !ending_) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    std::string value = "<value><int>" + std::to_string(pid_) + "</int></value>";
    std::string code = "1";
    if (question.find("lookupNode") != std::string::npos) {
      if (!knows_) code = "-1";
      value = "<value><string>" +
              std::string(!knows_       ? ""
                          : other_node_ ? "http://there:1/"
                                        : kUri) +
              "</string></value>";
    }
    std::string body =
        "<?xml version='1.0'?>\n<methodResponse>\n<params>\n<param>\n<value><array><data>\n<value><int>" + code +
        "</int></value>\n<value><string>words</string></value>\n" + value +
        "\n</data></array></value>\n</param>\n</params>\n</methodResponse>\n";
    if (is_web_server_) body = "<html>welcome</html>";
    const std::string text = "HTTP/1.0 200 OK\r\nServer: test\r\nContent-Length: " + std::to_string(body.size()) +
                             "\r\nContent-type: text/xml\r\n\r\n" + body;
    // In two pieces, as a network may deliver it.
    ++answers_;
    ::send(connection, text.data(), 30, MSG_NOSIGNAL);
    ::send(connection, text.data() + 30, text.size() - 30, MSG_NOSIGNAL);
  }

  std::atomic<bool> ending_{false};
  int listener_ = -1;
  int port_ = 0;
  std::thread thread_;
  std::vector<std::thread> connections_;
};

class MasterWatchTest : public ::testing::Test {
 protected:
  MasterWatchTest() {
    config_.period = 0.05;
    config_.patience = 5.0;  // a busy machine is late
  }
  void watch() {
    watch_ =
        std::make_unique<MasterWatch>(config_, "localhost", static_cast<std::uint32_t>(master_.port()), kNode, kUri);
    ASSERT_TRUE(waitFor([&] { return watch_->status().answer_time > 0.0; }));
  }
  template <typename Condition>
  static bool waitFor(Condition condition, double seconds = 20.0) {
    const double end = steadyNow() + seconds;
    while (!condition()) {
      if (steadyNow() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }
  bool becomes(State state) {
    return waitFor([&] { return watch_->status().state == state; });
  }
  // For as many answers.
  bool stays(State state, int answers) {
    const int end = master_.answers_ + answers;
    bool stayed = true;
    return waitFor([&] {
             stayed = stayed && watch_->status().state == state;
             return !stayed || master_.answers_ >= end;
           }) &&
           stayed;
  }
  std::string reason() { return watch_->status().reason; }

  FakeMaster master_;
  MasterWatchConfig config_;
  std::unique_ptr<MasterWatch> watch_;
};

TEST_F(MasterWatchTest, aMasterThatKnowsTheNodeIsFine) {
  watch();
  EXPECT_TRUE(stays(State::kKnown, 20));
  EXPECT_EQ(reason(), "");
  EXPECT_GE(watch_->status().longest, watch_->status().answer_time);
}

TEST_F(MasterWatchTest, goneAndBackAgain) {
  watch();
  master_.close();
  ASSERT_TRUE(becomes(State::kGone));
  EXPECT_NE(reason().find("localhost:" + std::to_string(master_.port()) + " is gone"), std::string::npos) << reason();
  master_.listen(master_.port());
  EXPECT_TRUE(becomes(State::kKnown)) << "the same one: " << reason();
}

TEST_F(MasterWatchTest, anotherProcessIsAnotherMaster) {
  watch();
  master_.pid_ = 101;
  ASSERT_TRUE(becomes(State::kChanged)) << "though it happens to know the node";
  EXPECT_NE(reason().find("process 101"), std::string::npos) << reason();
}

TEST_F(MasterWatchTest, aMasterThatHasForgottenTheNode) {
  watch();
  master_.knows_ = false;
  ASSERT_TRUE(becomes(State::kChanged));
  EXPECT_NE(reason().find("does not know this node"), std::string::npos) << reason();
}

TEST_F(MasterWatchTest, anotherNodeOfTheName) {
  watch();
  master_.other_node_ = true;
  ASSERT_TRUE(becomes(State::kChanged));
  EXPECT_NE(reason().find("http://there:1/"), std::string::npos) << reason();
}

TEST_F(MasterWatchTest, aSlowAnswerIsNotADeadMaster) {
  watch();
  master_.hangs_ = true;
  EXPECT_TRUE(waitFor([&] {
    const double asked_at = watch_->status().asked_at;
    return asked_at > 0.0 && steadyNow() - asked_at > 0.3;
  })) << "who looks sees how long it takes";
  EXPECT_EQ(watch_->status().state, State::kKnown);
  master_.hangs_ = false;
  EXPECT_TRUE(stays(State::kKnown, 10)) << reason();
  EXPECT_GE(watch_->status().longest, 0.2);
}

TEST_F(MasterWatchTest, noAnswerWithinThePatienceIsSilence) {
  config_.patience = 0.5;
  watch();
  master_.hangs_ = true;
  ASSERT_TRUE(becomes(State::kSilent));
  EXPECT_NE(reason().find("has not answered for 0.5 s"), std::string::npos) << reason();
  master_.hangs_ = false;
  EXPECT_TRUE(becomes(State::kKnown));
}

TEST_F(MasterWatchTest, whatClosesTheConnectionOrSpeaksOtherwiseIsNoMaster) {
  watch();
  master_.closes_ = true;
  EXPECT_TRUE(becomes(State::kGone));
  master_.closes_ = false;
  EXPECT_TRUE(becomes(State::kKnown));
  master_.is_web_server_ = true;
  EXPECT_TRUE(becomes(State::kGone));
  EXPECT_NE(reason().find("no ROS master"), std::string::npos) << reason();
}

TEST_F(MasterWatchTest, theEndDoesNotWaitForAnAnswer) {
  config_.patience = 60.0;
  watch();
  master_.hangs_ = true;
  const int answers = master_.answers_;
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_LE(master_.answers_, answers + 1);
  const double start = steadyNow();
  watch_.reset();
  EXPECT_LT(steadyNow() - start, 20.0);
}

TEST(MasterWatchConfig, errorsAreNamed) {
  EXPECT_TRUE(validate(MasterWatchConfig()).empty());
  MasterWatchConfig config;
  config.period = config.hold = config.patience = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(validate(config).size(), 3u);
  config = MasterWatchConfig();
  config.patience = 0.2;
  EXPECT_EQ(validate(config).size(), 1u) << "less than hold";
}

}  // namespace
}  // namespace laparoscope_servo
