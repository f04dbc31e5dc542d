#include "ros/common/network_exposure.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>

namespace laparoscope_servo {
namespace {

class Listener {
 public:
  Listener(int family, const char* address) : file_(::socket(family, SOCK_STREAM, 0)) {
    sockaddr_storage name{};
    socklen_t size = sizeof(sockaddr_in);
    name.ss_family = static_cast<sa_family_t>(family);
    if (family == AF_INET) {
      ::inet_pton(AF_INET, address, &reinterpret_cast<sockaddr_in&>(name).sin_addr);
    } else {
      ::inet_pton(AF_INET6, address, &reinterpret_cast<sockaddr_in6&>(name).sin6_addr);
      size = sizeof(sockaddr_in6);
    }
    works_ =
        file_ >= 0 && ::bind(file_, reinterpret_cast<const sockaddr*>(&name), size) == 0 && ::listen(file_, 1) == 0;
  }
  ~Listener() { ::close(file_); }
  bool works() const { return works_; }

 private:
  int file_;
  bool works_ = false;
};

class NetworkExposure : public ::testing::Test {
 protected:
  NetworkExposure() {
    ::unsetenv("ROS_IP");
    ::unsetenv("ROS_HOSTNAME");
  }
};

TEST_F(NetworkExposure, loopbackIsNoExposure) {
  EXPECT_TRUE(addressesBeyondLoopback().empty());
  const Listener local(AF_INET, "127.0.0.1");
  const Listener also_local(AF_INET, "127.3.2.1");
  const Listener local6(AF_INET6, "::1");
  ASSERT_TRUE(local.works() && also_local.works());
  EXPECT_TRUE(addressesBeyondLoopback().empty());
  EXPECT_EQ(exposureWarning("localhost"), "");
}

TEST_F(NetworkExposure, everyAddressIsNamed) {
  const Listener open(AF_INET, "0.0.0.0");
  ASSERT_TRUE(open.works());
  ASSERT_EQ(addressesBeyondLoopback().size(), 1u);
  EXPECT_EQ(addressesBeyondLoopback()[0].rfind("0.0.0.0 port ", 0), 0u);
  EXPECT_NE(exposureWarning("localhost").find("0.0.0.0 port "), std::string::npos);
  const Listener open6(AF_INET6, "::");
  EXPECT_EQ(addressesBeyondLoopback().size(), open6.works() ? 2u : 1u);
}

TEST_F(NetworkExposure, whoAskedForItIsNotWarned) {
  const Listener open(AF_INET, "0.0.0.0");
  ::setenv("ROS_IP", "10.9.0.2", 1);
  EXPECT_EQ(exposureWarning("localhost"), "");
  ::setenv("ROS_IP", "127.0.0.1", 1);
  EXPECT_NE(exposureWarning("localhost"), "") << "it was told to keep to loopback";
  EXPECT_NE(exposureWarning("10.9.0.2"), "");
  ::setenv("ROS_HOSTNAME", "10.9.0.3", 1);
  EXPECT_EQ(exposureWarning("localhost"), "") << "ROS asks ROS_HOSTNAME first";
  ::unsetenv("ROS_HOSTNAME");
  ::unsetenv("ROS_IP");
  EXPECT_EQ(exposureWarning("10.9.0.2"), "") << "a master elsewhere";
}

TEST_F(NetworkExposure, aMasterOnThisMachineIsNoOtherMachine) {
  for (const char* own : {"localhost", "127.0.0.1", "127.0.1.1", "::1"}) EXPECT_FALSE(spreadOverMachines(own)) << own;
  EXPECT_TRUE(spreadOverMachines("192.0.2.1"));  // of an example network, RFC 5737
}

}  // namespace
}  // namespace laparoscope_servo
