// The nodelet laparoscope_servo/Instrument: finds and tracks instruments.
#include <pluginlib/class_list_macros.hpp>

#include "nodelets/feature_nodelet.h"

namespace laparoscope_servo::nodelets {

class Instrument : public FeatureNodelet {
 public:
  Instrument() : FeatureNodelet("instrument") {}
};

}  // namespace laparoscope_servo::nodelets

PLUGINLIB_EXPORT_CLASS(laparoscope_servo::nodelets::Instrument, nodelet::Nodelet)
