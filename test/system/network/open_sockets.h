// Which sockets a process and its descendants have open to the network, as the kernel tells.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace laparoscope_servo::test {

struct OpenSocket {
  std::string process;   // name of the program
  std::string protocol;  // tcp, tcp6, udp, udp6
  std::string address;   // hexadecimal, as in /proc/net
  bool loopback = false;
};

// Addresses of /proc/net: four-byte groups in the byte order of the machine, here little-endian.
inline bool isLoopback(const std::string& hex) {
  if (hex.size() == 8) return hex.substr(6) == "7F";
  const std::string mapped = "0000000000000000FFFF0000";
  return hex == "00000000000000000000000001000000" || (hex.rfind(mapped, 0) == 0 && isLoopback(hex.substr(24)));
}

// By inode: TCP sockets that listen, UDP sockets that take from everybody.
inline std::map<std::string, OpenSocket> socketsThatListen() {
  std::map<std::string, OpenSocket> sockets;
  for (const std::string protocol : {"tcp", "tcp6", "udp", "udp6"}) {
    std::ifstream file("/proc/net/" + protocol);
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) {
      std::istringstream fields(line);
      std::string slot, local, remote, state, skipped, inode;
      fields >> slot >> local >> remote >> state;
      for (int k = 0; k < 5; ++k) fields >> skipped;
      fields >> inode;
      if (state != (protocol.rfind("tcp", 0) == 0 ? "0A" : "07")) continue;
      const std::string address = local.substr(0, local.find(':'));
      sockets[inode] = {"", protocol, address, isLoopback(address)};
    }
  }
  return sockets;
}

inline std::map<pid_t, std::vector<pid_t>> childrenOfAll() {
  std::map<pid_t, std::vector<pid_t>> children;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream file(entry.path() / "stat");
    std::string text;
    std::getline(file, text);
    if (text.rfind(')') == std::string::npos) continue;  // it has ended in the meantime
    std::istringstream fields(text.substr(text.rfind(')') + 1));
    std::string state;
    pid_t parent = 0;
    fields >> state >> parent;
    children[parent].push_back(static_cast<pid_t>(std::stol(name)));
  }
  return children;
}

inline std::vector<pid_t> processTree(pid_t root) {
  const auto children = childrenOfAll();
  std::vector<pid_t> tree{root};
  for (std::size_t k = 0; k < tree.size(); ++k) {
    const auto found = children.find(tree[k]);
    if (found != children.end()) tree.insert(tree.end(), found->second.begin(), found->second.end());
  }
  return tree;
}

inline std::vector<OpenSocket> openSockets(pid_t root) {
  const auto listening = socketsThatListen();
  std::vector<OpenSocket> open;
  for (const pid_t pid : processTree(root)) {
    const std::filesystem::path folder = "/proc/" + std::to_string(pid);
    std::string process;
    std::getline(std::ifstream(folder / "comm"), process);
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "fd", error)) {
      const std::string target = std::filesystem::read_symlink(entry.path(), error);
      if (target.rfind("socket:[", 0) != 0) continue;
      const auto found = listening.find(target.substr(8, target.size() - 9));
      if (found == listening.end()) continue;
      open.push_back(found->second);
      open.back().process = process;
    }
  }
  return open;
}

}  // namespace laparoscope_servo::test
