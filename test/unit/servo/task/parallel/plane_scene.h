// A scope under its insertion point before a plane of tissue, and what its camera sees of it.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/scope/geometry.h"
#include "laparoscope_servo/servo/view_motion.h"

namespace laparoscope_servo::servo {

inline constexpr double kDegree = M_PI / 180.0;

// The base is the insertion point's frame, z into the body. The anchor image is that of the start pose.
struct PlaneScene {
  double d2 = 0.1;                                    // m
  double depth = 0.08;                                // m, along the axis of the start pose
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // of the tissue, in the base
  Eigen::Matrix3d camera_R_shaft = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d base_R_shaft = Eigen::Matrix3d::Identity();
  Eigen::Vector3d tissue = Eigen::Vector3d::Zero();      // m, by which it was displaced
  Eigen::Matrix3d tilted = Eigen::Matrix3d::Identity();  // by which it was turned about the base's origin
  double noise = 0.0;                                    // normalised, of the corners

  static Eigen::Vector3d slanted(double angle, double azimuth) {
    return {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth), std::cos(angle)};
  }

  scope::Geometry scope() const { return {camera_R_shaft, d2}; }
  Eigen::Isometry3d tip() const { return tipAt(base_R_shaft); }
  Eigen::Isometry3d tipAt(const Eigen::Matrix3d& r) const {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = r;
    pose.translation() = d2 * r.col(2);
    return pose;
  }
  Eigen::Isometry3d cameraAt(const Eigen::Matrix3d& r) const {
    Eigen::Isometry3d pose = tipAt(r);
    pose.linear() = r * camera_R_shaft.transpose();
    return pose;
  }
  // m, from the insertion point to the plane, at rest.
  double distance() const {
    const Eigen::Isometry3d start = cameraAt(Eigen::Matrix3d::Identity());
    return normal.dot(start.translation() + depth * start.linear().col(2));
  }
  Eigen::Vector3d normalInCamera() const { return cameraAt(base_R_shaft).linear().transpose() * (tilted * normal); }
  // rad
  double slant() const { return geometry::angleBetween(normalInCamera(), Eigen::Vector3d::UnitZ()); }

  // By the velocities of pan and tilt, rad, in the shaft's axes.
  void turn(double pan, double tilt) { base_R_shaft = base_R_shaft * geometry::so3Exp({tilt, pan, 0.0}); }

  ViewMotion view() {
    ViewMotion motion;
    for (std::size_t k = 0; k < 4; ++k) motion.corners[k] = {k == 1 || k == 2 ? 0.4 : -0.4, k > 1 ? 0.3 : -0.3};
    const Eigen::Isometry3d start = cameraAt(Eigen::Matrix3d::Identity());
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    moved.linear() = tilted;
    moved.translation() = tissue;
    const Eigen::Vector3d in_start = start.linear().transpose() * normal;
    motion.h = geometry::fromPlane(cameraAt(base_R_shaft).inverse() * moved * start, in_start,
                                   distance() - normal.dot(start.translation()));
    motion.error = noise;
    if (!(noise > 0.0)) return motion;
    geometry::Quadrilateral seen = geometry::apply(motion.h, motion.corners);
    std::normal_distribution<double> normal_noise(0.0, noise);
    for (Eigen::Vector2d& corner : seen) corner += Eigen::Vector2d(normal_noise(random), normal_noise(random));
    motion.h = geometry::fromCorners(motion.corners, seen);
    return motion;
  }

  std::mt19937 random{1};
};

}  // namespace laparoscope_servo::servo
