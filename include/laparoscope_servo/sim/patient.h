// How tissue and trocar move: with the breath, slowly by themselves, and when somebody pulls.
//
// World frame: the camera's at the reference pose (optical: x right, y down, z forward). Deterministic: time is an
// argument.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::sim {

struct BreathingConfig {
  double frequency = 0.25;                    // Hz
  double second_harmonic = 0.0;               // of the amplitude
  double third_harmonic = 0.0;                // the same
  double start = 0.0;                         // s: there is none before
  double end = 1e9;                           // s: held from then on
  std::vector<double> tissue{0.0, 0.0, 0.0};  // m, amplitude of the first harmonic along each axis
  std::vector<double> trocar{0.0, 0.0, 0.0};  // m, the same, of the insertion point
};

// Somebody pulls at the tissue, again and again: each time smoothly to another place on a circle about where it lies at
// rest, and nearer or further by a third of the radius at most.
struct PullConfig {
  double distance = 0.0;  // m, radius of the circle
  double time = 0.5;      // s, that a pull takes
  double period = 10.0;   // s, from one to the next; at least `time`
};

struct PatientConfig {
  BreathingConfig breathing;
  PullConfig pull;
  std::vector<double> drift{0.0, 0.0, 0.0};  // m/s, of the tissue
  double drift_end = 1e9;                    // s: it stands from then on
  std::vector<double> jump{0.0, 0.0, 0.0};   // m: the tissue is pulled so far
  double jump_time = 1e9;                    // s
  double tilt = 0.0;            // rad: the tissue turns to and fro about the world's x axis, through the target
  double tilt_frequency = 0.1;  // Hz
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, PatientConfig& config);

// Every error, each naming the field, its value and what was expected.
std::vector<std::string> validate(const PatientConfig& config);

class Patient {
 public:
  // The configuration must be valid. `target` [m]: the point of the tissue about which it tilts.
  Patient(const PatientConfig& config, const Eigen::Vector3d& target) : config_(config), target_(target) {}

  // Takes points of the tissue as it lies at rest to where they are at `time` [s].
  Eigen::Isometry3d tissueMotion(double time) const;

  // m, of the insertion point from where it is at rest.
  Eigen::Vector3d trocarOffset(double time) const;

 private:
  Eigen::Vector3d pulled(double time) const;

  // Phase of the breath, its first harmonic of amplitude 1; 0 at `start`.
  double breath(double time) const;

  PatientConfig config_;
  Eigen::Vector3d target_;
};

}  // namespace laparoscope_servo::sim
