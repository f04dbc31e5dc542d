#include "screen/screen_widget.h"

#include <ros/names.h>
#include <ros/this_node.h>

#include <QApplication>
#include <QGridLayout>
#include <QKeyEvent>
#include <QStyle>
#include <QVBoxLayout>

#include "ros/common/clocks.h"
#include "screen/band_text.h"
#include "screen/minute_limits.h"

namespace laparoscope_servo::screen {

namespace {

constexpr int kBeat = 50;            // ms
constexpr double kMinuteBeat = 0.5;  // s between two updates of the last minute
constexpr int kColumnWidth = 410;    // px
constexpr int kActionsHeight = 96;   // px
constexpr int kAnswerHeight = 40;    // px

const char* const kStyle = R"(
  laparoscope_servo--screen--ScreenWidget { background: #10131a; }
  QPushButton { background: #333a46; color: white; border: 1px solid #6a7280; border-radius: 5px; padding: 4px 2px;
                font-size: 15px; font-weight: bold; }
  QPushButton:hover { background: #414a58; }
  QPushButton:pressed { background: #5b6678; }
  QPushButton[active="true"] { background: #1f5a36; border: 2px solid #2eb85c; }
  QPushButton#stop { background: #c01818; color: white; border: 3px solid white; font-size: 40px; }
  QPushButton#stop:hover { background: #d02020; }
  QPushButton#stop:pressed { background: #ff3030; }
  QLabel { color: white; font-size: 14px; }
  QTabWidget::pane { border: 1px solid #40464f; }
  QTabBar { font-size: 14px; }
  QTabBar::tab { background: #242a33; color: #c8d0dc; padding: 3px 11px; }
  QTabBar::tab:selected { background: #414a58; color: white; }
  QListWidget, QTableWidget, QLineEdit { background: #0c0e12; color: white; font-size: 13px;
                                         border: 1px solid #40464f; gridline-color: #2a3038; }
  QHeaderView::section { background: #242a33; color: #c8d0dc; border: 0; padding: 2px; }
  QListWidget::item:selected, QTableWidget::item:selected { background: #1f5a86; color: white; }
)";

std::string cartName(const std::string& space) {
  const std::string name = ros::names::append(ros::this_node::getNamespace(), space);
  return name == "/" || name == "//" ? "" : ros::names::clean(name);
}

// Marks the active one of several buttons.
void mark(QPushButton* button, bool active) {
  if (button->property("active").toBool() == active) return;
  button->setProperty("active", active);
  button->style()->unpolish(button);
  button->style()->polish(button);
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
                         [this](const QRect& pixels) { link_->tracker().checkRegion(pixels); }, this);
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(6, 6, 6, 6);
  layout->setSpacing(6);
  layout->addWidget(image_, 0, 0);
  playback_ = new PlaybackBar(
      [this](const std::string& command, double position) { link_->controlPlayback(command, position); }, this);
  layout->addWidget(playback_, 1, 0);
  layout->addWidget(makeActions(), 2, 0);
  layout->addWidget(makeColumn(space), 0, 1, 3, 1);
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
  dead_man_->letGo();
  for (VelocitySlider* slider : sliders_) slider->letGo();
  link_.reset();
}

// With a paused recording, plays the next picture, from which the region is cut.
void ScreenWidget::select(const QRect& pixels) {
  const Facts facts = link_->facts();
  link_->tracker().selectRegion(pixels);
  if (facts.playback.connected && facts.playback.state == "PAUSED" && !facts.frozen)
    link_->controlPlayback("STEP", 0.0);
}

QPushButton* ScreenWidget::makeButton(const QString& text, const QString& tip, const std::function<void()>& act) {
  auto* button = new QPushButton(text, this);
  button->setObjectName(text.toLower().replace(' ', '_'));
  button->setToolTip(tip);
  button->setFocusPolicy(Qt::NoFocus);  // otherwise the space bar would press it
  button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  connect(button, &QPushButton::clicked, this, [act] { act(); });
  return button;
}

QWidget* ScreenWidget::makeActions() {
  auto* actions = new QWidget(this);
  actions->setFixedHeight(kActionsHeight);
  auto* grid = new QGridLayout(actions);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setSpacing(6);
  grid->addWidget(makeButton("Enable", "The arm may move when it is told to", [this] { link_->enable(); }), 0, 0);
  grid->addWidget(makeButton("Disable", "The arm stands, and may be moved by hand", [this] { link_->disable(); }), 1,
                  0);
  grid->addWidget(makeButton("Engage", "The controller moves the scope", [this] { link_->engage(true); }), 0, 1);
  grid->addWidget(makeButton("Disengage", "The controller stands", [this] { link_->engage(false); }), 1, 1);
  grid->addWidget(makeButton("Hold", "The arm pauses", [this] { link_->pause(); }), 0, 2);
  grid->addWidget(makeButton("Resume", "A paused arm goes on", [this] { link_->resume(); }), 1, 2);
  grid->addWidget(makeButton("Clear region", "The tracker forgets its region", [this] { link_->clearRegion(); }), 0, 3);
  grid->addWidget(makeButton("Clear fault", "After its cause was removed", [this] { link_->clearFault(); }), 1, 3);
  grid->addWidget(
      makeButton("Freeze", "Keeps this picture, to draw a region in it at leisure; the arm is not held by it",
                 [this] { link_->tracker().freeze(); }),
      0, 4);
  grid->addWidget(makeButton("Live", "Back from the frozen picture", [this] { link_->tracker().thaw(); }), 1, 4);
  auto* stop = makeButton("STOP", "Disengages and disables: also by Escape or Pause", [] {});
  // Acts on the press, not on the release.
  connect(stop, &QPushButton::pressed, this, [this] { this->stop(); });
  stop->setMinimumWidth(136);
  grid->addWidget(stop, 0, 5, 2, 1);
  for (int column = 0; column < 5; ++column) grid->setColumnStretch(column, 2);
  grid->setColumnStretch(5, 3);
  return actions;
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
  const auto said = [this] { link_->said(); };
  layout->addWidget(dead_man_ = new DeadManButton(link_->deadMan(), said, column));
  layout->addWidget(makeTabs(), 1);
  answer_ = new QLabel(column);
  answer_->setObjectName("answer");
  answer_->setTextFormat(Qt::PlainText);
  answer_->setWordWrap(true);
  answer_->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  answer_->setFixedHeight(kAnswerHeight);
  layout->addWidget(answer_);
  return column;
}

// The bands and the dead-man switch stay visible, whichever tab is shown below them.
QWidget* ScreenWidget::makeTabs() {
  auto* tabs = new QTabWidget(this);
  tabs->setObjectName("tabs");
  tabs->tabBar()->setFocusPolicy(Qt::NoFocus);  // otherwise arrow keys would change the tab
  tabs->setFocusPolicy(Qt::NoFocus);
  tabs->addTab(makeDrive(), "Drive");
  views_ = new ViewsPanel([this](const std::string& name) { link_->tracker().storeView(name); },
                          [this](const std::string& name) { link_->tracker().recallView(name); }, tabs);
  tabs->addTab(views_, "Views");
  tabs->addTab(minute_ = new MinutePanel(tabs), "Last minute");
  parameters_ = new ParameterPanel(
      [this](const LiveParameter& parameter, const std::string& text) { link_->parameters().set(parameter, text); },
      tabs);
  tabs->addTab(parameters_, "Parameters");
  return tabs;
}

QWidget* ScreenWidget::makeDrive() {
  auto* column = new QWidget(this);
  auto* layout = new QVBoxLayout(column);
  layout->setContentsMargins(2, 2, 2, 2);
  layout->setSpacing(2);
  const auto said = [this] { link_->said(); };
  auto* tasks = new QHBoxLayout;
  follow_ = makeButton("Follow", "The scope keeps the region where it was", [this] { link_->selectTask("HOLD_VIEW"); });
  drive_ = makeButton("Drive by hand", "The scope follows the sliders", [this] { link_->selectTask("MANUAL"); });
  for (QPushButton* button : {follow_, drive_}) {
    button->setFixedHeight(32);
    tasks->addWidget(button);
  }
  layout->addLayout(tasks);
  const char* const names[4][3] = {
      {"Pan", "left", "right"}, {"Tilt", "down", "up"}, {"Spin", "left", "right"}, {"Insertion", "out", "deeper"}};
  const auto shares = [this] {
    std::array<double, 4> values{};
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = sliders_[k] != nullptr ? sliders_[k]->share() : 0.0;
    link_->setShares(values);
    link_->said();
  };
  for (std::size_t k = 0; k < sliders_.size(); ++k) {
    sliders_[k] = new VelocitySlider(names[k][0], names[k][1], names[k][2], link_->slider(), shares, said, column);
    layout->addWidget(sliders_[k]);
  }
  layout->addStretch(1);
  return column;
}

void ScreenWidget::refresh() {
  const Facts facts = link_->facts();
  const double now = steadyNow();
  image_->show(facts, now);
  tracker_->show(trackerBand(facts, now));
  controller_->show(controllerBand(facts, now));
  robot_->show(robotBand(facts, now));
  dead_man_->setWanted(facts.dead_man_wanted);
  playback_->show(facts.playback);
  showTask(facts);
  views_->show(facts);
  parameters_->show(facts);
  showMinute(facts, now);
  showAnswer(facts.answer);
}

void ScreenWidget::showMinute(const Facts& facts, double now) {
  if (!minute_->isVisible() || now - minute_shown_at_ < kMinuteBeat) return;
  minute_shown_at_ = now;
  minute_->show(link_->minute(now), minuteLimits(facts));
}

void ScreenWidget::showTask(const Facts& facts) {
  const std::string task = facts.controller.connected ? facts.controller.task : "";
  mark(follow_, task == "HOLD_VIEW");
  mark(drive_, task == "MANUAL");
  const bool by_hand = task == "MANUAL" && facts.limits.has_value();
  for (std::size_t k = 0; k < sliders_.size(); ++k) {
    sliders_[k]->setEnabled(by_hand);
    if (!facts.limits) continue;
    const double limit = (*facts.limits)[k];
    sliders_[k]->setLimit(k < 3 ? QString::number(limit, 'g', 3) + " rad/s"
                                : QString::number(1e3 * limit, 'g', 3) + " mm/s");
  }
}

void ScreenWidget::showAnswer(const Answer& answer) {
  if (answer.what.empty()) return;
  const QString text = QString::fromStdString(answer.text);
  const QString words = QString::fromStdString(answer.what) +
                        (answer.waiting ? " ..." : (answer.success ? ": done. " : ": REFUSED. ") + text);
  if (words == answer_->text()) return;
  answer_->setText(words);
  answer_->setToolTip(words.toHtmlEscaped());
}

void ScreenWidget::beat() {
  dead_man_->beat();
  for (VelocitySlider* slider : sliders_) slider->beat();
  refresh();
}

void ScreenWidget::stop() {
  link_->stop();
  dead_man_->letGo();
  for (VelocitySlider* slider : sliders_) slider->letGo();
  image_->cancelDrag();
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
