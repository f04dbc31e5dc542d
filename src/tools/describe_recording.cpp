// Prints what is known of a recording before it is tracked, its length, size and a region that would do: see --help.
#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "ros/common/json_writer.h"
#include "ros/common/run_tool.h"
#include "ros/playback/first_image.h"
#include "ros/playback/offline_options.h"

namespace {

namespace options = boost::program_options;
using namespace laparoscope_servo;

constexpr int kPictureSide = 480;     // px, the most of the picture that is written
constexpr double kShare = 1.0 / 3.0;  // of the image's smaller side: side of the region that is looked at first

struct Command {
  OfflineOptions offline;
  std::string parameters;
  std::string roi;
  std::string picture;
};

// A square at the image's centre, or what the tracker would take near it; empty: there is none.
std::optional<geometry::Rectangle> suggest(const FirstImage& first) {
  const double side = std::floor(kShare * std::min(first.size().width, first.size().height));
  const geometry::Rectangle centre{std::floor((first.size().width - side) / 2.0),
                                   std::floor((first.size().height - side) / 2.0), side, side};
  return first.refusal(centre).empty() ? centre : first.proposal(centre);
}

void writePicture(const FirstImage& first, const std::optional<geometry::Rectangle>& roi, const std::string& name) {
  cv::Mat picture = first.picture(kPictureSide).clone();
  if (roi) {
    const double scale = static_cast<double>(picture.cols) / first.size().width;
    const cv::Rect box(cv::Rect2d(scale * roi->x, scale * roi->y, scale * roi->width, scale * roi->height));
    // to be seen on bright and on dark tissue, also on a page that shows the picture a third as large
    cv::rectangle(picture, box, cv::Scalar::all(0), 7);
    cv::rectangle(picture, box, cv::Scalar::all(255), 3);
  }
  if (!cv::imwrite(name, picture)) throw std::runtime_error("'" + name + "' cannot be written");
}

void describe(Command& command) {
  const auto source = openImageSource(command.offline.inputs, command.offline.source);
  command.offline.parameters = readOfflineParameters(command.parameters);
  const FirstImage first(command.offline);
  const bool given = !command.roi.empty();
  const std::optional<geometry::Rectangle> roi = given ? parseRoi(command.roi) : suggest(first);
  if (!command.picture.empty()) writePicture(first, roi, command.picture);
  JsonWriter json(std::cout);
  json.beginObject();
  json.value("width", first.size().width);
  json.value("height", first.size().height);
  json.value("images", static_cast<int>(source->size()));
  json.value("rate", source->rate());
  json.value("first_image", static_cast<int>(first.frame()));
  json.value("roi", roi ? roiText(*roi) : "");
  json.value("refusal", roi && given ? first.refusal(*roi) : "");
  json.end();
}

}  // namespace

int main(int argc, char** argv) {
  Command command;
  options::options_description description("Options");
  auto add = description.add_options();
  add("help", "print this and end");
  add("roi", options::value(&command.roi),
      "x,y,width,height: the region that is looked at, instead of a suggested one");
  add("picture", options::value(&command.picture), "file to write (.jpg, .png): the first image with the region");
  describeInput(description, command.offline, command.parameters);
  const std::string usage =
      "describe_recording INPUT... [options]: opens a bag, a video or a folder, decodes the first image (of --start),\n"
      "and prints a JSON object: width and height in px, images by the file (0: it does not say), rate in Hz, the\n"
      "number of the first image, a region x,y,width,height that the tracker would take there (empty: it knows none),\n"
      "and why it would refuse the one of --roi (empty: it would not).\n";
  return runTool(argc, argv, "describe_recording", usage, description, "input", [&] {
    describe(command);
    return EXIT_SUCCESS;
  });
}
