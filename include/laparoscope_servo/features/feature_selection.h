// What a person or a program selects for a tracker of features.
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "laparoscope_servo/features/tracked_feature.h"

namespace laparoscope_servo::features {

struct EllipseSelection {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  // px
  double a = 0.0;                                    // px, radii
  double b = 0.0;
  double angle = 0.0;  // rad, from the image's x axis to the axis of radius a, towards y
};

// Part of an ellipse: see Ellipse::setArc.
struct ArcSelection {
  double begin = 0.0;   // rad
  double extent = 0.0;  // rad
};

// Points that are chosen by themselves: corners of Shi and Tomasi.
struct CornerSelection {
  cv::Rect region;  // px; empty: the whole image
  int count = 30;   // at most, 1 to 500
};

struct SelectedFeature {
  std::string id;  // not empty, and no other's
  FeatureKind kind = FeatureKind::kPoint;
  // px. A point: the point, or none and `corners`. A line: its two ends. An ellipse: five or more points on it, or none
  // and `ellipse`. A spline: points on it, in order, 3 or more. A motion: two opposite corners of a region, or none for
  // all of the image.
  std::vector<Eigen::Vector2d> points;
  std::optional<EllipseSelection> ellipse;
  std::optional<ArcSelection> arc;
  std::optional<CornerSelection> corners;
  cv::Mat picture;                        // of points: CV_8UC1 or CV_8UC3, in which they are given; empty: the image
  std::optional<Eigen::Isometry3d> pose;  // of a POSE: where the object is about, camera_T_object, m
  bool closed = false;                    // of a spline: it ends where it begins, and has 4 points or more
  double range = 6.0;                     // px, by which the edge may be off
  Eigen::VectorXd desired;                // see TrackedFeature; empty: none
};

using FeatureSelection = std::vector<SelectedFeature>;

// Every error that no image is needed for, each with the feature's id, the value, and what was expected: an id that is
// empty or twice there, a number that is not finite, a range outside [1, 100] px, a kind that is not among `kinds`, a
// number of points, or of desired values, that the kind does not have, corners or a picture where the tracker does not
// take them. Empty: none.
std::vector<std::string> validate(const FeatureSelection& selection, const std::vector<FeatureKind>& kinds,
                                  bool takes_corners_and_pictures = false);

// The features of a selection in place of those that were told of before: ids, kinds, desired values, and room for
// every reason, so that telling of them allocates nothing.
void begin(TrackedFeatures& told, const FeatureSelection& selection);

}  // namespace laparoscope_servo::features
