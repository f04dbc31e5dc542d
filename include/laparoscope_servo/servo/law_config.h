// Which control law, and its gains.
#pragma once

namespace laparoscope_servo::servo {

enum class LawKind { kFeatures, kPaper };

// Gains of the paper's experiment, (k_p, k_t, k_s, k_d). For pan and tilt they hold the 1/d2 of eq. (11).
struct PaperGains {
  double pan = 0.3;         // 1/s, k_p
  double tilt = 0.3;        // 1/s, k_t
  double spin = 0.3;        // 1/s, k_s
  double insertion = 0.02;  // m/s, k_d
};

// Of the law on the features' own errors, see src/servo/law/feature_law.h.
struct FeatureGains {
  double centre = 8.0;       // 1/s, of x and y
  double depth = 8.0;        // 1/s, of log depth
  double orientation = 8.0;  // 1/s, of alpha
  double desired_depth =
      0.08;  // m, Z*: from the camera to the tissue at the reference; wrong by a factor, it changes how fast
};

// What becomes of the orientation.
enum class SpinMode {
  kServo,     // that of the ROI is servoed
  kUpright,   // that of the picture is: what is up in space is up in it
  kReleased,  // left as it comes: the scope does not spin
};

}  // namespace laparoscope_servo::servo
