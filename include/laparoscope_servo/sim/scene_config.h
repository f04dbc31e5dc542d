// Parameters of the simulated camera and its scene. Defaults are those of config/simulation.yaml.
//
// The tissue is a plane with a frame of its own: origin in the middle of the texture, x to the texture's right, y down
// in it, z into the tissue, so that a camera that looks at it squarely has parallel axes.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "laparoscope_servo/geometry/camera.h"

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::sim {

struct TissueConfig {
  std::string image;        // file with the texture; empty: made from the seed
  int seed = 1;             // >= 0
  int texture_side = 2400;  // px, of the texture made from the seed
  double width = 0.30;      // m, > 0, of the texture; it is mirrored beyond its edges
  double distance = 0.08;   // m, > 0, along the optical axis from the camera at the start pose
  double tilt_x = 0.0;      // rad, about the x axis of the camera at the start pose
  double tilt_y = 0.0;      // rad, then about the tissue's y axis
};

struct LightConfig {
  double reference_distance = 0.08;  // m, > 0: distance at which tissue seen squarely has the brightness of its texture
  // brightness of lamp and lens falls with this power of the cosine of the angle to the optical axis
  double beam_exponent = 0.0;
};

struct ExposureConfig {
  bool automatic = true;
  double gain = 1.0;           // fixed gain, if not automatic
  double target = 75.0;        // grey levels: target mean of the image for the automatic gain
  double time_constant = 0.4;  // s, > 0
};

struct InstrumentConfig {
  double radius = 0.0025;                           // m, > 0
  Eigen::Vector3d trocar = {0.11, 0.12, -0.14};     // m, tissue frame: point through which the shaft enters
  Eigen::Vector3d start = {-0.075, -0.03, -0.025};  // m, tissue frame: tip at the beginning of a crossing ...
  Eigen::Vector3d end = {0.085, 0.03, -0.025};      // ... and at its end
  double crossing_time = 4.0;                       // s, > 0
  double period = 0.0;                              // s, >= 0: from one crossing to the next; 0: only on demand
};

struct ScopeCameraConfig {
  int width = 640;                                                 // px
  int height = 480;                                                // px
  geometry::PinholeCamera intrinsics{400.0, 400.0, 319.5, 239.5};  // px
  double rate = 25.0;                                              // Hz
  int supersampling = 2;                                           // samples per pixel along each axis
  double noise = 2.0;                                              // grey levels, standard deviation
  int noise_seed = 1;                                              // >= 0
  double border_radius = 0.0;                                      // px, >= 0: black outside this circle; 0: none
};

struct SceneConfig {
  ScopeCameraConfig camera;
  TissueConfig tissue;
  LightConfig light;
  ExposureConfig exposure;
  InstrumentConfig instrument;
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, SceneConfig& config);

// Every error, each naming the field, its value and what was expected. Empty when the configuration can be used.
std::vector<std::string> validate(const SceneConfig& config);

}  // namespace laparoscope_servo::sim
