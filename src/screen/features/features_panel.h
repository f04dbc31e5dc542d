// The trackers of features: whether they are drawn in the picture, and a line of words for each.
#pragma once

#include <QCheckBox>
#include <QLabel>
#include <QVBoxLayout>
#include <QWidget>
#include <functional>
#include <vector>

#include "screen/band_text.h"

namespace laparoscope_servo::screen {

// A symbol with the level, name and word; in a sentence why; what to do.
class FeatureLine : public QWidget {
  Q_OBJECT
 public:
  explicit FeatureLine(QWidget* parent);
  void show(const QString& name, const BandText& text);
  const BandText& text() const { return text_; }

 private:
  void paintEvent(QPaintEvent* event) override;

  QString name_;
  BandText text_;
};

class FeaturesPanel : public QWidget {
  Q_OBJECT
 public:
  // `draw`: called when the user wants them drawn, or not.
  FeaturesPanel(const std::function<void(bool)>& draw, QWidget* parent);
  void show(const Facts& facts, double now);
  using QWidget::show;

 private:
  QCheckBox* box_;
  QLabel* none_;
  QVBoxLayout* rows_;
  std::vector<FeatureLine*> lines_;
};

}  // namespace laparoscope_servo::screen
