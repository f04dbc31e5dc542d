// The nodelet laparoscope_servo/Dots: tracks dots.
#include <pluginlib/class_list_macros.hpp>

#include "nodelets/feature_nodelet.h"

namespace laparoscope_servo::nodelets {

class Dots : public FeatureNodelet {
 public:
  Dots() : FeatureNodelet("dots") {}
};

}  // namespace laparoscope_servo::nodelets

PLUGINLIB_EXPORT_CLASS(laparoscope_servo::nodelets::Dots, nodelet::Nodelet)
