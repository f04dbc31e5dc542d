// Parameters of the simulated scene: config/simulation.yaml names every one, with its unit.
#pragma once

#include "laparoscope_servo/sim/scene_config.h"
#include "ros/common/parameters.h"

namespace laparoscope_servo {

// Groups camera, tissue, light, exposure and instrument. Missing parameters keep their defaults; errors stay in the
// reader.
sim::SceneConfig readSceneConfig(ParameterReader& reader);

}  // namespace laparoscope_servo
