// The nodelet laparoscope_servo/Points: tracks points of texture.
#include <pluginlib/class_list_macros.hpp>

#include "nodelets/feature_nodelet.h"

namespace laparoscope_servo::nodelets {

class Points : public FeatureNodelet {
 public:
  Points() : FeatureNodelet("points") {}
};

}  // namespace laparoscope_servo::nodelets

PLUGINLIB_EXPORT_CLASS(laparoscope_servo::nodelets::Points, nodelet::Nodelet)
