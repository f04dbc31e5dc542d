#include "screen/space/space_display.h"

#include <OgreCamera.h>
#include <OgreViewport.h>
#include <laparoscope_servo/Homography.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>

#include <Eigen/Geometry>
#include <cmath>
#include <pluginlib/class_list_macros.hpp>

#include "laparoscope_servo/geometry/camera.h"
#include "ros/common/clocks.h"
#include "ros/common/frame_names.h"
#include "screen/overlay_painter.h"
#include "screen/picture_words.h"
#include "screen/space/region_texture.h"
#include "screen/space/space_instruments.h"

namespace laparoscope_servo::screen {

namespace {

constexpr int kTextureSide = 192;   // px: as many as a preview spends on a region of a third of its width
constexpr double kAskPeriod = 2.0;  // s between two looks for the controller's parameters
constexpr double kDegrees = 180.0 / 3.14159265358979323846;
const QColor kBoundFrame(0xff, 0xa0, 0x30);
const QColor kPointFrame(0xff, 0xc0, 0x20);

QString millimetres(double metres) {
  return QString::number(1e3 * metres, 'f', 0) + " mm";
}

Lines outlineOf(const Corners3& corners) {
  Lines lines;
  for (std::size_t k = 0; k < 4; ++k) lines.emplace_back(corners[k], corners[(k + 1) % 4]);
  return lines;
}

}  // namespace

struct SpaceDisplay::Scene {
  explicit Scene(Ogre::SceneNode& root)
      : camera_node(*root.createChildSceneNode()),
        point_node(*root.createChildSceneNode()),
        region(camera_node),
        target(camera_node, ogreColour(kTargetColour)),
        bounds(point_node, ogreColour(kBoundFrame)),
        point(rviz::Shape::Sphere, root.getCreator(), &point_node),
        region_label(camera_node, kPresentColour, Ogre::BBO_CENTER_LEFT),
        camera_label(camera_node, Qt::white, Ogre::BBO_CENTER_RIGHT),
        point_label(point_node, kPointFrame),
        least_label(point_node, kBoundFrame),
        greatest_label(point_node, kBoundFrame, Ogre::BBO_TOP_CENTER),
        cone_label(point_node, kBoundFrame),
        instruments(camera_node) {}
  std::vector<Label*> labels() {
    std::vector<Label*> all = instruments.labels();
    all.insert(all.end(), {&region_label, &camera_label, &point_label, &least_label, &greatest_label, &cone_label});
    return all;
  }

