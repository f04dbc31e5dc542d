#include "screen/views_panel.h"

#include <QHBoxLayout>
#include <QPainter>
#include <QVBoxLayout>
#include <algorithm>

namespace laparoscope_servo::screen {

namespace {

const QSize kThumbnail(120, 90);
constexpr int kWayHeight = 36;  // px

// The view's picture with its region drawn in it.
QPixmap pictureOf(const StoredView& view) {
  QPixmap pixmap(kThumbnail);
  pixmap.fill(Qt::black);
  QPainter painter(&pixmap);
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  if (view.thumbnail.isNull() || view.size.isEmpty()) {
    painter.setPen(Qt::white);
    painter.drawText(pixmap.rect(), Qt::AlignCenter, "no picture");
    return pixmap;
  }
  const QSizeF size = QSizeF(view.size).scaled(kThumbnail, Qt::KeepAspectRatio);
  const double scale = size.width() / view.size.width();
  const QPointF origin((kThumbnail.width() - size.width()) / 2, (kThumbnail.height() - size.height()) / 2);
  painter.drawImage(QRectF(origin, size), view.thumbnail);
  const QRectF roi(origin + scale * QPointF(view.roi.topLeft()), scale * QSizeF(view.roi.size()));
  painter.setPen(QPen(Qt::black, 4));
  painter.drawRect(roi);
  painter.setPen(QPen(QColor(0x40, 0xe0, 0xff), 2));
  painter.drawRect(roi);
  return pixmap;
}

}  // namespace

ViewsPanel::ViewsPanel(const Named& store, const Named& recall, QWidget* parent)
    : QWidget(parent), store_(store), recall_(recall) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(list_ = new QListWidget(this));
  list_->setObjectName("views");
  list_->setViewMode(QListView::IconMode);
  list_->setMovement(QListView::Static);
  list_->setResizeMode(QListView::Adjust);
  list_->setIconSize(kThumbnail);
  list_->setGridSize(kThumbnail + QSize(6, 26));
  list_->setFocusPolicy(Qt::NoFocus);
  layout->addWidget(way_ = new QLabel(this));
  way_->setObjectName("way");
  way_->setTextFormat(Qt::PlainText);
  way_->setWordWrap(true);
  way_->setFixedHeight(kWayHeight);
  way_->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  auto* row = new QHBoxLayout;
  row->addWidget(name_ = new QLineEdit(this), 2);
  name_->setObjectName("view_name");
  name_->setPlaceholderText("name of the view");
  name_->setMaxLength(64);
  name_->setFocusPolicy(Qt::ClickFocus);
  auto* store_button = new QPushButton("Store", this);
  recall_button_ = new QPushButton("Go back to it", this);
  store_button->setObjectName("store_view");
  store_button->setToolTip("Stores what is seen now, with the region where it is, under this name");
  recall_button_->setObjectName("recall_view");
  recall_button_->setToolTip("Makes the chosen view the target. An engaged controller moves the scope there");
  for (QPushButton* button : {store_button, recall_button_}) {
    button->setFocusPolicy(Qt::NoFocus);
    row->addWidget(button, 1);
  }
  layout->addLayout(row);
  const auto storeNamed = [this] { store_(name_->text().trimmed().toStdString()); };
  connect(store_button, &QPushButton::clicked, this, storeNamed);
  connect(name_, &QLineEdit::returnPressed, this, storeNamed);
  connect(recall_button_, &QPushButton::clicked, this, [this] {
    if (list_->currentItem() != nullptr) recall_(list_->currentItem()->text().toStdString());
  });
  connect(list_, &QListWidget::currentItemChanged, this, [this] { choose(); });
  choose();
}

void ViewsPanel::show(const Facts& facts) {
  if (facts.views != views_) {
    views_ = facts.views;
    fill();
  }
  if (!facts.tracker.view.empty()) {
    way_->setText(QString::fromStdString(facts.tracker.view));
  } else if (list_->currentItem() == nullptr) {
    way_->setText(views_ == nullptr ? "The tracker has not told its views."
                  : views_->empty() ? "No view is stored."
                                    : "Choose a view.");
  }
}

void ViewsPanel::fill() {
  const QString chosen = list_->currentItem() != nullptr ? list_->currentItem()->text() : QString();
  list_->clear();
  if (views_ == nullptr) return;
  for (const StoredView& view : *views_) {
    auto* item = new QListWidgetItem(QIcon(pictureOf(view)), QString::fromStdString(view.name), list_);
    item->setToolTip(item->text().toHtmlEscaped());  // a long name is cut off below its picture
    if (item->text() == chosen) list_->setCurrentItem(item);
  }
}

void ViewsPanel::choose() {
  QListWidgetItem* item = list_->currentItem();
  recall_button_->setEnabled(item != nullptr);
  if (item == nullptr || views_ == nullptr) return;
  name_->setText(item->text());
  name_->setCursorPosition(0);  // otherwise the end of a long name is shown
  const auto view = std::find_if(views_->begin(), views_->end(), [&](const StoredView& candidate) {
    return candidate.name == item->text().toStdString();
  });
  if (view == views_->end()) return;
  QString text = "From it one comes to ";
  for (std::size_t k = 0; k < view->leads_to.size(); ++k)
    text += (k == 0 ? "" : ", ") + QString::fromStdString(view->leads_to[k]);
  way_->setText(view->leads_to.empty() ? "From it no other view is reached." : text + ".");
}

}  // namespace laparoscope_servo::screen
