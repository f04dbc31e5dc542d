#include "screen/space/space_objects.h"

#include <OgreBillboard.h>
#include <OgreHardwarePixelBuffer.h>
#include <OgreMaterialManager.h>
#include <OgrePass.h>
#include <OgreTechnique.h>
#include <OgreTextureManager.h>

#include <algorithm>

#include "screen/space/region_texture.h"

namespace laparoscope_servo::screen {

namespace {

constexpr double kNearest = 0.01;  // m: a label no nearer to the eye is no smaller

// Names in Ogre are the whole program's.
std::string freshName() {
  static unsigned count = 0;
  return "laparoscope_servo_space_" + std::to_string(++count);
}

Ogre::MaterialPtr flatMaterial(const std::string& name) {
  Ogre::MaterialPtr material =
      Ogre::MaterialManager::getSingleton().create(name, Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME);
  material->setReceiveShadows(false);
  material->setLightingEnabled(false);
  material->setCullingMode(Ogre::CULL_NONE);
  material->setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
  return material;
}

}  // namespace

Ogre::Vector3 ogrePoint(const Eigen::Vector3d& point) {
  return {static_cast<Ogre::Real>(point.x()), static_cast<Ogre::Real>(point.y()), static_cast<Ogre::Real>(point.z())};
}

Ogre::Quaternion ogreTurn(const Eigen::Quaterniond& turn) {
  return {static_cast<Ogre::Real>(turn.w()), static_cast<Ogre::Real>(turn.x()), static_cast<Ogre::Real>(turn.y()),
          static_cast<Ogre::Real>(turn.z())};
}

Ogre::ColourValue ogreColour(const QColor& colour) {
  return Ogre::ColourValue(static_cast<float>(colour.redF()), static_cast<float>(colour.greenF()),
                           static_cast<float>(colour.blueF()), 1.0F);
}

PaintedMaterial::PaintedMaterial(bool on_top) : name_(freshName()), material_(flatMaterial(name_)) {
  material_->setDepthWriteEnabled(!on_top);
  material_->setDepthCheckEnabled(!on_top);
  if (!on_top) material_->setDepthBias(8.0F, 8.0F);  // before a surface of the simulation in the same plane
}

PaintedMaterial::~PaintedMaterial() {
  Ogre::MaterialManager::getSingleton().remove(name_);
  if (texture_) Ogre::TextureManager::getSingleton().remove(texture_->getName());
}

void PaintedMaterial::paint(const QImage& picture) {
  const auto width = static_cast<std::uint32_t>(picture.width()), height = static_cast<std::uint32_t>(picture.height());
  Ogre::TextureManager& textures = Ogre::TextureManager::getSingleton();
  Ogre::Pass& pass = *material_->getTechnique(0)->getPass(0);
  if (!texture_ || texture_->getWidth() != width || texture_->getHeight() != height) {
    pass.removeAllTextureUnitStates();
    if (texture_) textures.remove(texture_->getName());
    texture_ =
        textures.createManual(freshName(), Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME, Ogre::TEX_TYPE_2D,
                              width, height, 0, Ogre::PF_A8R8G8B8, Ogre::TU_DYNAMIC_WRITE_ONLY);
    Ogre::TextureUnitState* unit = pass.createTextureUnitState(texture_->getName());
    unit->setTextureAddressingMode(Ogre::TextureUnitState::TAM_CLAMP);
  }
  // Lines of 32 bit have no gaps between them. Ogre has no constant view; nothing writes to it.
  texture_->getBuffer()->blitFromMemory(
      Ogre::PixelBox(width, height, 1, Ogre::PF_A8R8G8B8, const_cast<uchar*>(picture.constBits())));
}

PaintedQuad::PaintedQuad(Ogre::SceneNode& parent) : parent_(parent), quad_(parent.getCreator()->createManualObject()) {
  quad_->setDynamic(true);
  parent_.attachObject(quad_);
}

PaintedQuad::~PaintedQuad() {
  parent_.getCreator()->destroyManualObject(quad_);
}

void PaintedQuad::show(const QImage& picture, const Corners3& corners) {
  material_.paint(picture);
  quad_->clear();
  quad_->begin(material_.name(), Ogre::RenderOperation::OT_TRIANGLE_FAN);
  static const float places[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (std::size_t k = 0; k < 4; ++k) {
    quad_->position(ogrePoint(corners[k]));
    quad_->textureCoord(places[k][0], places[k][1]);
  }
  quad_->end();
  quad_->setVisible(true);
}

void PaintedQuad::hide() {
  quad_->setVisible(false);
}

LineSet::LineSet(Ogre::SceneNode& parent, const Ogre::ColourValue& colour)
    : parent_(parent),
      colour_(colour),
      material_(flatMaterial(freshName())),
      lines_(parent.getCreator()->createManualObject()) {
  material_->setDepthWriteEnabled(false);
  lines_->setDynamic(true);
  parent_.attachObject(lines_);
}

LineSet::~LineSet() {
  parent_.getCreator()->destroyManualObject(lines_);
  Ogre::MaterialManager::getSingleton().remove(material_->getName());
}

void LineSet::show(const Lines& lines) {
  lines_->clear();
  if (lines.empty()) return;
  lines_->begin(material_->getName(), Ogre::RenderOperation::OT_LINE_LIST);
  for (const auto& [from, to] : lines) {
    for (const Eigen::Vector3d& end : {from, to}) {
      lines_->position(ogrePoint(end));
      lines_->colour(colour_);
    }
  }
  lines_->end();
}

Label::Label(Ogre::SceneNode& parent, const QColor& frame, Ogre::BillboardOrigin origin)
    : frame_(frame), node_(parent.createChildSceneNode()), board_(parent.getCreator()->createBillboardSet(1)) {
  board_->setMaterialName(material_.name());
  board_->setBillboardOrigin(origin);
  board_->createBillboard(Ogre::Vector3::ZERO);
  board_->setRenderQueueGroup(Ogre::RENDER_QUEUE_9);  // after all else that is in space
  board_->setVisible(false);
  node_->attachObject(board_);
}

Label::~Label() {
  node_->getCreator()->destroyBillboardSet(board_);
  node_->getCreator()->destroySceneNode(node_);
}

void Label::show(const QString& words, const Eigen::Vector3d& at) {
  board_->setVisible(!words.isEmpty());
  if (words.isEmpty()) return;
  node_->setPosition(ogrePoint(at));
  if (words == words_) return;
  words_ = words;
  const QImage picture = labelTexture(words, frame_);
  size_ = picture.size();
  material_.paint(picture);
}

void Label::scale(const Ogre::Vector3& eye, double metres) {
  const double distance = std::max<double>((eye - node_->_getDerivedPosition()).length(), kNearest);
  const double pixel = metres * distance;
  board_->setDefaultDimensions(static_cast<Ogre::Real>(pixel * size_.width()),
                               static_cast<Ogre::Real>(pixel * size_.height()));
}

}  // namespace laparoscope_servo::screen
