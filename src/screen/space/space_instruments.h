// Instruments in rviz: a cylinder each with its spread, and a label.
#pragma once

#include <rviz/ogre_helpers/shape.h>

#include <memory>
#include <vector>

#include "screen/facts.h"
#include "screen/space/instrument_shape.h"
#include "screen/space/space_objects.h"

namespace laparoscope_servo::screen {

class SpaceInstruments {
 public:
  // `camera`: a node at the camera's place.
  explicit SpaceInstruments(Ogre::SceneNode& camera) : camera_(camera) {}

  // Those of trackers that see with the camera of frame `frame`. `now`: s of a steady clock.
  void show(const std::vector<FeatureTrackerFacts>& trackers, const std::string& frame,
            const geometry::PinholeCamera& camera, double now);
  void hide();
  std::vector<Label*> labels();

 private:
  struct Drawn;
  void show(Drawn& drawn, const FeatureFact& pose, const InstrumentShape& shape, double age);

  Ogre::SceneNode& camera_;
  std::vector<std::shared_ptr<Drawn>> drawn_;  // those behind the last one shown are hidden
};

}  // namespace laparoscope_servo::screen
