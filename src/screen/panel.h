// The screen as a panel of rviz: laparoscope_servo/Laparoscope. There may be several panels for different carts; each
// has a field for its cart's namespace, which rviz saves with the panel.
#pragma once

#include <rviz/panel.h>

#include <QLineEdit>
#include <QVBoxLayout>
#include <memory>

#include "screen/screen_widget.h"

namespace laparoscope_servo::screen {

class Panel : public rviz::Panel {
  Q_OBJECT
 public:
  explicit Panel(QWidget* parent = nullptr);
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

 protected:
  void onInitialize() override;

 private:
  void follow(const QString& space);
  void standBesideOthers();

  QVBoxLayout* layout_;
  QLineEdit* space_;
  std::unique_ptr<ScreenWidget> screen_;
};

}  // namespace laparoscope_servo::screen
