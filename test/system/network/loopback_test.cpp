// Started as doc/network.md says, nothing listens beyond the loopback address.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstring>

#include "support/command_output.h"
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

TEST(EnvironmentHook, preloadsNothingIntoTheShell) {
  EXPECT_EQ(afterTheHook("", "LD_PRELOAD"), "");
  EXPECT_EQ(afterTheHook("LD_PRELOAD=libm.so.6", "LD_PRELOAD"), "libm.so.6");
}

// roslaunch reads there what it starts beside the master.
TEST(EnvironmentHook, rosoutIsGivenTheLibraryUnlessSomebodyHasARoscoreOfHisOwn) {
  const std::string own = DEVEL_PREFIX "/share/laparoscope_servo/loopback";
  for (const std::string usual :
       {"", "ROS_ETC_DIR=/etc/ros", "ROS_ETC_DIR=/usr//etc/ros", "ROS_ETC_DIR=/opt/ros/noetic/etc/ros",
        "ROS_ETC_DIR=/x/share/laparoscope_servo/loopback"}) {
    EXPECT_EQ(afterTheHook(usual, "ROS_ETC_DIR"), own) << usual;
  }
  EXPECT_EQ(afterTheHook("ROS_ETC_DIR=/srv/ros", "ROS_ETC_DIR"), "/srv/ros");
  std::stringstream roscore;
  roscore << std::ifstream(own + "/roscore.xml").rdbuf();
  EXPECT_NE(roscore.str().find("liblaparoscope_servo_loopback.so"), std::string::npos);
}

// The linker takes the first definition, and the program's own goes before that of any library.
TEST(Programs, haveABindOfTheirOwn) {
  std::istringstream programs(PROGRAMS);
  int count = 0;
  for (std::string program; std::getline(programs, program, ':'); ++count) {
    const test_support::CommandOutput symbols = test_support::outputOf("nm -D --defined-only '" + program + "'");
    EXPECT_EQ(symbols.status, 0) << symbols.text;
    EXPECT_NE(symbols.text.find(" T _ZN6XmlRpc12XmlRpcSocket4bindEii"), std::string::npos) << program;
  }
  EXPECT_GE(count, 10);
}

class Launch {
 public:
  explicit Launch(const std::string& command)
      : port_(Socket(SOCK_STREAM, "127.0.0.1").port()),
        shell_("/usr/bin/env",
               {"-u", "ROS_IP", "-u", "ROS_HOSTNAME", "-u", "ROS_NAMESPACE", "-u", "LD_PRELOAD", "PATH=/usr/bin:/bin",
                "ROS_HOME=" + folder_.path() + "/ros", "ROS_MASTER_URI=http://localhost:" + std::to_string(port_),
                "bash", "-c", "source '" DEVEL_PREFIX "/setup.bash' && exec " + command},
               folder_.path() + "/log") {}
  ~Launch() {
    shell_.kill(SIGINT);
    shell_.exitStatus(30.0);
  }
  std::vector<OpenSocket> sockets() const { return openSockets(shell_.pid()); }
  // Waits until each of these programs has so many sockets of TCP that listen: two a process, for messages and for
  // XML-RPC.
  bool listens(const std::map<std::string, int>& programs) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < end && shell_.isRunning()) {
      std::map<std::string, int> count;
      for (const OpenSocket& socket : sockets()) count[socket.process] += socket.protocol == "tcp" ? 1 : 0;
      const auto enough = [&](const auto& program) { return count[program.first] >= program.second; };
      if (std::all_of(programs.begin(), programs.end(), enough)) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
  }
  void expectNothingBeyondLoopback() {
    for (int k = 0; k < 20 && !testing::Test::HasFailure(); ++k) {
      for (const OpenSocket& socket : sockets()) {
        EXPECT_TRUE(socket.loopback) << socket.process << " listens by " << socket.protocol << " on " << socket.address;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
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
  const test_support::TemporaryFolder folder;
  Launch demo("roslaunch laparoscope_servo demo.launch rviz:=false port:=" + folder.path() + "/arm");
  // Names as the kernel cuts them. rosout is not this package's.
  ASSERT_TRUE(demo.listens({{"aesop", 2}, {"controller", 2}, {"tracker", 2}, {"simulated_camer", 2}, {"rosout", 2}}))
      << demo.log();
  demo.expectNothingBeyondLoopback();
}

// doc/network.md has the line that gives the library to a manager; tracker.launch has it for what loads the nodelet.
TEST(Loopback, norDoesANodeletManagerThatIsGivenTheLibrary) {
  const test_support::TemporaryFolder folder;
  std::ofstream(folder.file("manager.launch")) << R"(<launch>
  <node pkg="nodelet" type="nodelet" name="manager" args="manager">
    <env name="LD_PRELOAD" value="liblaparoscope_servo_loopback.so"/>
  </node>
  <include file="$(find laparoscope_servo)/launch/tracker.launch"><arg name="manager" value="manager"/></include>
</launch>)";
  Launch managed("roslaunch " + folder.file("manager.launch"));
  ASSERT_TRUE(managed.listens({{"nodelet", 4}, {"rosout", 2}})) << managed.log();
  managed.expectNothingBeyondLoopback();
}

}  // namespace
}  // namespace laparoscope_servo::test
