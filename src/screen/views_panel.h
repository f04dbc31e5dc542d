// Shows the stored views as pictures; stores a view under a name, and recalls one.
#pragma once

#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QWidget>
#include <functional>
#include <string>

#include "screen/facts.h"

namespace laparoscope_servo::screen {

class ViewsPanel : public QWidget {
  Q_OBJECT
 public:
  using Named = std::function<void(const std::string&)>;
  ViewsPanel(const Named& store, const Named& recall, QWidget* parent);

  void show(const Facts& facts);
  using QWidget::show;

 private:
  void fill();
  void choose();

  Named store_;
  Named recall_;
  std::shared_ptr<const std::vector<StoredView>> views_;
  QListWidget* list_;
  QLineEdit* name_;
  QPushButton* recall_button_;
  QLabel* way_;
};

}  // namespace laparoscope_servo::screen
