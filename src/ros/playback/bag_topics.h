// Finds the topics of a bag with the images and the intrinsics. Errors are SourceErrors that list the topics.
#pragma once

#include <map>
#include <string>

namespace laparoscope_servo {

using Topics = std::map<std::string, std::string>;  // name to type

// Returns `wanted`, or if it is empty the only topic with images. `path`: of the bag, for errors.
std::string chooseImageTopic(const Topics& topics, const std::string& path, const std::string& wanted);

// The name that a camera driver uses: beside the image's topic (for a compressed image, that without the transport's
// name).
std::string usualCameraInfoTopic(const Topics& topics, const std::string& image_topic);
// Returns `wanted`, or if it is empty the usual name. Empty if there is none.
std::string chooseCameraInfoTopic(const Topics& topics, const std::string& path, const std::string& image_topic,
                                  const std::string& wanted);
// Other topics with camera_info, separated by commas, for the error that the expected one is missing.
std::string otherCameraInfoTopics(const Topics& topics);

}  // namespace laparoscope_servo
