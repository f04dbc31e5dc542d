// Parameters of the guard of effect, with the defaults that config/controller.yaml repeats. Chosen with simulate_servo
// and the scenarios effect_*.yaml: of the evidence, healthy loops reach 3.6 at most and faults go beyond 9.
#pragma once

namespace laparoscope_servo::parameters {
class Table;
}

namespace laparoscope_servo::servo {

struct EffectConfig {
  bool enabled = true;
  // The tissue's own motion, standard deviation of its velocity.
  double tissue_centre = 0.06;       // 1/s: px over the focal length a second
  double tissue_depth = 0.04;        // 1/s, of log depth
  double tissue_orientation = 0.03;  // rad/s
  double tissue_time = 1.0;          // s, for which it keeps its velocity
  double unrest_time = 0.5;          // s, for which tissue that moves otherwise is not judged by
  double memory = 2.5;               // s, over which images are forgotten
  // Log of the ratio of likelihoods, the best fault over the picture as it should be:
  double doubt = 5.5;          // from here on the scope stands,
  double release = 3.0;        // below this it goes on,
  double certain = 9.0;        // and this, once it stands, is a fault
  double standing_time = 0.5;  // s, from the doubt until the scope stands and that is seen
  // How far the scope may go before its effect was seen, see src/servo/safety/effect_budget.h.
  double unconfirmed_turn = 0.044;       // rad
  double unconfirmed_insertion = 0.004;  // m
};

// Rows for all of it: ranges and meanings.
void describe(parameters::Table& table, EffectConfig& config);

}  // namespace laparoscope_servo::servo
