#include "servo/safety/effect_explanations.h"

#include <Eigen/Geometry>
#include <cmath>

namespace laparoscope_servo::servo {

namespace {

// Degrees. The loop converges with a roll of less than 60; between two steps the nearer one explains 97 % of a motion.
constexpr int kRollStep = 30;
constexpr int kLeastRoll = 60;

Eigen::Matrix2d turned(int degrees) {
  return Eigen::Rotation2Dd(degrees * M_PI / 180.0).toRotationMatrix();
}

EffectExplanation picture(const std::string& words, const Eigen::Matrix2d& matrix) {
  EffectExplanation explanation;
  explanation.fault = words;
  explanation.picture = matrix;
  return explanation;
}

EffectExplanation arm(const std::string& words, const Eigen::Vector4d& signs) {
  EffectExplanation explanation;
  explanation.fault = words;
  explanation.arm = signs;
  return explanation;
}

std::string mirrored(int roll) {
  if (roll == 0) return "mirrored, left for right";
  if (roll == 180) return "mirrored, up for down";
  return "mirrored and rolled by " + std::to_string(roll) + " degrees";
}

}  // namespace

std::vector<EffectExplanation> effectExplanations() {
  std::vector<EffectExplanation> all;
  for (const double late : {-0.06, 0.0, 0.06, 0.14}) {
    for (const double reach : {0.4, 0.6, 1.0, 1.6}) {
      EffectExplanation good;
      good.late = late;
      good.reach = reach;
      all.push_back(good);
    }
  }
  for (int roll = kLeastRoll; roll <= 360 - kLeastRoll; roll += kRollStep) {
    all.push_back(picture("rolled by " + std::to_string(roll) + " degrees", turned(roll)));
  }
  for (int roll = 0; roll < 360; roll += kRollStep) {
    all.push_back(picture(mirrored(roll), turned(roll) * Eigen::Vector2d(-1.0, 1.0).asDiagonal()));
  }
  all.push_back(arm("moved by an arm whose pan is reversed", {-1.0, 1.0, 1.0, 1.0}));
  all.push_back(arm("moved by an arm whose tilt is reversed", {1.0, -1.0, 1.0, 1.0}));
  all.push_back(arm("moved by an arm whose pan and tilt are reversed", {-1.0, -1.0, 1.0, 1.0}));
  all.push_back(arm("moved by an arm whose spin is reversed", {1.0, 1.0, -1.0, 1.0}));
  all.push_back(arm("moved by an arm whose insertion is reversed", {1.0, 1.0, 1.0, -1.0}));
  all.push_back(arm("frozen, or another camera's", Eigen::Vector4d::Zero()));
  for (const double late : {0.3, 0.5, 0.8}) {
    EffectExplanation old;
    old.fault = "frozen, or older than its stamps say";
    old.late = late;
    all.push_back(old);
  }
  return all;
}

}  // namespace laparoscope_servo::servo
