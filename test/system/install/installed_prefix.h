// The package installed into an empty folder, and a shell that has sourced the setup.bash there and knows nothing else.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/command_output.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo::test {

inline std::string contentOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

class InstalledPrefix {
 public:
  InstalledPrefix() {
    const auto install =
        test_support::outputOf(CMAKE " --install '" PACKAGE_BUILD "' --prefix '" + path() + "' >/dev/null");
    if (install.status != 0) throw std::runtime_error("cmake --install: " + install.text);
    addSetupFiles();
  }
  std::string path() const { return folder_.file("prefix"); }
  std::string scratch(const std::string& name) const { return folder_.file(name); }

  // For bash -c: nothing of the environment of this test comes along.
  std::vector<std::string> shell(const std::string& command, int port) const {
    return {"-i",
            "-C",
            folder_.path(),
            "HOME=" + folder_.path(),
            "PATH=/usr/bin:/bin",
            "ROS_HOME=" + folder_.path() + "/ros",
            "ROS_MASTER_URI=http://localhost:" + std::to_string(port),
            "PYTHONDONTWRITEBYTECODE=1",
            "bash",
            "-c",
            "source '" + path() + "/setup.bash' && " + command};
  }
  test_support::CommandOutput run(const std::string& command, int port) const {
    std::string line = "/usr/bin/env";
    for (const std::string& word : shell(command, port)) line += " '" + replaced(word, "'", "'\\''") + "'";
    return test_support::outputOf(line);
  }

 private:
  // What catkin generates for the prefix that it was configured for, written for this one: CMake installs these files
  // there and nowhere else.
  void addSetupFiles() const {
    std::ofstream(path() + "/.catkin");
    for (const auto& entry : std::filesystem::directory_iterator(BUILD "/catkin_generated/installspace")) {
      if (entry.path().extension() == ".in" || !entry.is_regular_file()) continue;
      const std::string target = path() + "/" + entry.path().filename().string();
      std::ofstream(target) << replaced(contentOf(entry.path()), CONFIGURED_PREFIX, path());
      std::filesystem::permissions(target, entry.status().permissions());
    }
  }

  test_support::TemporaryFolder folder_;
};

}  // namespace laparoscope_servo::test
