// The nodelet laparoscope_servo/DominantMotion: the motion that most of the image has in common.
#include <pluginlib/class_list_macros.hpp>

#include "nodelets/feature_nodelet.h"

namespace laparoscope_servo::nodelets {

class DominantMotion : public FeatureNodelet {
 public:
  DominantMotion() : FeatureNodelet("motion") {}
};

}  // namespace laparoscope_servo::nodelets

PLUGINLIB_EXPORT_CLASS(laparoscope_servo::nodelets::DominantMotion, nodelet::Nodelet)
