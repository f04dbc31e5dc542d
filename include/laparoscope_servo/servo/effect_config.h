// Parameters of the effect guard, with the defaults that config/controller.yaml repeats. Chosen with simulate_servo and
// the scenarios effect_*.yaml, where the evidence reaches 3.6 at most in healthy loops and more than 9 with faults.
#pragma once

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::servo {

struct EffectConfig {
  bool enabled = true;
  // Standard deviations of the velocity of the tissue's own motion.
  double tissue_centre = 0.06;       // 1/s: px over the focal length a second
  double tissue_depth = 0.04;        // 1/s, of log depth
  double tissue_orientation = 0.03;  // rad/s
  double tissue_time = 1.0;          // s, time constant of the tissue's velocity
  // s, time constant for which unusual motion of the tissue raises the expected variance
  double unrest_time = 0.5;
  double memory = 2.5;  // s, time constant with which likelihoods of images are forgotten
  // Thresholds of the log likelihood ratio of the best fault hypothesis over none:
  double doubt = 5.5;          // from here on the scope stops,
  double release = 3.0;        // below this it moves again,
  double certain = 9.0;        // from here on, while the scope stands, it is a fault
  double standing_time = 0.5;  // s, from the doubt until images show the scope at rest
  // How far the scope may move before its effect is confirmed, see src/servo/safety/effect_budget.h.
  double unconfirmed_turn = 0.044;       // rad
  double unconfirmed_insertion = 0.004;  // m
};

// Adds the rows of all parameters, with range and meaning.
void describe(parameters::Table& table, EffectConfig& config);

}  // namespace laparoscope_servo::servo
