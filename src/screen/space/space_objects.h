// Things of Ogre that the display in space is made of. All are children of a scene node, and go with it.
#pragma once

#include <OgreBillboardSet.h>
#include <OgreColourValue.h>
#include <OgreManualObject.h>
#include <OgreMaterial.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreTexture.h>

#include <Eigen/Geometry>
#include <QColor>
#include <QImage>
#include <string>

#include "screen/space/space_shapes.h"

namespace laparoscope_servo::screen {

// A material whose only texture is a picture.
class PaintedMaterial {
 public:
  // `on_top`: nothing hides it.
  explicit PaintedMaterial(bool on_top);
  ~PaintedMaterial();
  PaintedMaterial(const PaintedMaterial&) = delete;
  PaintedMaterial& operator=(const PaintedMaterial&) = delete;
  // ARGB32, not null.
  void paint(const QImage& picture);
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  Ogre::MaterialPtr material_;
  Ogre::TexturePtr texture_;
};

// A quadrilateral with a picture on it, seen from both sides.
class PaintedQuad {
 public:
  explicit PaintedQuad(Ogre::SceneNode& parent);
  ~PaintedQuad();
  void show(const QImage& picture, const Corners3& corners);
  void hide();

 private:
  PaintedMaterial material_{false};
  Ogre::SceneNode& parent_;
  Ogre::ManualObject* quad_;
};

// Lines of one pixel.
class LineSet {
 public:
  LineSet(Ogre::SceneNode& parent, const Ogre::ColourValue& colour);
  ~LineSet();
  void show(const Lines& lines);

 private:
  Ogre::SceneNode& parent_;
  Ogre::ColourValue colour_;
  Ogre::MaterialPtr material_;
  Ogre::ManualObject* lines_;
};

// Words that face the one who looks, as large wherever they are; nothing hides them.
class Label {
 public:
  // `origin`: which place of the words is at the point they belong to.
  Label(Ogre::SceneNode& parent, const QColor& frame, Ogre::BillboardOrigin origin = Ogre::BBO_BOTTOM_CENTER);
  ~Label();
  // `at` in the parent's frame. Empty words: hidden.
  void show(const QString& words, const Eigen::Vector3d& at);
  // `metres`: of a pixel of the display, at the distance of one metre.
  void scale(const Ogre::Vector3& eye, double metres);

 private:
  PaintedMaterial material_{true};
  QColor frame_;
  QString words_;
  QSize size_;
  Ogre::SceneNode* node_;
  Ogre::BillboardSet* board_;
};

Ogre::Vector3 ogrePoint(const Eigen::Vector3d& point);
Ogre::Quaternion ogreTurn(const Eigen::Quaterniond& turn);
Ogre::ColourValue ogreColour(const QColor& colour);

}  // namespace laparoscope_servo::screen
