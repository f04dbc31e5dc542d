#include "ros/playback/offline_options.h"

#include <ros/package.h>

#include <boost/program_options.hpp>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "ros/common/parameters.h"

namespace laparoscope_servo {

namespace options = boost::program_options;

namespace {

cv::Rect parseCrop(const std::string& text) {
  const geometry::Rectangle r = parseRoi(text);
  const cv::Rect crop(static_cast<int>(r.x), static_cast<int>(r.y), static_cast<int>(r.width),
                      static_cast<int>(r.height));
  if (crop.x != r.x || crop.y != r.y || crop.width != r.width || crop.height != r.height)
    throw std::invalid_argument("crop '" + text + "', expected whole px");
  return crop;
}

}  // namespace

void describeInput(options::options_description& description, OfflineOptions& offline, std::string& parameters) {
  auto add = description.add_options();
  add("input", options::value(&offline.inputs)->composing(),
      "bag, video, or folder of images (in the order of their names and numbers); several: bags of one recording");
  add("image-topic", options::value(&offline.source.image_topic), "of a bag with several topics of images");
  add("camera-info-topic", options::value(&offline.source.camera_info_topic),
      "of a bag, when it is not camera_info beside the images");
  add("start", options::value(&offline.source.start), "skip so many seconds of the input");
  add("end", options::value(&offline.source.end), "s: the image at this time is the first that is left out");
  add("crop",
      options::value<std::string>()->notifier([&](const std::string& text) { offline.source.crop = parseCrop(text); }),
      "x,y,width,height, px: of a video or a folder, the part of each image that is used, as one view of a stereo "
      "video");
  add("rate", options::value(&offline.source.folder_rate), "images per second of a folder (default 25)");
  add("camera-info", options::value(&offline.camera_info),
      "calibration file (YAML, INI), instead of the bag's camera_info; needed for rectify: true where there is none");
  add("params", options::value(&parameters),
      "YAML file laid over the package's config/tracker.yaml, or config/dots.yaml, ..., as the tracker is");
}

std::vector<std::string> inputArguments(const OfflineOptions& offline, const std::string& parameters) {
  std::vector<std::string> arguments;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) arguments.push_back(std::string("--") + name + '=' + value);
  };
  const auto exact = [](double value) {
    std::ostringstream text;
    text.precision(17);
    text << value;
    return text.str();
  };
  for (const std::string& input : offline.inputs) add("input", input);
  add("image-topic", offline.source.image_topic);
  add("camera-info-topic", offline.source.camera_info_topic);
  add("start", exact(offline.source.start));
  add("rate", exact(offline.source.folder_rate));
  const cv::Rect& crop = offline.source.crop;
  if (!crop.empty())
    add("crop", roiText(geometry::Rectangle{1.0 * crop.x, 1.0 * crop.y, 1.0 * crop.width, 1.0 * crop.height}));
  add("camera-info", offline.camera_info);
  add("params", parameters);
  return arguments;
}

XmlRpc::XmlRpcValue readOfflineTree(const std::string& name, const std::string& file) {
  const std::string share = ros::package::getPath("laparoscope_servo");
  XmlRpc::XmlRpcValue tree;
  const std::string defaults = share + "/config/" + name;
  if (!share.empty() && std::filesystem::exists(defaults)) tree = parametersFromYaml(defaults);
  if (!file.empty()) tree = mergeParameters(tree, parametersFromYaml(file));
  return tree;
}

TrackerParameters readOfflineParameters(const std::string& file) {
  std::vector<std::string> errors;
  const auto parameters =
      readTrackerParameters(readOfflineTree("tracker.yaml", file), file.empty() ? "config/tracker.yaml" : file, errors);
  if (!errors.empty()) throw std::runtime_error(errorReport(errors));
  return parameters;
}

}  // namespace laparoscope_servo
