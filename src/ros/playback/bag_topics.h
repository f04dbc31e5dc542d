// Which topics of a bag have the images and the intrinsics. What is thrown is a SourceError that lists the topics.
#pragma once

#include <map>
#include <string>

namespace laparoscope_servo {

using Topics = std::map<std::string, std::string>;  // name to type

// `wanted`, or the only one with images when it is empty. `path`: of the bag, for errors.
std::string chooseImageTopic(const Topics& topics, const std::string& path, const std::string& wanted);

// As a camera driver names it: beside the image's topic; that of a compressed image has the transport's name appended.
std::string usualCameraInfoTopic(const Topics& topics, const std::string& image_topic);
// `wanted`, or the usual one when it is empty. Empty when there is none.
std::string chooseCameraInfoTopic(const Topics& topics, const std::string& path, const std::string& image_topic,
                                  const std::string& wanted);
// What a user may have meant when there is no camera_info where it is looked for: names, with commas.
std::string otherCameraInfoTopics(const Topics& topics);

}  // namespace laparoscope_servo
