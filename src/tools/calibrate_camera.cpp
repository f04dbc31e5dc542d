// Calibrates a camera by pictures of a printed board, and writes that board: see --help.
#include <camera_calibration_parsers/parse.h>

#include <boost/program_options.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "ros/camera/board_calibration.h"
#include "ros/camera/camera_config.h"
#include "ros/common/run_tool.h"
#include "ros/playback/image_source.h"
#include "ros/tracker/image_conversion.h"

namespace {

namespace options = boost::program_options;
using namespace laparoscope_servo;

struct Wanted {
  std::vector<std::string> inputs;
  SourceOptions source;
  std::string corners = "9x6";
  double square = 0.004;  // m
  bool markers = false;
  double interval = 0.25;  // s
  std::string model = "plumb_bob";
  std::string name = "laparoscope";
  std::string output;
  std::string print;
};

options::options_description describe(Wanted& wanted) {
  options::options_description description("Options");
  auto add = description.add_options();
  add("help", "print this and end");
  add("input", options::value(&wanted.inputs)->composing(), "bag, video, or folder of images");
  add("board", options::value(&wanted.corners), "inner corners of the board, COLUMNSxROWS (default 9x6)");
  add("square", options::value(&wanted.square), "m, side of a square (default 0.004)");
  add("markers", options::bool_switch(&wanted.markers),
      "the board has ArUco markers in its white squares (ChArUco): a part of it in the picture is enough");
  add("image-topic", options::value(&wanted.source.image_topic), "of a bag with several topics of images");
  add("interval", options::value(&wanted.interval), "s, between two images that are looked at (default 0.25)");
  add("model", options::value(&wanted.model), "plumb_bob (default) or rational_polynomial, for a lens that bends much");
  add("name", options::value(&wanted.name),
      "of the camera (default laparoscope): the result is where camera.launch looks for it");
  add("output", options::value(&wanted.output), "file of the result, .yaml or .ini, instead of the camera's name");
  add("print", options::value(&wanted.print), "SVG of the board to write, and nothing else");
  return description;
}

Board boardOf(const Wanted& wanted) {
  Board board;
  char rest = 0;
  if (std::sscanf(wanted.corners.c_str(), "%dx%d%c", &board.corners.width, &board.corners.height, &rest) != 2)
    throw std::invalid_argument("--board " + wanted.corners + ", expected e.g. 9x6");
  board.square = wanted.square;
  board.markers = wanted.markers;
  checkBoard(board);
  return board;
}

void print(const Board& board, const std::string& file) {
  std::ofstream stream(file);
  writeBoard(board, stream);
  stream.close();
  if (!stream) throw std::runtime_error("'" + file + "' cannot be written");
  std::cout << file << ": print it without scaling, and glue it to something flat; measure a square\n";
}

// Prints a line for each image that was kept, since the run takes minutes.
void look(const Wanted& wanted, BoardViews& views) {
  const auto source = openImageSource(wanted.inputs, wanted.source);
  double next = 0.0;
  std::size_t looked_at = 0;
  bool first = true;
  while (const auto image = source->next()) {
    const double time = image->header.stamp.toSec();
    if (!image->error.empty() || (!first && time < next && wanted.interval > 0.0)) continue;
    first = false;
    next = time + wanted.interval;
    ++looked_at;
    const cv::Mat picture = image->message ? trackerImage(*image->message) : trackerImage(image->decoded);
    const BoardViews::Verdict verdict = views.add(picture);
    if (verdict == BoardViews::Verdict::kEnough) break;
    if (verdict == BoardViews::Verdict::kTaken) {
      std::cout << "image " << image->frame << ": board " << views.views().size() << ", "
                << static_cast<int>(100.0 * views.coverage()) << " % of the picture covered" << std::endl;
    }
    if (verdict == BoardViews::Verdict::kOtherSize)
      std::cerr << "image " << image->frame << " is left out: its size is not that of the first one\n";
  }
  std::cout << looked_at << " images looked at, " << views.views().size() << " used\n";
}

void write(const Wanted& wanted, const sensor_msgs::CameraInfo& info) {
  const std::filesystem::path file = wanted.output.empty() ? calibrationFile(wanted.name) : wanted.output;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
  // The parsers choose the format by the extension.
  const std::filesystem::path partial = file.parent_path() / ("partial." + file.filename().string());
  if (!camera_calibration_parsers::writeCalibration(partial.string(), wanted.name, info))
    throw std::runtime_error("'" + file.string() + "' cannot be written");
  std::filesystem::rename(partial, file);
  std::cout << file.string() << '\n';
}

void run(const Wanted& wanted) {
  const Board board = boardOf(wanted);
  if (!wanted.print.empty()) return print(board, wanted.print);
  if (wanted.inputs.empty()) throw std::invalid_argument("no input is given, expected a bag, a video or a folder");
  if (wanted.model != "plumb_bob" && wanted.model != "rational_polynomial")
    throw std::invalid_argument("--model " + wanted.model + ", expected plumb_bob or rational_polynomial");
  CameraConfig named;
  named.name = wanted.name;
  for (const std::string& error : validate(named)) throw std::invalid_argument(error);
  BoardViews views(board);
  look(wanted, views);
  const BoardCalibration result = calibrate(views, wanted.model == "rational_polynomial");
  std::printf("focal length %.1f, %.1f px (standard deviation %.1f), centre %.1f, %.1f px\n", result.info.K[0],
              result.info.K[4], result.focal_stddev, result.info.K[2], result.info.K[5]);
  std::printf("corners %.3f px from where they should be (root mean square)\n", result.error);
  if (views.coverage() < 0.6)
    std::puts("note: large parts of the picture never showed the board: there the lens is a guess");
  std::fflush(stdout);
  write(wanted, result.info);
}

}  // namespace

int main(int argc, char** argv) {
  Wanted wanted;
  const options::options_description description = describe(wanted);
  const std::string usage =
      "calibrate_camera INPUT... [options]: intrinsics and lens from pictures of a printed board.\n"
      "calibrate_camera --print board.svg [--board 9x6 --square 0.004 --markers]: writes the board.\n";
  return runTool(argc, argv, "calibrate_camera", usage, description, "input", [&] {
    run(wanted);
    return EXIT_SUCCESS;
  });
}
