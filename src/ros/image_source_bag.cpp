#include <ros/serialization.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CompressedImage.h>

#include <map>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <utility>
#include <vector>

#include "image_sources.h"
#include "laparoscope_servo/ros/image_conversion.h"

namespace laparoscope_servo::skin {

namespace {

const char* const kImageType = "sensor_msgs/Image";
const char* const kCompressedType = "sensor_msgs/CompressedImage";
const char* const kCameraInfoType = "sensor_msgs/CameraInfo";

using Topics = std::map<std::string, std::string>;  // name to type

bool isImageType(const std::string& type) {
  return type == kImageType || type == kCompressedType;
}

std::string listing(const Topics& topics) {
  if (topics.empty()) return "the bag is empty";
  std::string text = "the bag has:";
  for (const auto& [name, type] : topics) text += "\n  " + name + " (" + type + ")";
  return text;
}

std::string chooseImageTopic(const Topics& topics, const std::string& path, const std::string& wanted) {
  const std::string expected = std::string(", expected ") + kImageType + " or " + kCompressedType + "; ";
  if (!wanted.empty()) {
    auto found = topics.find(wanted);
    if (found == topics.end()) found = topics.find('/' + wanted);
    if (found == topics.end())
      throw SourceError("bag '" + path + "' has no topic '" + wanted + "'; " + listing(topics));
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

std::string parent(const std::string& topic) {
  const std::size_t slash = topic.rfind('/');
  return slash == std::string::npos ? "" : topic.substr(0, slash);
}

// As a camera driver names it: beside the image's topic; that of a compressed image has the transport's name appended.
std::string cameraInfoTopic(const Topics& topics, const std::string& image_topic) {
  const std::string raw_topic = topics.at(image_topic) == kCompressedType ? parent(image_topic) : image_topic;
  const std::string beside = parent(raw_topic);
  const std::string name =
      beside.empty() && raw_topic.find('/') == std::string::npos ? "camera_info" : beside + "/camera_info";
  const auto found = topics.find(name);
  return found != topics.end() && found->second == kCameraInfoType ? name : "";
}

void decode(const sensor_msgs::CompressedImage& message, SourceImage& image) {
  image.header = message.header;
  const std::string what =
      "compressed image with format '" + message.format + "' and " + std::to_string(message.data.size()) + " bytes";
  if (!message.data.empty()) {
    try {
      image.decoded = cv::imdecode(message.data, cv::IMREAD_UNCHANGED);
    } catch (const cv::Exception&) {
      image.decoded.release();
    }
  }
  if (image.decoded.empty()) {
    image.error = what + " cannot be decoded, expected JPEG or PNG";
  } else if (isBayer(message.format) && image.decoded.channels() == 1) {
    image.error = what + " is a colour filter pattern, expected grey or colour: let image_proc turn it into colour";
    image.decoded.release();
  }
}

class BagSource : public ImageSource {
 public:
  BagSource(const std::string& path, const SourceOptions& options) : path_(path) {
    try {
      bag_.open(path, rosbag::bagmode::Read);
      open(options);
    } catch (const rosbag::BagUnindexedException&) {
      throw SourceError("bag '" + path + "' has no index, it was not closed: 'rosbag reindex' may repair it");
    } catch (const rosbag::BagException& error) {
      throw SourceError("'" + path + "' is no bag, or a damaged one (" + error.what() +
                        "); 'rosbag reindex' may repair it");
    }
  }

  std::optional<SourceImage> next() override {
    try {
      return read();
    } catch (const ros::Exception& error) {  // of rosbag, and of the messages' deserialisation
      throw SourceError("bag '" + path_ + "' is damaged behind image " + std::to_string(frame_) + " (" + error.what() +
                        "); 'rosbag reindex' may repair it");
    }
  }

  std::size_t size() const override { return size_; }
  double rate() const override { return rate_; }
  bool hasRecordedStamps() const override { return true; }

 private:
  void open(const SourceOptions& options) {
    Topics topics;
    rosbag::View all(bag_);
    for (const rosbag::ConnectionInfo* connection : all.getConnections())
      topics[connection->topic] = connection->datatype;
    image_topic_ = chooseImageTopic(topics, path_, options.image_topic);
    rosbag::View images(bag_, rosbag::TopicQuery(image_topic_));
    size_ = images.size();
    const double duration = (images.getEndTime() - images.getBeginTime()).toSec();
    rate_ = size_ > 1 && duration > 0.0 ? static_cast<double>(size_ - 1) / duration : options.folder_rate;
    start_ = images.getBeginTime() + ros::Duration(options.start);

    std::vector<std::string> read_topics{image_topic_};
    const std::string camera_info_topic = cameraInfoTopic(topics, image_topic_);
    if (!camera_info_topic.empty()) {
      read_topics.push_back(camera_info_topic);
      // A driver sends it after the image it belongs to; the first image should have it, too.
      rosbag::View infos(bag_, rosbag::TopicQuery(camera_info_topic));
      if (infos.size() > 0) camera_info_ = infos.begin()->instantiate<sensor_msgs::CameraInfo>();
    }
    view_ = std::make_unique<rosbag::View>(bag_, rosbag::TopicQuery(read_topics));
    position_ = view_->begin();
  }

  std::optional<SourceImage> read() {
    for (; position_ != view_->end(); ++position_) {
      const rosbag::MessageInstance& instance = *position_;
      if (instance.getTopic() != image_topic_) {
        if (const auto info = instance.instantiate<sensor_msgs::CameraInfo>()) camera_info_ = info;
        continue;
      }
      const std::size_t frame = frame_++;
      if (instance.getTime() < start_) continue;
      SourceImage image = imageOf(instance);
      image.frame = frame;
      image.record_time = instance.getTime();
      image.camera_info.swap(camera_info_);
      ++position_;
      return image;
    }
    return std::nullopt;
  }

  SourceImage imageOf(const rosbag::MessageInstance& instance) const {
    SourceImage image;
    if (const auto raw = instance.instantiate<sensor_msgs::Image>()) {
      image.message = raw;
      image.header = raw->header;
    } else if (const auto compressed = instance.instantiate<sensor_msgs::CompressedImage>()) {
      decode(*compressed, image);
    } else {
      image.error = "message of topic '" + image_topic_ + "' has another definition of its type than this system";
    }
    return image;
  }

  std::string path_;
  rosbag::Bag bag_;
  std::string image_topic_;
  std::size_t size_ = 0;
  double rate_ = 0.0;
  ros::Time start_;
  std::unique_ptr<rosbag::View> view_;
  rosbag::View::iterator position_;
  std::size_t frame_ = 0;
  sensor_msgs::CameraInfoConstPtr camera_info_;  // newest that no image has taken along
};

}  // namespace

std::unique_ptr<ImageSource> openBagSource(const std::string& path, const SourceOptions& options) {
  return std::make_unique<BagSource>(path, options);
}

}  // namespace laparoscope_servo::skin
