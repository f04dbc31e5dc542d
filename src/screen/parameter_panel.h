// Shows the parameters that may change while the nodes run, with meaning and value, and changes them.
#pragma once

#include <QLabel>
#include <QLineEdit>
#include <QTableWidget>
#include <QWidget>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "screen/facts.h"

namespace laparoscope_servo::screen {

class ParameterPanel : public QWidget {
  Q_OBJECT
 public:
  using Set = std::function<void(const LiveParameter&, const std::string&)>;
  ParameterPanel(const Set& set, QWidget* parent);

  void show(const Facts& facts);
  using QWidget::show;

 private:
  void fill();
  void choose();
  void give();
  const LiveParameter* chosen() const;

  Set set_;
  std::shared_ptr<const std::vector<LiveParameter>> parameters_;
  QTableWidget* table_;
  QLabel* meaning_;
  QLineEdit* value_;
};

}  // namespace laparoscope_servo::screen
