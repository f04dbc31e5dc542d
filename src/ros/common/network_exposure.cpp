#include "ros/common/network_exposure.h"

#include <arpa/inet.h>
#include <dirent.h>
#include <ifaddrs.h>
#include <netdb.h>
#include <netinet/in.h>
#include <ros/console.h>
#include <ros/master.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace laparoscope_servo {

namespace {

bool isLoopback(const sockaddr* address) {
  if (address->sa_family == AF_INET)
    return (ntohl(reinterpret_cast<const sockaddr_in*>(address)->sin_addr.s_addr) >> 24) == 127;
  if (address->sa_family != AF_INET6) return false;
  const in6_addr& v6 = reinterpret_cast<const sockaddr_in6*>(address)->sin6_addr;
  return IN6_IS_ADDR_LOOPBACK(&v6) || (IN6_IS_ADDR_V4MAPPED(&v6) && v6.s6_addr[12] == 127);
}

bool sameAddress(const sockaddr* a, const sockaddr* b) {
  if (a->sa_family != b->sa_family) return false;
  if (a->sa_family == AF_INET) {
    return reinterpret_cast<const sockaddr_in*>(a)->sin_addr.s_addr ==
           reinterpret_cast<const sockaddr_in*>(b)->sin_addr.s_addr;
  }
  return a->sa_family == AF_INET6 &&
         std::memcmp(&reinterpret_cast<const sockaddr_in6*>(a)->sin6_addr,
                     &reinterpret_cast<const sockaddr_in6*>(b)->sin6_addr, sizeof(in6_addr)) == 0;
}

bool isOwnAddress(const sockaddr* address) {
  if (isLoopback(address)) return true;
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return false;
  bool own = false;
  for (const ifaddrs* entry = all; entry != nullptr; entry = entry->ifa_next)
    own = own || (entry->ifa_addr != nullptr && sameAddress(entry->ifa_addr, address));
  ::freeifaddrs(all);
  return own;
}

template <typename Test>
bool anyAddress(const std::string& host, Test test) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(host.c_str(), nullptr, &hints, &found) != 0) return false;
  bool any = false;
  for (const addrinfo* entry = found; entry != nullptr; entry = entry->ai_next) any = any || test(entry->ai_addr);
  ::freeaddrinfo(found);
  return any;
}

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

// Address of a socket that listens beyond loopback; empty for any other descriptor.
std::string openAddress(int file) {
  int listens = 0;
  socklen_t size = sizeof(listens);
  if (::getsockopt(file, SOL_SOCKET, SO_ACCEPTCONN, &listens, &size) != 0 || listens == 0) return "";
  sockaddr_storage name{};
  size = sizeof(name);
  const auto* address = reinterpret_cast<const sockaddr*>(&name);
  if (::getsockname(file, reinterpret_cast<sockaddr*>(&name), &size) != 0) return "";
  if ((name.ss_family != AF_INET && name.ss_family != AF_INET6) || isLoopback(address)) return "";
  char host[NI_MAXHOST];
  char port[NI_MAXSERV];
  if (::getnameinfo(address, size, host, sizeof(host), port, sizeof(port), NI_NUMERICHOST | NI_NUMERICSERV) != 0)
    return "";
  return std::string(host) + " port " + port;
}

}  // namespace

std::vector<std::string> addressesBeyondLoopback() {
  std::vector<std::string> addresses;
  DIR* folder = ::opendir("/proc/self/fd");
  if (folder == nullptr) return addresses;
  while (const dirent* entry = ::readdir(folder)) {
    const std::string address = openAddress(std::atoi(entry->d_name));
    if (!address.empty()) addresses.push_back(address);
  }
  ::closedir(folder);
  return addresses;
}

bool spreadOverMachines(const std::string& master) {
  for (const char* name : {"ROS_HOSTNAME", "ROS_IP"}) {
    const std::string value = variable(name);
    if (!value.empty()) return !anyAddress(value, isLoopback);
  }
  return !anyAddress(master, isOwnAddress);
}

std::string exposureWarning(const std::string& master) {
  std::string list;
  for (const std::string& address : addressesBeyondLoopback()) list += (list.empty() ? "" : ", ") + address;
  if (list.empty() || spreadOverMachines(master)) return "";
  return "this node listens to other machines (" + list +
         "), and whoever reaches it can command it; source setup.bash of this workspace, which keeps it to this one, "
         "preload liblaparoscope_servo_loopback.so into a nodelet manager of another package, or set ROS_IP to the "
         "address of the network that it is for";
}

void warnOfExposure() {
  const std::string warning = exposureWarning(ros::master::getHost());
  if (!warning.empty()) ROS_WARN_STREAM(warning);
}

}  // namespace laparoscope_servo
