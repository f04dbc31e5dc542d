#include "screen/screen_widget.h"

#include <ros/names.h>
#include <ros/this_node.h>

#include <QApplication>
#include <QGridLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QVBoxLayout>

#include "ros/common/clocks.h"
#include "ros/controller/controller_conversions.h"
#include "ros/reasons/reason_table.h"
#include "screen/action_bar.h"
#include "screen/band_text.h"
#include "screen/minute_limits.h"

namespace laparoscope_servo::screen {

namespace {

constexpr int kBeat = 50;            // ms
constexpr double kMinuteBeat = 0.5;  // s between two updates of the last minute
constexpr int kColumnWidth = 410;    // px
constexpr int kLeastAnswer = 42;     // px, three lines of the smallest font, on a display of 768 px
constexpr int kMostAnswer = 54;      // px, three lines of the largest font

const char* const kStyle = R"(
  laparoscope_servo--screen--ScreenWidget { background: #10131a; }
  QPushButton { background: #333a46; color: white; border: 1px solid #6a7280; border-radius: 5px; padding: 4px 2px;
                font-size: 15px; font-weight: bold; }
  QPushButton:hover { background: #414a58; }
  QPushButton:pressed { background: #5b6678; }
  QPushButton[active="true"] { background: #1f5a36; border: 2px solid #2eb85c; }
  QPushButton[task="true"] { font-size: 13px; padding: 0 2px; border-width: 1px; }
  QLabel, QCheckBox { color: white; font-size: 14px; }
  QLabel#cart { font-size: 18px; font-weight: bold; }
  QScrollArea, QWidget#features { background: #10131a; }
  QTabWidget::pane { border: 1px solid #40464f; }
  QTabBar { font-size: 14px; }
  QTabBar::tab { background: #242a33; color: #c8d0dc; padding: 3px 7px; }
  QTabBar::tab:selected { background: #414a58; color: white; }
  QListWidget, QTableWidget, QLineEdit { background: #0c0e12; color: white; font-size: 13px;
                                         border: 1px solid #40464f; gridline-color: #2a3038; }
  QHeaderView::section { background: #242a33; color: #c8d0dc; border: 0; padding: 2px; }
  QListWidget::item:selected, QTableWidget::item:selected { background: #1f5a86; color: white; }
)";

// What to do about a refusal; with a space in front. Empty if it is not known.
QString cureOf(const std::string& refusal) {
  const std::string refused = kNotEngaged;
  if (refusal.compare(0, refused.size(), refused) != 0) return {};
  const ReasonRow* row = explain(Speaker::kController, refusal.substr(refused.size()));
  return row == nullptr ? QString() : " " + QString::fromStdString(row->cure);
}

QString wordsOf(const Answer& answer) {
  const QString what = QString::fromStdString(answer.what);
  const QString text = QString::fromStdString(answer.text);
  switch (answer.outcome) {
    case Outcome::kWaiting:
      return what + " ... " + text;
    case Outcome::kDone:
      return what + ": done. " + text;
    case Outcome::kRefused:
      return what + ": REFUSED. " + text + cureOf(answer.text);
    case Outcome::kUnanswered:
      break;
  }
  return what + ": NOT DONE. " + text;
}

std::string cartName(const std::string& space) {
  const std::string name = ros::names::append(ros::this_node::getNamespace(), space);
  return name == "/" || name == "//" ? "" : ros::names::clean(name);
}

}  // namespace

ScreenWidget::ScreenWidget(QWidget* parent, const std::string& space) : QWidget(parent) {
  setObjectName("laparoscope_screen");
  setAttribute(Qt::WA_StyledBackground);
  setStyleSheet(kStyle);
  setFocusPolicy(Qt::ClickFocus);
  // Called from the link's threads; drawing is passed on to this thread.
  link_ = std::make_unique<RosLink>(
      [this] {
        QMetaObject::invokeMethod(
            this, [this] { refresh(); }, Qt::QueuedConnection);
      },
      space);
  image_ = new ImageView([this](const QRect& pixels) { select(pixels); },
                         [this](const QRect& pixels) {
                           link_->tracker().forgetDrawn();
                           link_->tracker().checkRegion(pixels);
                         },
                         this);
  image_->takeOffers([this](const Offer& offer) {
    link_->tracker().takeOffer(offer);
    playPaused(offer.stamp);
  });
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(6, 6, 6, 6);
  layout->setSpacing(6);
  layout->addWidget(image_, 0, 0);
  layout->addWidget(recording_ = new RecordingBar(this), 1, 0);
  playback_ = new PlaybackBar(
      [this](const std::string& command, double position) { link_->controlPlayback(command, position); }, this);
  layout->addWidget(playback_, 2, 0);
  layout->addWidget(new ActionBar(
                        *link_, [this] { stop(); }, this),
                    3, 0);
  layout->addWidget(makeColumn(space), 0, 1, 4, 1);
  layout->setColumnStretch(0, 1);
  layout->setRowStretch(0, 1);
  qApp->installEventFilter(this);
  connect(qApp, &QApplication::focusChanged, this, [this] {
    if (!hasFocusWithin()) dead_man_->letGo();
  });
  connect(&beat_timer_, &QTimer::timeout, this, [this] { beat(); });
  beat_timer_.start(kBeat);
  beat();
}

ScreenWidget::~ScreenWidget() {
  qApp->removeEventFilter(this);
  letGo();
  link_.reset();
}

void ScreenWidget::select(const QRect& pixels) {
  const std::optional<Frozen> frozen = link_->facts().frozen;
  link_->tracker().selectRegion(pixels);
  playPaused(frozen ? frozen->stamp : 0);
}

// A selection waits for the next picture, which a paused recording has to play; one in an earlier picture waits for
// several.
void ScreenWidget::playPaused(std::int64_t stamp) {
  const PlaybackFacts playback = link_->facts().playback;
  if (playback.connected && playback.state == "PAUSED") link_->controlPlayback(stamp == 0 ? "STEP" : "PLAY", 0.0);
}

QWidget* ScreenWidget::makeColumn(const std::string& space) {
  auto* column = new QWidget(this);
  column->setFixedWidth(kColumnWidth);
  auto* layout = new QVBoxLayout(column);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(6);
  const std::string cart = cartName(space);
  if (!cart.empty()) {
    auto* name = new QLabel("Cart: " + QString::fromStdString(cart), column);
    name->setObjectName("cart");
    name->setTextFormat(Qt::PlainText);
    layout->addWidget(name);
  }
  layout->addWidget(tracker_ = new StateBand("Tracker", column));
  layout->addWidget(controller_ = new StateBand("Controller", column));
  layout->addWidget(robot_ = new StateBand("Robot", column));
  layout->addWidget(dead_man_ = new DeadManButton(
                        link_->deadMan(), [this] { link_->said(); }, column));
  layout->addWidget(makeTabs(), 1);
  layout->addWidget(answer_ = new FittedLabel("answer", kLeastAnswer, kMostAnswer, column));
  return column;
}

// The bands and the dead-man switch stay visible, whichever tab is shown below them.
QWidget* ScreenWidget::makeTabs() {
  auto* tabs = new QTabWidget(this);
  tabs->setObjectName("tabs");
  tabs->tabBar()->setFocusPolicy(Qt::NoFocus);  // otherwise arrow keys would change the tab
  tabs->setFocusPolicy(Qt::NoFocus);
  tabs->addTab(drive_ = new DrivePanel(*link_, tabs), "Drive");
  views_ = new ViewsPanel([this](const std::string& name) { link_->tracker().storeView(name); },
                          [this](const std::string& name) { link_->tracker().recallView(name); }, tabs);
  tabs->addTab(views_, "Views");
  features_ = new FeaturesPanel([this](bool draw) { image_->drawFeatures(draw); }, tabs);
  tabs->addTab(minute_ = new MinutePanel(tabs), "Last minute");
  parameters_ = new ParameterPanel(
      [this](const LiveParameter& parameter, const std::string& text) { link_->parameters().set(parameter, text); },
      tabs);
  tabs->addTab(parameters_, "Parameters");
  tabs->addTab(features_, "Features");  // the last one, since few have such trackers
  return tabs;
}

void ScreenWidget::refresh() {
  const Facts facts = link_->facts();
  const double now = steadyNow();
  image_->show(facts, now);
  tracker_->show(trackerBand(facts, now));
  controller_->show(controllerBand(facts, now));
  robot_->show(robotBand(facts, now));
  dead_man_->setWanted(facts.dead_man_wanted);
  recording_->show(recordingText(facts.recorder, now));
  playback_->show(facts.playback);
  drive_->show(facts, now);
  views_->show(facts);
  features_->show(facts, now);
  parameters_->show(facts);
  showMinute(facts, now);
  showAnswer(facts.answer);
}

void ScreenWidget::showMinute(const Facts& facts, double now) {
  if (!minute_->isVisible() || now - minute_shown_at_ < kMinuteBeat) return;
  minute_shown_at_ = now;
  minute_->show(link_->minute(now), minuteLimits(facts));
}

void ScreenWidget::showAnswer(const Answer& answer) {
  if (!answer.what.empty()) answer_->say(wordsOf(answer));
}

void ScreenWidget::beat() {
  dead_man_->beat();
  drive_->beat();
  refresh();
}

void ScreenWidget::stop() {
  link_->stop();
  letGo();
  image_->cancelDrag();
}

void ScreenWidget::letGo() {
  dead_man_->letGo();
  drive_->letGo();
}

bool ScreenWidget::hasFocusWithin() const {
  const QWidget* focus = QApplication::focusWidget();
  return focus != nullptr && (focus == this || isAncestorOf(focus));
}

bool ScreenWidget::handleKey(int key, bool pressed) {
  if (key == Qt::Key_Escape || key == Qt::Key_Pause) {
    if (pressed) stop();
    return false;  // not consumed: other widgets may use the key too
  }
  if (key != Qt::Key_F9) return false;
  if (!pressed) {
    dead_man_->keyReleased();
  } else if (hasFocusWithin()) {
    dead_man_->keyPressed();
  }
  return hasFocusWithin();
}

// Filter of the whole program: keys reach its windows first, wherever the focus is, and are passed on from there.
bool ScreenWidget::eventFilter(QObject* object, QEvent* event) {
  const QEvent::Type type = event->type();
  if ((type == QEvent::KeyPress || type == QEvent::KeyRelease) && object->isWindowType()) {
    const auto* key = static_cast<QKeyEvent*>(event);
    if (handleKey(key->key(), type == QEvent::KeyPress)) return true;
  }
  return QWidget::eventFilter(object, event);
}

}  // namespace laparoscope_servo::screen
