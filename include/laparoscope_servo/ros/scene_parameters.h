// Parameters of the simulated scene: config/simulation.yaml names every one, with its unit.
#pragma once

#include "laparoscope_servo/ros/parameters.h"
#include "laparoscope_servo/sim/scene_config.h"

namespace laparoscope_servo::skin {

// Groups camera, tissue, light, exposure and instrument. Missing parameters keep their defaults; errors stay in the
// reader.
sim::SceneConfig readSceneConfig(ParameterReader& reader);

}  // namespace laparoscope_servo::skin
