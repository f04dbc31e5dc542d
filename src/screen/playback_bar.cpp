#include "screen/playback_bar.h"

#include <QHBoxLayout>
#include <algorithm>
#include <cmath>

namespace laparoscope_servo::screen {

namespace {

constexpr int kSteps = 1000;      // of the slider
constexpr int kHeight = 40;       // px
constexpr int kWordsWidth = 260;  // px

QString wordsOf(const PlaybackFacts& facts) {
  if (facts.state == "WAITING") return "WAITS for the tracker";
  if (facts.state == "HOLDING") return "HOLDS: draw a region";
  const QString place = QString::number(facts.position, 'f', 1) + " s" +
                        (facts.duration > 0.0 ? " of " + QString::number(facts.duration, 'f', 1) : QString());
  return QString::fromStdString(facts.state) + "  " + place;
}

}  // namespace

PlaybackBar::PlaybackBar(const Control& control, QWidget* parent) : QWidget(parent), control_(control) {
  setFixedHeight(kHeight);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  play_ = makeButton("Play", "Plays on, or pauses; from the beginning when it has ended", [this] {
    control_(facts_.state == "PLAYING"                             ? "PAUSE"
             : facts_.state == "ENDED" || facts_.state == "FAILED" ? "AGAIN"
                                                                   : "PLAY",
             0.0);
  });
  row->addWidget(play_);
  row->addWidget(makeButton("Step", "One picture", [this] { control_("STEP", 0.0); }));
  row->addWidget(makeButton("Again", "From the beginning", [this] { control_("AGAIN", 0.0); }));
  row->addWidget(place_ = new QSlider(Qt::Horizontal, this), 1);
  place_->setObjectName("place");
  place_->setRange(0, kSteps);
  place_->setFocusPolicy(Qt::NoFocus);
  place_->setTracking(false);
  connect(place_, &QSlider::sliderReleased, this,
          [this] { control_("SEEK", facts_.duration * place_->sliderPosition() / kSteps); });
  row->addWidget(words_ = new QLabel(this));
  words_->setObjectName("playback");
  words_->setTextFormat(Qt::PlainText);
  words_->setFixedWidth(kWordsWidth);
  setVisible(false);
}

QPushButton* PlaybackBar::makeButton(const QString& name, const QString& tip, const std::function<void()>& act) {
  auto* button = new QPushButton(name, this);
  button->setObjectName(name.toLower());
  button->setToolTip(tip);
  button->setFocusPolicy(Qt::NoFocus);
  button->setFixedWidth(80);
  connect(button, &QPushButton::clicked, this, [act] { act(); });
  return button;
}

void PlaybackBar::show(const PlaybackFacts& facts) {
  facts_ = facts;
  if (isVisibleTo(parentWidget()) != facts.connected) setVisible(facts.connected);
  if (!facts.connected) return;
  const QString play = facts.state == "PLAYING" ? "Pause" : "Play";
  if (play_->text() != play) play_->setText(play);
  const QString words = wordsOf(facts);
  if (words_->text() != words) words_->setText(words);
  const bool known = facts.duration > 0.0 && std::isfinite(facts.duration);
  place_->setEnabled(known);
  const double share = known ? std::clamp(facts.position / facts.duration, 0.0, 1.0) : 0.0;
  if (!place_->isSliderDown() && std::isfinite(share)) place_->setValue(static_cast<int>(std::lround(kSteps * share)));
}

}  // namespace laparoscope_servo::screen
