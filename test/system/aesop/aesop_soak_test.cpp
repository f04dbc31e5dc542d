// The node at its full rate over a line at 38,400 baud that damages frames, for AESOP_SOAK_SECONDS (8 unless set). A
// share AESOP_SOAK_HIT of all frames (0.01 unless set) loses a byte or a bit. Prints what the record needs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>

#include "system/aesop/aesop_bench.h"
#include "system/aesop/process_usage.h"

namespace laparoscope_servo::test {
namespace {

constexpr double kRequestBytes = 27.0;  // of a velocity
constexpr double kReplyBytes = 75.0;    // of a status

double setting(const char* name, double otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atof(text);
}

double share(std::vector<double>& values, double part) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

class Soak {
 public:
  explicit Soak(AesopBench& bench) : bench_(bench) {
    const auto onJoints = [this](const sensor_msgs::JointState::ConstPtr& message) {
      const double stamp = message->header.stamp.toSec();
      if (last_stamp_ > 0.0) gaps_.push_back(stamp - last_stamp_);
      last_stamp_ = stamp;
    };
    subscribers_.push_back(node_.subscribe<sensor_msgs::JointState>("aesop/measured_js", 1000, onJoints));
    const auto onDiagnostics = [this](const diagnostic_msgs::DiagnosticArray::ConstPtr& array) {
      for (const auto& status : array->status) {
        if (status.name.find("AESOP") != std::string::npos) take(status);
      }
    };
    subscribers_.push_back(node_.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10, onDiagnostics));
  }

  // Half of the hits lose a byte, half flip a bit; a byte's chance is such that this share of the frames is hit.
  void damage(double hit) {
    const auto perByte = [hit](double bytes) { return std::to_string(0.5 * (1.0 - std::pow(1.0 - hit, 1.0 / bytes))); };
    for (const char* fault : {"drop ", "corrupt "}) {
      bench_.truth().request("fault " + std::string(fault) + perByte(kRequestBytes) + " to_controller");
      bench_.truth().request("fault " + std::string(fault) + perByte(kReplyBytes) + " to_host");
    }
  }

  void run(double seconds) {
    const double begin = steadyNow();
    cpu_node_ = processorTime(bench_.node().pid());
    cpu_emulator_ = processorTime(bench_.emulator().pid());
    double next = begin;
    while (steadyNow() - begin < seconds) {
      if (!bench_.stateIs("ENABLED")) {
        ++enables_;
        if (!bench_.waitFor([&] { return bench_.isUp(); }, 10.0) || !bench_.enable()) continue;
      }
      // Two seconds there, two seconds back.
      const double pan = std::fmod(steadyNow() - begin, 4.0) < 2.0 ? 0.05 : -0.05;
      bench_.commandUntil([&] { return !bench_.stateIs("ENABLED"); }, pan, 0.5);
      if (steadyNow() < next) continue;
      next += 60.0;
      report(steadyNow() - begin);
    }
    report(steadyNow() - begin);
  }

  double value(const std::string& key) const {
    for (const auto& entry : diagnostics_.values) {
      if (entry.key == key) return std::atof(entry.value.c_str());
    }
    return -1.0;
  }
  int enables() const { return enables_; }
  double longestGap() const { return longest_gap_; }

 private:
  // The node's summaries are of the last ten seconds.
  void take(const diagnostic_msgs::DiagnosticStatus& status) {
    diagnostics_ = status;
    if (!(value("round trip, median [s]") > 0.0)) return;
    medians_.push_back(value("round trip, median [s]"));
    jitters_.push_back(value("round trip, jitter [s]"));
    p99s_.push_back(value("round trip, 99 of 100 [s]"));
    longest_trip_ = std::max(longest_trip_, value("round trip, longest [s]"));
  }

  void report(double elapsed) {
    const double gap = gaps_.empty() ? 0.0 : *std::max_element(gaps_.begin(), gaps_.end());
    longest_gap_ = std::max(longest_gap_, gap);
    std::cout << "soak at " << elapsed << " s: between statuses median " << share(gaps_, 0.5) << ", 99 % "
              << share(gaps_, 0.99) << ", longest " << gap << " s since the last line; node "
              << residentMemory(bench_.node().pid()) << " MiB, emulator " << residentMemory(bench_.emulator().pid())
              << " MiB; processor node " << processorShare(cpu_node_, bench_.node().pid(), elapsed) << " %, emulator "
              << processorShare(cpu_emulator_, bench_.emulator().pid(), elapsed) << " %; enables " << enables_
              << "; round trip median " << share(medians_, 0.5) << ", 99 of 100 " << share(p99s_, 0.5)
              << ", in the worst ten seconds " << share(p99s_, 1.0) << ", longest " << longest_trip_ << ", jitter "
              << share(jitters_, 0.5) << " s;";
    for (const char* key : {"requests sent", "statuses received", "replies lost", "CRC errors", "malformed frames",
                            "bytes skipped", "sessions"}) {
      std::cout << ' ' << key << ' ' << value(key) << ';';
    }
    std::cout << std::endl;
    gaps_.clear();
  }

  // % of one processor since the beginning.
  static double processorShare(double before, pid_t pid, double elapsed) {
    return 100.0 * (processorTime(pid) - before) / std::max(elapsed, 1e-3);
  }

  AesopBench& bench_;
  ros::NodeHandle node_;
  std::vector<ros::Subscriber> subscribers_;
  diagnostic_msgs::DiagnosticStatus diagnostics_;
  std::vector<double> gaps_;
  std::vector<double> medians_;
  std::vector<double> p99s_;
  std::vector<double> jitters_;
  double longest_trip_ = 0.0;
  double last_stamp_ = 0.0;
  double longest_gap_ = 0.0;
  double cpu_node_ = 0.0;
  double cpu_emulator_ = 0.0;
  int enables_ = 0;
};

TEST(AesopSoak, aLineThatDamagesFrames) {
  AesopBench bench;
  Soak soak(bench);
  soak.damage(setting("AESOP_SOAK_HIT", 0.01));
  const double seconds = setting("AESOP_SOAK_SECONDS", 8.0);
  soak.run(seconds);
  EXPECT_GT(soak.value("statuses received"), 25.0 * seconds);
  EXPECT_LE(soak.enables(), 1 + static_cast<int>(seconds / 600.0)) << "a little damage ends no session";
  EXPECT_TRUE(bench.node().isRunning());
}

}  // namespace
}  // namespace laparoscope_servo::test

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "aesop_soak_test");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
