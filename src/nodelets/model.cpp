// The nodelet laparoscope_servo/Model: tracks the pose of objects of known shape.
#include <pluginlib/class_list_macros.hpp>

#include "nodelets/feature_nodelet.h"

namespace laparoscope_servo::nodelets {

class Model : public FeatureNodelet {
 public:
  Model() : FeatureNodelet("model") {}
};

}  // namespace laparoscope_servo::nodelets

PLUGINLIB_EXPORT_CLASS(laparoscope_servo::nodelets::Model, nodelet::Nodelet)
