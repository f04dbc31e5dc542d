#include "ros/playback/bag_topics.h"

#include "ros/playback/image_source.h"

namespace laparoscope_servo {

namespace {

const char* const kImageType = "sensor_msgs/Image";
const char* const kCompressedType = "sensor_msgs/CompressedImage";
const char* const kCameraInfoType = "sensor_msgs/CameraInfo";

bool isImageType(const std::string& type) {
  return type == kImageType || type == kCompressedType;
}

std::string listing(const Topics& topics) {
  if (topics.empty()) return "the bag is empty";
  std::string text = "the bag has:";
  for (const auto& [name, type] : topics) text += "\n  " + name + " (" + type + ")";
  return text;
}

Topics::const_iterator findTopic(const Topics& topics, const std::string& path, const std::string& wanted) {
  auto found = topics.find(wanted);
  if (found == topics.end()) found = topics.find('/' + wanted);
  if (found == topics.end()) throw SourceError("bag '" + path + "' has no topic '" + wanted + "'; " + listing(topics));
  return found;
}

std::string parent(const std::string& topic) {
  const std::size_t slash = topic.rfind('/');
  return slash == std::string::npos ? "" : topic.substr(0, slash);
}

}  // namespace

std::string chooseImageTopic(const Topics& topics, const std::string& path, const std::string& wanted) {
  const std::string expected = std::string(", expected ") + kImageType + " or " + kCompressedType + "; ";
  if (!wanted.empty()) {
    const auto found = findTopic(topics, path, wanted);
    if (!isImageType(found->second)) {
      throw SourceError("topic '" + wanted + "' of bag '" + path + "' is of type " + found->second + expected +
                        listing(topics));
    }
    return found->first;
  }
  Topics with_images;
  for (const auto& topic : topics) {
    if (isImageType(topic.second)) with_images.insert(topic);
  }
  if (with_images.empty())
    throw SourceError("bag '" + path + "' has no topic with images" + expected + listing(topics));
  if (with_images.size() > 1) {
    std::string text = "bag '" + path + "' has several topics with images, choose one by --image-topic:";
    for (const auto& [name, type] : with_images) text += "\n  " + name + " (" + type + ")";
    throw SourceError(text);
  }
  return with_images.begin()->first;
}

std::string usualCameraInfoTopic(const Topics& topics, const std::string& image_topic) {
  const std::string raw_topic = topics.at(image_topic) == kCompressedType ? parent(image_topic) : image_topic;
  const std::string beside = parent(raw_topic);
  return beside.empty() && raw_topic.find('/') == std::string::npos ? "camera_info" : beside + "/camera_info";
}

std::string chooseCameraInfoTopic(const Topics& topics, const std::string& path, const std::string& image_topic,
                                  const std::string& wanted) {
  if (wanted.empty()) {
    const auto found = topics.find(usualCameraInfoTopic(topics, image_topic));
    return found != topics.end() && found->second == kCameraInfoType ? found->first : "";
  }
  const auto found = findTopic(topics, path, wanted);
  if (found->second == kCameraInfoType) return found->first;
  throw SourceError("topic '" + wanted + "' of bag '" + path + "' is of type " + found->second + ", expected " +
                    kCameraInfoType + "; " + listing(topics));
}

std::string otherCameraInfoTopics(const Topics& topics) {
  std::string names;
  for (const auto& [name, type] : topics) {
    if (type == kCameraInfoType) names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}

}  // namespace laparoscope_servo
