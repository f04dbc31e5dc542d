#include "screen/space/frame_rate.h"

#include <OgreRenderSystem.h>
#include <OgreRenderSystemCapabilities.h>
#include <OgreRoot.h>
#include <rviz/display_group.h>
#include <rviz/render_panel.h>

#include <QEvent>
#include <QPointer>
#include <algorithm>

namespace laparoscope_servo::screen {

namespace {

constexpr int kResting = 2;      // Hz
constexpr int kTurning = 10;     // Hz, while the mouse moves the view
constexpr int kPatience = 1500;  // ms after the mouse has moved it last

rviz::Property* rateOf(rviz::VisualizationManager& manager) {
  rviz::Property* options = manager.getRootDisplayGroup()->subProp("Global Options");
  rviz::Property* rate = options->subProp("Frame Rate");
  return rate->getValue().isValid() ? rate : nullptr;
}

}  // namespace

bool drawnByProcessor(const std::string& renderer) {
  const QString name = QString::fromStdString(renderer).toLower();
  const auto has = [&](const char* part) { return name.contains(part); };
  return has("llvmpipe") || has("softpipe") || has("swrast") || has("software rasterizer");
}

void FrameRate::guard(rviz::VisualizationManager& manager, const QObject& user) {
  const Ogre::RenderSystem* system = Ogre::Root::getSingleton().getRenderSystem();
  const bool slow = system != nullptr && drawnByProcessor(system->getCapabilities()->getDeviceName());
  rviz::Property* rate = rateOf(manager);
  if (!slow || rate == nullptr) return;
  QPointer<FrameRate> guard = manager.findChild<FrameRate*>();
  if (!guard) guard = new FrameRate(manager, *rate);
  ++guard->users_;
  connect(&user, &QObject::destroyed, [guard] {
    if (guard && --guard->users_ == 0) delete guard;
  });
}

FrameRate::FrameRate(rviz::VisualizationManager& manager, rviz::Property& rate)
    : QObject(&manager), rate_(rate), resting_(std::min(rate.getValue().toInt(), kResting)), last_(resting_) {
  rate_.setValue(resting_);
  rest_.setSingleShot(true);
  connect(&rest_, &QTimer::timeout, this, [this] { set(resting_); });
  manager.getRenderPanel()->installEventFilter(this);
}

void FrameRate::set(int rate) {
  if (rate_.getValue().toInt() == last_ && rate != last_) rate_.setValue(last_ = rate);
}

bool FrameRate::eventFilter(QObject* object, QEvent* event) {
  const bool turns = event->type() == QEvent::MouseButtonPress || event->type() == QEvent::Wheel;
  if (turns) set(kTurning);
  if (turns || event->type() == QEvent::MouseButtonRelease || (event->type() == QEvent::MouseMove && rest_.isActive()))
    rest_.start(kPatience);
  return QObject::eventFilter(object, event);
}

}  // namespace laparoscope_servo::screen
