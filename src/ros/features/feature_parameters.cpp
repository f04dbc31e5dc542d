#include "ros/features/feature_parameters.h"

#include "ros/tracker/tracker_parameters.h"

namespace laparoscope_servo {

namespace {

void describeInput(parameters::Table& table, tracking::InputConfig& c) {
  table.number("max_repeats", c.max_repeats, {0, 25}, "images",
               "number in a row that may repeat their picture; with more the feed counts as frozen (SEARCHING)");
  table.number("max_still_repeats", c.max_still_repeats, {0, 1000}, "images",
               "number in a row that may repeat around the features alone, since a codec may skip what rests");
  describeSequence(table, c, "the features are forgotten, and those of `selection` selected again");
}

}  // namespace

void describe(parameters::Table& table, FeatureInput& input) {
  table
      .text("selection", input.selection,
            "file with the features that are selected in the first image, the whole path; empty: by select_features")
      .accepting("a path that begins with a slash, or nothing",
                 [](const std::string& file) { return file.empty() || file.front() == '/'; });
  table.flag("rectified_images", input.rectified_images,
             "the images are rectified: P of camera_info applies to them, otherwise K");
  table.number("select_timeout", input.select_timeout, {0.1, 60}, "s", "for which select_features waits for an image");
  table.group("image", "how pixels are stored", [&] { describe(table, input.image); });
  table.group("input", "which images are accepted", [&] { describeInput(table, input.input); });
  table.group("robot_motion", "in the nodelet: the camera's motion in tf, from which the search of each image starts",
              [&] { describe(table, input.robot_motion); });
}

std::vector<std::string> validate(const FeatureInput& input) {
  std::vector<std::string> errors = parameters::errorsOf(input);
  for (const std::string& error : validate(input.image)) errors.push_back("image/" + error);
  return errors;
}

}  // namespace laparoscope_servo
