// Gains and modes of the control laws.
#pragma once

namespace laparoscope_servo::servo {

enum class LawKind { kFeatures, kPaper };

// Gains of the paper's experiment, (k_p, k_t, k_s, k_d). Those of pan and tilt are rates [1/s]: they include the 1/d2
// of eq. (11).
struct PaperGains {
  double pan = 0.3;         // 1/s, k_p
  double tilt = 0.3;        // 1/s, k_t
  double spin = 0.3;        // 1/s, k_s
  double insertion = 0.02;  // m/s, k_d
};

// Gains of the law on the features' own errors, see src/servo/law/feature_law.h.
struct FeatureGains {
  double centre = 8.0;       // 1/s, of x and y
  double depth = 8.0;        // 1/s, of log depth
  double orientation = 8.0;  // 1/s, of alpha
  double desired_depth =
      // m, Z*: from the camera to the tissue at the reference; an error of it changes only the speed of convergence
      0.08;
};

// The degrees of freedom that a law uses beside pan and tilt. Without spin the orientation is not controlled, without
// insertion the depth is not.
struct LawAxes {
  bool spin = true;
  bool insertion = true;
};

// What the scope's spin is used for.
enum class SpinMode {
  kServo,     // servoes the orientation of the ROI
  kUpright,   // keeps the direction "up" in space upright in the image
  kReleased,  // the scope does not spin; the orientation is not controlled
};

}  // namespace laparoscope_servo::servo
