// roscpp binds its XML-RPC server to every address of the machine, whatever ROS_IP says: everybody on the network could
// end a node, or hand it another publisher. Found before the definition in libxmlrpcpp, this binds it as rospy does: to
// the loopback address when ROS_IP or ROS_HOSTNAME name that one. It is a part of every program of this package; into
// programs of others it is preloaded (LD_PRELOAD), so it needs no library but that of C.
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

// ROS_HOSTNAME is asked first, as everywhere in ROS.
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
