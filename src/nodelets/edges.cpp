// The nodelet laparoscope_servo/Edges: tracks lines, ellipses and splines, by their edges.
#include <pluginlib/class_list_macros.hpp>

#include "nodelets/feature_nodelet.h"

namespace laparoscope_servo::nodelets {

class Edges : public FeatureNodelet {
 public:
  Edges() : FeatureNodelet("edges") {}
};

}  // namespace laparoscope_servo::nodelets

PLUGINLIB_EXPORT_CLASS(laparoscope_servo::nodelets::Edges, nodelet::Nodelet)