  bool camera_known = false;
  Ogre::SceneNode& camera_node;
  Ogre::SceneNode& point_node;
  PaintedQuad region;
  LineSet target;
  LineSet bounds;
  rviz::Shape point;  // two standard deviations
  Label region_label, camera_label, point_label, least_label, greatest_label, cone_label;
  SpaceInstruments instruments;
};

SpaceDisplay::SpaceDisplay() {
  const auto anew = [this] { connectAgain(); };
  space_ = new rviz::StringProperty("Namespace", "", "of the cart; empty: that of rviz", this);
  camera_info_ = new rviz::StringProperty("Camera info", "camera/camera_info", "topic of the intrinsics", this);
  labels_ = new rviz::BoolProperty("Labels", true, "words beside what is drawn", this);
  connect(space_, &rviz::Property::changed, this, anew);
  connect(camera_info_, &rviz::Property::changed, this, anew);
}

SpaceDisplay::~SpaceDisplay() = default;

void SpaceDisplay::onInitialize() {
  scene_ = std::make_unique<Scene>(*scene_node_);
}

void SpaceDisplay::onEnable() {
  connectAgain();
}

void SpaceDisplay::onDisable() {
  link_.reset();
}

void SpaceDisplay::reset() {
  Display::reset();
  connectAgain();
}

void SpaceDisplay::connectAgain() {
  link_.reset();
  std::string error;
  const std::string space = space_->getStdString(), topic = camera_info_->getStdString();
  const bool valid = (space.empty() || ros::names::validate(space, error)) && ros::names::validate(topic, error);
  setStatusStd(valid ? rviz::StatusProperty::Ok : rviz::StatusProperty::Error, "Names", valid ? "ok" : error);
  if (!isEnabled() || !valid || topic.empty()) return;
  ros::NodeHandle node(space);
  node.setCallbackQueue(context_->getThreadedQueue());
  link_ = std::make_unique<SpaceLink>(node, topic);
  asked_at_ = kNever;
}

std::string SpaceDisplay::frame(const std::string& name) const {
  return framePrefix(kPrefixOfNamespace, ros::NodeHandle(space_->getStdString()).getNamespace()) + name;
}

bool SpaceDisplay::follow(const std::string& frame, Ogre::SceneNode& node) {
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  const bool known =
      !frame.empty() && context_->getFrameManager()->getTransform(frame, ros::Time(), position, orientation);
  node.setVisible(known);
  setStatusStd(known ? rviz::StatusProperty::Ok : rviz::StatusProperty::Warn, frame.empty() ? "camera" : frame,
               known ? "ok" : "where it is, tf does not tell");
  if (!known) return false;
  node.setPosition(position);
  node.setOrientation(orientation);
  return true;
}

void SpaceDisplay::update(float, float) {
  if (!link_) return;
  const double now = steadyNow();
  if (now - asked_at_ > kAskPeriod) {
    asked_at_ = now;
    link_->askForBounds();
    link_->findFeatures();
  }
  const Facts facts = link_->facts(now);
  showRegion(facts, now);
  showInstruments(facts, now);
  showPoint();
  scaleLabels();
}

void SpaceDisplay::showRegion(const Facts& facts, double now) {
  const auto info = link_->cameraInfo();
  const auto bounds = link_->bounds();
  scene_->target.show({});
  scene_->camera_known = follow(info ? info->header.frame_id : "", scene_->camera_node);
  if (!scene_->camera_known) return;
  scene_->region.hide();
  const PictureWords words = pictureWords(facts.picture, now);
  scene_->region_label.show("", {});
  scene_->camera_label.show(words.live ? "camera" : "camera: " + QString::fromStdString(words.words), {});
  const QImage texture = words.live ? regionTexture(facts, kTextureSide) : QImage();
  if (texture.isNull() || !bounds) return;
  const geometry::PinholeCamera camera = geometry::cameraFromRowMajor(info->K.data());
  const auto corners = regionInSpace(camera, facts.result->g, facts.tracker.region, bounds->desired_depth);
  const auto target = regionInSpace(camera, {1, 0, 0, 0, 1, 0, 0, 0, 1}, facts.tracker.region, bounds->desired_depth);
  if (!corners || !target) return;
  scene_->region.show(texture, *corners);
  scene_->target.show(outlineOf(*target));
  const bool sure = facts.result->state == Homography::TRACKING;
  const QString view = QString::fromStdString(facts.tracker.view);
  const QString text = (view.isEmpty() ? "region" : "view " + view) + (sure ? ": about " : ", SEARCHING: about ") +
                       millimetres((*corners)[0].z());
  // Beside its right edge, a tenth of its width away.
  const Eigen::Vector3d right = ((*corners)[1] + (*corners)[2]) / 2.0, left = ((*corners)[0] + (*corners)[3]) / 2.0;
  scene_->region_label.show(text, right + 0.1 * (right - left));
}

// After showRegion, which has taken the node to the camera.
void SpaceDisplay::showInstruments(const Facts& facts, double now) {
  const auto info = link_->cameraInfo();
  if (!info || !scene_->camera_known) return scene_->instruments.hide();
  scene_->instruments.show(facts.features, info->header.frame_id, geometry::cameraFromRowMajor(info->K.data()), now);
}

void SpaceDisplay::showPoint() {
  if (!follow(frame("insertion_point"), scene_->point_node)) return;
  const auto bounds = link_->bounds();
  const auto calibration = link_->calibration();
  const bool measured = calibration && calibration->known != 0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  if (measured) covariance = Eigen::Map<const Eigen::Matrix3d>(calibration->covariance.data());
  if (!measured && bounds) covariance = std::pow(bounds->prior_stddev, 2) * Eigen::Matrix3d::Identity();
  const auto ellipsoid = ellipsoidOf(covariance);
  scene_->point.getRootNode()->setVisible(ellipsoid.has_value());
  QString text = "insertion point";
  if (ellipsoid) {
    // The covariance is in the arm's base, the node in the insertion point's frame: their axes are parallel.
    scene_->point.setOrientation(ogreTurn(Eigen::Quaterniond(ellipsoid->axes)));
    scene_->point.setScale(ogrePoint(2.0 * ellipsoid->radii));
    scene_->point.setColor(1.0F, 0.75F, 0.1F, 0.45F);
    text += QString(" \u00b1 %1 mm (2 \u03c3%2)")
                .arg(1e3 * ellipsoid->radii.maxCoeff(), 0, 'f', 1)
                .arg(measured ? "" : ", believed");
  }
  scene_->point_label.show(text, Eigen::Vector3d::Zero());
  showBounds(bounds ? bounds->range : ScopeBounds());
}

void SpaceDisplay::showBounds(const ScopeBounds& bounds) {
  const Lines lines = boundLines(bounds);
  scene_->bounds.show(lines);
  const auto label = [&](Label& of, const QString& words, const Eigen::Vector3d& at) {
    of.show(lines.empty() ? QString() : words, at);
  };
  const Eigen::Vector3d axis = bounds.axis.normalized();
  label(scene_->least_label, "least depth " + millimetres(bounds.min_depth), bounds.min_depth * axis);
  label(scene_->greatest_label, "greatest depth " + millimetres(bounds.max_depth), bounds.max_depth * axis);
  label(scene_->cone_label, QString("cone %1\u00b0").arg(bounds.cone * kDegrees, 0, 'f', 0),
        lines.empty() ? axis : lines.back().second);
}

void SpaceDisplay::scaleLabels() {
  const rviz::ViewController* view = context_->getViewManager()->getCurrent();
  const Ogre::Camera* eye = view != nullptr ? view->getCamera() : nullptr;
  if (eye == nullptr || eye->getViewport() == nullptr) return;
  const double height = std::max(1, eye->getViewport()->getActualHeight());
  const double metres = 2.0 * std::tan(0.5 * eye->getFOVy().valueRadians()) / height;
  for (Label* label : scene_->labels()) {
    if (!labels_->getBool()) label->show("", {});
    label->scale(eye->getDerivedPosition(), metres);
  }
}

}  // namespace laparoscope_servo::screen

PLUGINLIB_EXPORT_CLASS(laparoscope_servo::screen::SpaceDisplay, rviz::Display)
