// roscpp binds its XML-RPC server to every address of the machine, whatever ROS_IP is: anybody on the network could end
// a node, or give it another publisher. This definition replaces that in libxmlrpcpp and binds as rospy does: to the
// loopback address if ROS_IP or ROS_HOSTNAME name it. It is linked into every program of this package and preloaded
// (LD_PRELOAD) into other programs, so it needs no library but the C library.
#include <netinet/in.h>
#include <sys/socket.h>
#include <xmlrpcpp/XmlRpcSocket.h>

#include <cstdlib>
#include <cstring>

namespace {

bool isLoopback(const char* address) {
  return std::strcmp(address, "localhost") == 0 || std::strncmp(address, "127.", 4) == 0 ||
         std::strcmp(address, "::1") == 0;
}

// ROS_HOSTNAME has precedence, as everywhere in ROS.
bool onlyLoopback() {
  for (const char* variable : {"ROS_HOSTNAME", "ROS_IP"}) {
    const char* address = std::getenv(variable);
    if (address != nullptr && *address != '\0') return isLoopback(address);
  }
  return false;
}

bool bindTo(int socket, const void* address, socklen_t size) {
  return ::bind(socket, static_cast<const sockaddr*>(address), size) == 0;
}

}  // namespace

bool XmlRpc::XmlRpcSocket::bind(int socket, int port) {
  int family = AF_INET;
  socklen_t size = sizeof(family);
  ::getsockopt(socket, SOL_SOCKET, SO_DOMAIN, &family, &size);
  const auto network_port = htons(static_cast<in_port_t>(port));
  if (family == AF_INET6) {
    sockaddr_in6 address{};
    address.sin6_family = AF_INET6;
    address.sin6_addr = onlyLoopback() ? in6addr_loopback : in6addr_any;
    address.sin6_port = network_port;
    return bindTo(socket, &address, sizeof(address));
  }
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(onlyLoopback() ? INADDR_LOOPBACK : INADDR_ANY);
  address.sin_port = network_port;
  return bindTo(socket, &address, sizeof(address));
}
