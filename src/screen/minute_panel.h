// Draws the last minute: confidence, corner error, visible share, rate, delay; with the nodes' limits.
#pragma once

#include <QWidget>
#include <array>
#include <vector>

#include "screen/minute_history.h"

namespace laparoscope_servo::screen {

class MinutePanel : public QWidget {
  Q_OBJECT
 public:
  // Negative: no limit, or unknown.
  struct Limit {
    double value = -1.0;
    bool at_least = false;  // true: values below are bad; false: values above
  };
  using Limits = std::array<Limit, kQuantities>;

  explicit MinutePanel(QWidget* parent);
  void show(const std::vector<MinuteHistory::Step>& steps, const Limits& limits);
  using QWidget::show;

 private:
  void paintEvent(QPaintEvent* event) override;
  void drawPlot(QPainter& painter, int quantity, const QRectF& area) const;

  std::vector<MinuteHistory::Step> steps_;
  Limits limits_;
};

}  // namespace laparoscope_servo::screen
