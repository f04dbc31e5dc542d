// Display of rviz, laparoscope_servo/Space: the region with its picture where it is believed to be, instruments, the
// insertion point and how well it is known, how far the controller lets the scope go; with labels that nothing hides.
#pragma once

#include <rviz/display.h>
#include <rviz/ogre_helpers/shape.h>
#include <rviz/properties/bool_property.h>
#include <rviz/properties/string_property.h>

#include <memory>

#include "screen/space/space_link.h"
#include "screen/space/space_objects.h"

namespace laparoscope_servo::screen {

class SpaceDisplay : public rviz::Display {
  Q_OBJECT
 public:
  SpaceDisplay();
  ~SpaceDisplay() override;
  void update(float wall_dt, float ros_dt) override;
  void reset() override;

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;

 private:
  struct Scene;

  void connectAgain();
  std::string frame(const std::string& name) const;
  bool follow(const std::string& frame, Ogre::SceneNode& node);
  void showRegion(const Facts& facts, double now);
  void showInstruments(const Facts& facts, double now);
  void showPoint();
  void showBounds(const ScopeBounds& bounds);
  void scaleLabels();

  rviz::StringProperty* space_;
  rviz::StringProperty* camera_info_;
  rviz::BoolProperty* labels_;
  std::unique_ptr<SpaceLink> link_;
  std::unique_ptr<Scene> scene_;
  double asked_at_ = kNever;
};

}  // namespace laparoscope_servo::screen
