#include "screen/space/space_instruments.h"

#include <laparoscope_servo/TrackedFeatures.h>

#include <Eigen/Geometry>

#include "screen/features/feature_painter.h"
#include "screen/picture_words.h"

namespace laparoscope_servo::screen {

namespace {

constexpr std::size_t kMost = 12;  // a tracker of instruments has three

}  // namespace

struct SpaceInstruments::Drawn {
  explicit Drawn(Ogre::SceneNode& camera)
      : shaft(rviz::Shape::Cylinder, camera.getCreator(), &camera),
        spread(camera, ogreColour(kFeatureColour)),
        old(camera, ogreColour(kOldFeatureColour)),
        label(camera, Qt::white, Ogre::BBO_TOP_CENTER) {}  // no spread is of its colour
  void hide() {
    shaft.getRootNode()->setVisible(false);
    spread.show({});
    old.show({});
    label.show("", {});
  }

  rviz::Shape shaft;
  LineSet spread;
  LineSet old;  // axis of what is not seen now, and the dashes of an open end
  Label label;
};

void SpaceInstruments::show(const std::vector<FeatureTrackerFacts>& trackers, const std::string& frame,
                            const geometry::PinholeCamera& camera, double now) {
  std::size_t used = 0;
  for (const FeatureTrackerFacts& tracker : trackers) {
    const double age = now - tracker.heard_at;
    if (!tracker.newest || tracker.newest->frame != frame || !(age <= kForgotten)) continue;
    for (const FeatureFact& feature : tracker.newest->features) {
      const bool expected = feature.state == TrackedFeatures::TRACKING || feature.state == TrackedFeatures::SEARCHING;
      const auto shape = expected && used < kMost ? instrumentShape(camera, feature) : std::nullopt;
      if (!shape) continue;
      if (used == drawn_.size()) drawn_.push_back(std::make_shared<Drawn>(camera_));
      show(*drawn_[used++], feature, *shape, age);
    }
  }
  for (; used < drawn_.size(); ++used) drawn_[used]->hide();
}

// Solid only where it is seen now.
void SpaceInstruments::show(Drawn& drawn, const FeatureFact& pose, const InstrumentShape& shape, double age) {
  const bool live = age <= kOldest, seen = live && pose.state == TrackedFeatures::TRACKING;
  const Eigen::Vector3d axis = shape.end - shape.entry;
  drawn.shaft.getRootNode()->setVisible(seen);
  drawn.shaft.setPosition(ogrePoint(0.5 * (shape.entry + shape.end)));
  // Ogre's cylinder is along y.
  drawn.shaft.setOrientation(ogreTurn(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitY(), axis)));
  drawn.shaft.setScale(ogrePoint({2.0 * shape.radius, axis.norm(), 2.0 * shape.radius}));
  drawn.shaft.setColor(0.55F, 0.6F, 0.62F, 1.0F);
  drawn.spread.show(seen ? shape.spread : Lines());
  drawn.old.show(seen ? shape.open_end : Lines{{shape.entry, shape.end}});
  QString words = "instrument " + QString::fromStdString(pose.id);
  if (!live) {
    words += QString(": %1 s ago").arg(age, 0, 'f', 1);
  } else if (!seen) {
    words += ": SEARCHING";
  } else {
    words += QString(": %1 mm from the camera").arg(1e3 * shape.end.z(), 0, 'f', 0);
    if (shape.spread.empty()) words += ", spread not known";
    if (!shape.open_end.empty()) words += ", its end not known";
  }
  drawn.label.show(words, shape.end);
}

void SpaceInstruments::hide() {
  for (const std::shared_ptr<Drawn>& drawn : drawn_) drawn->hide();
}

std::vector<Label*> SpaceInstruments::labels() {
  std::vector<Label*> labels;
  for (const std::shared_ptr<Drawn>& drawn : drawn_) labels.push_back(&drawn->label);
  return labels;
}

}  // namespace laparoscope_servo::screen
