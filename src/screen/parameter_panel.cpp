#include "screen/parameter_panel.h"

#include <QHBoxLayout>
#include <QHeaderView>
#include <QPushButton>
#include <QVBoxLayout>

namespace laparoscope_servo::screen {

namespace {

constexpr int kMeaningHeight = 54;  // px
constexpr int kNameWidth = 280;     // px

QString nameOf(const LiveParameter& parameter) {
  return QString::fromStdString(parameter.node + "/" + parameter.name).replace("__", "/");
}

}  // namespace

ParameterPanel::ParameterPanel(const Set& set, QWidget* parent) : QWidget(parent), set_(set) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(table_ = new QTableWidget(0, 2, this));
  table_->setObjectName("parameters");
  table_->setHorizontalHeaderLabels({"parameter", "is"});
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setDefaultSectionSize(22);
  table_->horizontalHeader()->setStretchLastSection(true);
  table_->setColumnWidth(0, kNameWidth);
  table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  table_->setSelectionBehavior(QAbstractItemView::SelectRows);
  table_->setSelectionMode(QAbstractItemView::SingleSelection);
  table_->setFocusPolicy(Qt::NoFocus);
  layout->addWidget(meaning_ = new QLabel("Choose a parameter.", this));
  meaning_->setObjectName("meaning");
  meaning_->setTextFormat(Qt::PlainText);
  meaning_->setWordWrap(true);
  meaning_->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  meaning_->setFixedHeight(kMeaningHeight);
  auto* row = new QHBoxLayout;
  row->addWidget(value_ = new QLineEdit(this), 2);
  value_->setObjectName("value");
  value_->setFocusPolicy(Qt::ClickFocus);
  auto* button = new QPushButton("Set", this);
  button->setObjectName("set_parameter");
  button->setFocusPolicy(Qt::NoFocus);
  row->addWidget(button, 1);
  layout->addLayout(row);
  connect(button, &QPushButton::clicked, this, [this] { give(); });
  connect(value_, &QLineEdit::returnPressed, this, [this] { give(); });
  connect(table_, &QTableWidget::itemSelectionChanged, this, [this] { choose(); });
}

const LiveParameter* ParameterPanel::chosen() const {
  const int row = table_->currentRow();
  const bool there = parameters_ && row >= 0 && row < static_cast<int>(parameters_->size());
  return there ? &(*parameters_)[static_cast<std::size_t>(row)] : nullptr;
}

void ParameterPanel::show(const Facts& facts) {
  if (facts.parameters == parameters_) return;
  parameters_ = facts.parameters;
  fill();
}

// Keeps the text being typed and the selection.
void ParameterPanel::fill() {
  const int rows = parameters_ ? static_cast<int>(parameters_->size()) : 0;
  if (table_->rowCount() != rows) {
    table_->clearSelection();
    table_->setRowCount(rows);
  }
  for (int row = 0; row < rows; ++row) {
    const LiveParameter& parameter = (*parameters_)[static_cast<std::size_t>(row)];
    const QString texts[] = {nameOf(parameter), QString::fromStdString(parameter.value)};
    for (int column = 0; column < 2; ++column) {
      if (table_->item(row, column) == nullptr) table_->setItem(row, column, new QTableWidgetItem);
      if (table_->item(row, column)->text() != texts[column]) table_->item(row, column)->setText(texts[column]);
    }
  }
}

void ParameterPanel::choose() {
  const LiveParameter* parameter = chosen();
  if (parameter == nullptr) return meaning_->setText("Choose a parameter.");
  meaning_->setText(nameOf(*parameter) + ": " + QString::fromStdString(parameter->meaning));
  value_->setText(QString::fromStdString(parameter->value));
}

void ParameterPanel::give() {
  if (const LiveParameter* parameter = chosen()) set_(*parameter, value_->text().toStdString());
}

}  // namespace laparoscope_servo::screen
