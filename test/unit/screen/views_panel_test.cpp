#include "screen/views_panel.h"

#include <gtest/gtest.h>

#include <QtTest>

namespace laparoscope_servo::screen {
namespace {

StoredView view(const std::string& name, const std::vector<std::string>& leads_to) {
  StoredView view;
  view.name = name;
  view.stamp = 7;
  view.thumbnail = QImage(160, 90, QImage::Format_RGB32);
  view.thumbnail.fill(Qt::red);
  view.size = QSize(1280, 720);
  view.roi = QRect(300, 200, 400, 300);
  view.leads_to = leads_to;
  return view;
}

class ViewsPanelTest : public testing::Test {
 protected:
  void list(const std::vector<StoredView>& views) {
    facts_.views = std::make_shared<std::vector<StoredView>>(views);
    panel_.show(facts_);
  }
  template <class Widget>
  Widget* find(const QString& name) {
    return panel_.findChild<Widget*>(name);
  }
  Facts facts_;
  std::vector<std::string> stored_, recalled_;
  ViewsPanel panel_{[this](const std::string& name) { stored_.push_back(name); },
                    [this](const std::string& name) { recalled_.push_back(name); }, nullptr};
};

TEST_F(ViewsPanelTest, StoresUnderANameAndGoesBackToTheChosenOne) {
  panel_.show(facts_);
  EXPECT_FALSE(find<QPushButton>("recall_view")->isEnabled());
  find<QLineEdit>("view_name")->setText("gall bladder");
  QTest::mouseClick(find<QPushButton>("store_view"), Qt::LeftButton);
  EXPECT_EQ(stored_, std::vector<std::string>{"gall bladder"});
  list({view("a", {"b"}), view("b", {})});
  auto* views = find<QListWidget>("views");
  ASSERT_EQ(views->count(), 2);
  EXPECT_TRUE(recalled_.empty());
  views->setCurrentRow(0);
  EXPECT_TRUE(recalled_.empty()) << "to choose moves nothing";
  EXPECT_EQ(find<QLabel>("way")->text(), "From it one comes to b.");
  QTest::mouseClick(find<QPushButton>("recall_view"), Qt::LeftButton);
  EXPECT_EQ(recalled_, std::vector<std::string>{"a"});
}

TEST_F(ViewsPanelTest, ShowsTheWayAndKeepsTheChoice) {
  list({view("a", {}), view("b", {})});
  find<QListWidget>("views")->setCurrentRow(1);
  list({view("a", {}), view("aa", {}), view("b", {})});
  EXPECT_EQ(find<QListWidget>("views")->currentItem()->text(), "b");
  facts_.tracker.view = "going to view 'c', now to 'b' (1 of 2)";
  panel_.show(facts_);
  EXPECT_EQ(find<QLabel>("way")->text().toStdString(), facts_.tracker.view);
  facts_.views.reset();
  panel_.show(facts_);
  EXPECT_EQ(find<QListWidget>("views")->count(), 0) << "the tracker that knew them is gone";
}

TEST_F(ViewsPanelTest, ANameIsNoMarkupAndAPictureMayBeMissing) {
  StoredView odd = view("<b>bold</b>" + std::string(50, 'x'), {"<img src=x>"});
  odd.thumbnail = QImage();
  list({odd});
  find<QListWidget>("views")->setCurrentRow(0);
  EXPECT_EQ(find<QLabel>("way")->textFormat(), Qt::PlainText);
  EXPECT_EQ(find<QListWidget>("views")->item(0)->text().toStdString(), odd.name);
  EXPECT_TRUE(find<QListWidget>("views")->item(0)->toolTip().startsWith("&lt;b&gt;bold")) << "all of it, no markup";
  EXPECT_EQ(find<QLineEdit>("view_name")->cursorPosition(), 0) << "its beginning is shown";
  panel_.resize(400, 300);
  QImage image(panel_.size(), QImage::Format_RGB32);
  panel_.render(&image);
}

}  // namespace
}  // namespace laparoscope_servo::screen
