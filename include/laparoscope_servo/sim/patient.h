// Motion of tissue and trocar: by breathing, slow drift, and pulls.
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
  double second_harmonic = 0.0;               // amplitude relative to the first harmonic
  double third_harmonic = 0.0;                // amplitude relative to the first harmonic
  double start = 0.0;                         // s: no breathing before
  double end = 1e9;                           // s: the breath is held from then on
  std::vector<double> tissue{0.0, 0.0, 0.0};  // m, amplitude of the first harmonic along each axis
  std::vector<double> trocar{0.0, 0.0, 0.0};  // m, amplitude of the insertion point along each axis
};

// Repeated pulls at the tissue: each moves it smoothly to another place on a circle about its rest position, and nearer
// or further by a third of the radius at most.
struct PullConfig {
  double distance = 0.0;  // m, radius of the circle
  double time = 0.5;      // s, duration of a pull
  double period = 10.0;   // s, from one to the next; at least `time`
};

struct PatientConfig {
  BreathingConfig breathing;
  PullConfig pull;
  std::vector<double> drift{0.0, 0.0, 0.0};  // m/s, drift of the tissue
  double drift_end = 1e9;                    // s: no drift from then on
  std::vector<double> jump{0.0, 0.0, 0.0};   // m: single jump of the tissue
  double jump_time = 1e9;                    // s
  double tilt = 0.0;            // rad: amplitude of the tissue's rotation about the world's x axis through the target
  double tilt_frequency = 0.1;  // Hz
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, PatientConfig& config);

// Every error, each naming the field, its value and what was expected.
std::vector<std::string> validate(const PatientConfig& config);

class Patient {
 public:
  // The configuration must be valid. `target` [m]: the point of the tissue about which it tilts.
  Patient(const PatientConfig& config, const Eigen::Vector3d& target) : config_(config), target_(target) {}

  // Takes points of the tissue at rest to their positions at `time` [s].
  Eigen::Isometry3d tissueMotion(double time) const;

  // m, displacement of the insertion point from its rest position.
  Eigen::Vector3d trocarOffset(double time) const;

 private:
  Eigen::Vector3d pulled(double time) const;

  // Phase of the breath, its first harmonic of amplitude 1; 0 at `start`.
  double breath(double time) const;

  PatientConfig config_;
  Eigen::Vector3d target_;
};

}  // namespace laparoscope_servo::sim
