// A window in which a region is drawn in one picture, as on the screen.
#pragma once

#include <QLabel>
#include <QTimer>
#include <QWidget>
#include <functional>
#include <optional>

#include "screen/image_view.h"

namespace laparoscope_servo::screen {

class SelectWindow : public QWidget {
  Q_OBJECT
 public:
  // What the tracker says of a region, in px of the original picture.
  using Judge = std::function<Verdict(const QRect&)>;

  // `original`: its size, of which `picture` may be a smaller copy.
  SelectWindow(const QImage& picture, const QSize& original, const Judge& judge);

  // What was drawn, and taken by Enter; empty when the window was closed, also by Escape. It is closed then.
  std::optional<QRect> selected() const { return selected_; }

 private:
  void keyPressEvent(QKeyEvent* event) override;
  void judge(const QRect& region);
  void take(const QRect& region);

  Judge judge_;
  Facts facts_;
  ImageView* image_;
  QLabel* words_;
  QTimer quiet_;  // a region is judged when the mouse has been still for a moment
  QRect changed_;
  std::optional<QRect> selected_;
};

}  // namespace laparoscope_servo::screen
