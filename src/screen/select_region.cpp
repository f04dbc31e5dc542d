// Shows the first image of a bag, a video or a folder, and prints the region that is drawn in it: see --help.
#include <QApplication>
#include <QScreen>
#include <boost/program_options.hpp>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>

#include "ros/common/run_tool.h"
#include "ros/playback/first_image.h"
#include "ros/playback/offline_options.h"
#include "ros/tracker/result_messages.h"
#include "screen/preview_image.h"
#include "screen/select_window.h"

namespace {

using namespace laparoscope_servo;

constexpr int kPictureSide = 1280;  // px, the most that is shown

// Qt would abort.
void expectDisplay() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"}) {
    const char* value = std::getenv(name);
    if (value != nullptr && *value != '\0') return;
  }
  throw std::runtime_error("there is no display to draw a region on (DISPLAY is not set); give --roi x,y,width,height");
}

screen::Verdict verdictOn(const FirstImage& first, const QRect& region) {
  const geometry::Rectangle roi{static_cast<double>(region.x()), static_cast<double>(region.y()),
                                static_cast<double>(region.width()), static_cast<double>(region.height())};
  screen::Verdict verdict;
  verdict.why = first.refusal(roi);
  verdict.taken = verdict.why.empty();
  const auto proposal = verdict.taken ? std::nullopt : first.proposal(roi);
  if (proposal) {
    verdict.proposal = QRect(static_cast<int>(proposal->x), static_cast<int>(proposal->y),
                             static_cast<int>(proposal->width), static_cast<int>(proposal->height));
  }
  return verdict;
}

int select(int& argc, char** argv, const OfflineOptions& offline) {
  expectDisplay();
  const FirstImage first(offline);
  const QImage picture = screen::previewImage(*imageMessage({}, first.picture(kPictureSide)));
  QApplication application(argc, argv);
  screen::SelectWindow window(picture, QSize(first.size().width, first.size().height),
                              [&](const QRect& region) { return verdictOn(first, region); });
  window.setWindowTitle(
      QString("Region in image %1 of %2").arg(first.frame()).arg(QString::fromStdString(offline.inputs.front())));
  window.resize(QSize(1280, 800).boundedTo(QGuiApplication::primaryScreen()->availableSize()));
  window.show();
  QApplication::exec();
  const std::optional<QRect> region = window.selected();
  if (!region) throw std::runtime_error("no region was selected");
  std::cout << region->x() << ',' << region->y() << ',' << region->width() << ',' << region->height() << std::endl;
  return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
  OfflineOptions offline;
  std::string parameters;
  boost::program_options::options_description description("Options");
  description.add_options()("help", "print this and end");
  describeInput(description, offline, parameters);
  const std::string usage =
      "select_region INPUT... [options]: shows the first image, and prints the region that is drawn in it as\n"
      "x,y,width,height. Ends with status 1 when none was.\n";
  return runTool(argc, argv, "select_region", usage, description, "input", [&] {
    offline.parameters = readOfflineParameters(parameters);
    return select(argc, argv, offline);
  });
}
