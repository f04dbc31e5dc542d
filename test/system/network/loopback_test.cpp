// Started as doc/network.md says, nothing listens beyond the loopback address.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstring>

#include "support/temporary_folder.h"
#include "system/aesop/child_process.h"
#include "system/network/open_sockets.h"

namespace laparoscope_servo::test {
namespace {

class Socket {
 public:
  Socket(int type, const char* address) : file_(::socket(AF_INET, type, 0)) {
    sockaddr_in name{};
    name.sin_family = AF_INET;
    ::inet_pton(AF_INET, address, &name.sin_addr);
    if (::bind(file_, reinterpret_cast<const sockaddr*>(&name), sizeof(name)) != 0) throw std::runtime_error("bind");
    if (type == SOCK_STREAM) ::listen(file_, 1);
  }
  ~Socket() { ::close(file_); }
  int port() const {
    sockaddr_in name{};
    socklen_t size = sizeof(name);
    ::getsockname(file_, reinterpret_cast<sockaddr*>(&name), &size);
    return ntohs(name.sin_port);
  }

 private:
  int file_;
};

// The measurement has to see what it is to find.
TEST(OpenSockets, tellsLoopbackFromTheRest) {
  const auto count = [](bool loopback) {
    const std::vector<OpenSocket> open = openSockets(::getpid());
    return std::count_if(open.begin(), open.end(), [&](const OpenSocket& s) { return s.loopback == loopback; });
  };
  EXPECT_EQ(count(true) + count(false), 0);
  const Socket local(SOCK_STREAM, "127.0.0.1");
  const Socket local_udp(SOCK_DGRAM, "127.1.2.3");
  EXPECT_EQ(count(true), 2);
  EXPECT_EQ(count(false), 0);
  const Socket open(SOCK_STREAM, "0.0.0.0");
  const Socket open_udp(SOCK_DGRAM, "0.0.0.0");
  EXPECT_EQ(count(true), 2);
  EXPECT_EQ(count(false), 2);
  EXPECT_TRUE(isLoopback("00000000000000000000000001000000"));
  EXPECT_TRUE(isLoopback("0000000000000000FFFF00000100007F"));
  EXPECT_FALSE(isLoopback("00000000000000000000000000000000"));
  EXPECT_FALSE(isLoopback("0000000000000000FFFF00000A00A8C0"));
}

// What a shell in this environment has after the hook, sourced twice as in overlaid workspaces.
std::string afterTheHook(const std::string& environment, const std::string& variable) {
  const std::string command = "env -i PATH=/usr/bin:/bin " + environment +
                              " CATKIN_ENV_HOOK_WORKSPACE='" DEVEL_PREFIX "' sh -eu -c '. \"" ENV_HOOK
                              "\"; . \"" ENV_HOOK "\"; echo \"${" +
                              variable + ":-}\"'";
  FILE* output = ::popen(command.c_str(), "r");
  char line[4096] = "";
  if (output == nullptr || std::fgets(line, sizeof(line), output) == nullptr) return "nothing came of it";
  if (::pclose(output) != 0) return "it failed";
  return std::string(line, std::strcspn(line, "\n"));
}

TEST(EnvironmentHook, keepsToLoopbackUnlessTheEnvironmentTellsOfOtherMachines) {
  for (const char* local : {"", "ROS_MASTER_URI=http://localhost:11311", "ROS_MASTER_URI=http://localhost",
                            "ROS_MASTER_URI=http://127.0.0.1:11312/", "ROS_IP= ROS_HOSTNAME="}) {
    EXPECT_EQ(afterTheHook(local, "ROS_IP"), "127.0.0.1") << local;
  }
  EXPECT_EQ(afterTheHook("", "ROS_MASTER_URI"), "");
  EXPECT_EQ(afterTheHook("ROS_MASTER_URI=http://127.0.0.1:11312/", "ROS_MASTER_URI"), "http://127.0.0.1:11312/");
  EXPECT_EQ(afterTheHook("ROS_MASTER_URI=http://localhost:11312", "ROS_MASTER_URI"), "http://localhost:11312");
  for (const char* spread :
       {"ROS_MASTER_URI=http://cart:11311", "ROS_MASTER_URI=http://localhost.example.org:11311",
        "ROS_MASTER_URI=http://127.example.org:11311", "ROS_MASTER_URI=http://192.0.2.77:11311",
        "ROS_MASTER_URI=http://[2001:db8::77]:11311", "ROS_HOSTNAME=cart", "ROS_HOSTNAME=localhost"}) {
    EXPECT_EQ(afterTheHook(spread, "ROS_IP"), "") << spread;
  }
  EXPECT_EQ(afterTheHook("ROS_IP=10.9.0.2", "ROS_IP"), "10.9.0.2");
}

// A master that binds to 127.0.0.1 answers on no other address of the machine.
TEST(EnvironmentHook, thisMachineInAnySpellingIsThisMachine) {
  char name[256] = "";
  ASSERT_EQ(::gethostname(name, sizeof(name) - 1), 0);
  std::string upper = name;
  std::transform(upper.begin(), upper.end(), upper.begin(), [](unsigned char c) { return std::toupper(c); });
  const std::string node = name;
  for (const std::string& host :
       {std::string("LocalHost"), std::string("localhost."), std::string("127.0.1.1"), std::string("127.0.0.2"),
        std::string("[::1]"), std::string("0.0.0.0"), node, upper, node + ".", node.substr(0, node.find('.'))}) {
    const std::string environment = "ROS_MASTER_URI=http://" + host + ":11312/";
    EXPECT_EQ(afterTheHook(environment, "ROS_IP"), "127.0.0.1") << host;
    EXPECT_EQ(afterTheHook(environment, "ROS_MASTER_URI"), "http://localhost:11312/") << host;
  }
}

TEST(EnvironmentHook, preloadsItsLibraryOnceAndKeepsOthers) {
  const std::string library = DEVEL_PREFIX "/lib/liblaparoscope_servo_loopback.so";
  EXPECT_EQ(afterTheHook("", "LD_PRELOAD"), library);
  EXPECT_EQ(afterTheHook("LD_PRELOAD=libm.so.6", "LD_PRELOAD"), library + ":libm.so.6");
}

class Launch {
 public:
  explicit Launch(const std::string& command)
      : port_(Socket(SOCK_STREAM, "127.0.0.1").port()),
        shell_(
            "/usr/bin/env",
            {"-u", "ROS_IP", "-u", "ROS_HOSTNAME", "-u", "ROS_NAMESPACE", "-u", "LD_PRELOAD", "PATH=/usr/bin:/bin",
             "ROS_HOME=" + folder_.path() + "/ros", "ROS_MASTER_URI=http://localhost:" + std::to_string(port_), "bash",
             "-c", "source '" DEVEL_PREFIX "/setup.bash' && exec " + command + " port:=" + folder_.path() + "/arm"},
            folder_.path() + "/log") {}
  ~Launch() {
    shell_.kill(SIGINT);
    shell_.exitStatus(30.0);
  }
  std::vector<OpenSocket> sockets() const { return openSockets(shell_.pid()); }
  // Waits until each of these programs listens, twice: for messages and for XML-RPC.
  bool listens(const std::vector<std::string>& programs) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < end && shell_.isRunning()) {
      std::map<std::string, int> count;
      for (const OpenSocket& socket : sockets()) count[socket.process] += socket.protocol == "tcp" ? 1 : 0;
      if (std::all_of(programs.begin(), programs.end(), [&](const auto& name) { return count[name] >= 2; }))
        return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
  }
  std::string log() const {
    std::ostringstream text;
    text << std::ifstream(folder_.path() + "/log").rdbuf();
    return text.str().substr(std::max<std::size_t>(text.str().size(), 3000) - 3000);
  }

 private:
  test_support::TemporaryFolder folder_;
  int port_;
  ChildProcess shell_;
};

TEST(Loopback, nothingOfTheDemoListensBeyondIt) {
  Launch demo("roslaunch laparoscope_servo demo.launch rviz:=false");
  // Names as the kernel cuts them. rosout is not this package's.
  ASSERT_TRUE(demo.listens({"aesop", "controller", "tracker", "simulated_camer", "rosout"})) << demo.log();
  for (int k = 0; k < 20; ++k) {
    for (const OpenSocket& socket : demo.sockets()) {
      EXPECT_TRUE(socket.loopback) << socket.process << " listens by " << socket.protocol << " on " << socket.address;
    }
    if (testing::Test::HasFailure()) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

}  // namespace
}  // namespace laparoscope_servo::test
