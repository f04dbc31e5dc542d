// The nodelet laparoscope_servo/ContourTexture: tracks a thing with a closed outline by its contour and its texture.
#include <pluginlib/class_list_macros.hpp>

#include "nodelets/feature_nodelet.h"

namespace laparoscope_servo::nodelets {

class ContourTexture : public FeatureNodelet {
 public:
  ContourTexture() : FeatureNodelet("contour") {}
};

}  // namespace laparoscope_servo::nodelets

PLUGINLIB_EXPORT_CLASS(laparoscope_servo::nodelets::ContourTexture, nodelet::Nodelet)
