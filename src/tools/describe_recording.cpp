// Prints what is known of a recording before it is tracked, its length, size and a region that would do: see --help.
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
#include "ros/playback/scenes.h"

namespace {

namespace options = boost::program_options;
using namespace laparoscope_servo;

constexpr int kPictureSide = 480;  // px, the most of the picture that is written

struct Command {
  OfflineOptions offline;
  std::string parameters;
  std::string roi;
  std::string picture;
  bool cuts = false;
};

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

void writeScenes(const OfflineOptions& options, JsonWriter& json) {
  json.beginArray("scenes");
  for (const Scene& scene : findScenes(options)) {
    json.beginObject();
    json.value("start", scene.start);
    if (std::isfinite(scene.end)) json.value("end", scene.end);
    json.value("roi", scene.roi ? roiText(*scene.roi) : "");
    json.end();
  }
  json.end();
}

void describe(Command& command) {
  const auto source = openImageSource(command.offline.inputs, command.offline.source);
  command.offline.parameters = readOfflineParameters(command.parameters);
  const FirstImage first(command.offline, *source);
  const bool given = !command.roi.empty();
  const std::optional<geometry::Rectangle> roi = given ? parseRoi(command.roi) : first.suggestion();
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
  if (command.cuts) writeScenes(command.offline, json);
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
  add("cuts", options::bool_switch(&command.cuts),
      "read all images, and print the scenes between the cuts of an edited film, each with a region that would do");
  describeInput(description, command.offline, command.parameters);
  const std::string usage =
      "describe_recording INPUT... [options]: opens a bag, a video or a folder, decodes the first image (of --start),\n"
      "and prints a JSON object: width and height in px, images by the file (0: it does not say), rate in Hz, the\n"
      "number of the first image, a region x,y,width,height that the tracker would take there (empty: it knows none),\n"
      "and why it would refuse the one of --roi (empty: it would not). With --cuts \"scenes\", too: of each \"start\" "
      "and\n"
      "\"end\" in s, as track_bag takes them (the last has no end), and a region in its first image.\n";
  return runTool(argc, argv, "describe_recording", usage, description, "input", [&] {
    describe(command);
    return EXIT_SUCCESS;
  });
}
