#include <ros/serialization.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CompressedImage.h>

#include <boost/make_shared.hpp>
#include <fstream>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <utility>
#include <vector>

#include "ros/playback/bag_topics.h"
#include "ros/playback/image_sources.h"
#include "ros/playback/usable_stamps.h"
#include "ros/tracker/image_conversion.h"

namespace laparoscope_servo {

namespace {

constexpr std::size_t kMostWithoutStamp = 100;  // largest number of images at the beginning that are read twice

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

// Throws SourceError for what no repair makes a bag of.
void checkBeginning(const std::string& path) {
  const std::string expected = "#ROSBAG V2.0";
  std::string begin(expected.size(), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  if (file.gcount() == 0) throw SourceError("'" + path + "' is empty, expected a bag");
  if (begin != expected) {
    throw SourceError("'" + path + "' is no bag of format 2.0, whatever its name says: it does not begin with '" +
                      expected + "'");
  }
}

SourceError brokenOff(const std::string& path, const rosbag::BagException& error) {
  return SourceError("bag '" + path + "' breaks off: it was cut, or the recorder was killed (" + error.what() +
                     "); 'rosbag reindex' makes what is there readable");
}

class BagSource : public ImageSource {
 public:
  BagSource(const std::vector<std::string>& paths, const SourceOptions& options)
      : name_(paths.front()), span_(options) {
    if (paths.size() > 1) name_ += "' and " + std::to_string(paths.size() - 1) + " more '";
    for (const std::string& path : paths) openBag(path);
    try {
      open(options);
    } catch (const rosbag::BagException& error) {
      throw brokenOff(name_, error);
    }
  }

  std::optional<SourceImage> next() override {
    try {
      return read();
    } catch (const ros::Exception& error) {  // from rosbag and from deserialisation
      throw SourceError("bag '" + name_ + "' is damaged behind image " + std::to_string(frame_) + " (" + error.what() +
                        "); 'rosbag reindex' may repair it");
    }
  }

  std::size_t size() const override { return size_; }
  double rate() const override { return rate_; }
  bool hasRecordedStamps() const override { return true; }
  std::vector<std::string> notes() const override {
    std::vector<std::string> notes = notes_;
    if (stamps_.replaced() > 0) {
      notes.push_back(std::to_string(stamps_.replaced()) +
                      " images have the stamp 0 or that of the image before: theirs is from the time of recording");
    }
    return notes;
  }

 private:
  void openBag(const std::string& path) {
    checkBeginning(path);
    auto bag = std::make_unique<rosbag::Bag>();
    try {
      bag->open(path, rosbag::bagmode::Read);
    } catch (const rosbag::BagException& error) {  // among them BagUnindexedException, of one that was not closed
      throw brokenOff(path, error);
    }
    bags_.push_back(std::move(bag));
  }

  // The messages of these topics in the order of time.
  std::unique_ptr<rosbag::View> view(const std::vector<std::string>& topics) const {
    auto view = std::make_unique<rosbag::View>();
    for (const auto& bag : bags_) view->addQuery(*bag, rosbag::TopicQuery(topics));
    return view;
  }

  Topics topics() const {
    Topics topics;
    for (const auto& bag : bags_) {
      rosbag::View all(*bag);
      for (const rosbag::ConnectionInfo* connection : all.getConnections())
        topics[connection->topic] = connection->datatype;
    }
    return topics;
  }

  void open(const SourceOptions& options) {
    const Topics topics = this->topics();
    image_topic_ = chooseImageTopic(topics, name_, options.image_topic);
    const auto images = view({image_topic_});
    size_ = images->size();
    const double duration = (images->getEndTime() - images->getBeginTime()).toSec();
    rate_ = size_ > 1 && duration > 0.0 ? static_cast<double>(size_ - 1) / duration : options.folder_rate;
    begin_ = images->getBeginTime();

    std::vector<std::string> read_topics{image_topic_};
    const std::string camera_info_topic = chooseCameraInfoTopic(topics, name_, image_topic_, options.camera_info_topic);
    if (!camera_info_topic.empty()) {
      read_topics.push_back(camera_info_topic);
      // A driver sends camera_info after its image; the first image must have it too.
      const auto infos = view({camera_info_topic});
      if (infos->size() > 0) camera_info_ = infos->begin()->instantiate<sensor_msgs::CameraInfo>();
    } else if (const std::string others = otherCameraInfoTopics(topics); !others.empty()) {
      notes_.push_back("the bag has no " + usualCameraInfoTopic(topics, image_topic_) + ", but " + others +
                       ": one of them can be chosen by camera-info-topic");
    }
    learnStamps(*images);
    view_ = view(read_topics);
    position_ = view_->begin();
  }

  // Images without a stamp at the beginning get theirs from the first that has one.
  void learnStamps(rosbag::View& images) {
    std::size_t looked_at = 0;
    for (const rosbag::MessageInstance& instance : images) {
      const ros::Time stamp = stampOf(instance);
      if (!stamp.isZero()) return stamps_.learn(stamp, instance.getTime());
      if (++looked_at == kMostWithoutStamp) return;
    }
  }

  static ros::Time stampOf(const rosbag::MessageInstance& instance) {
    if (const auto raw = instance.instantiate<sensor_msgs::Image>()) return raw->header.stamp;
    if (const auto compressed = instance.instantiate<sensor_msgs::CompressedImage>()) return compressed->header.stamp;
    return {};
  }

  std::optional<SourceImage> read() {
    for (; position_ != view_->end(); ++position_) {
      const rosbag::MessageInstance& instance = *position_;
      if (instance.getTopic() != image_topic_) {
        if (const auto info = instance.instantiate<sensor_msgs::CameraInfo>()) camera_info_ = info;
        continue;
      }
      const std::size_t frame = frame_++;
      const double time = (instance.getTime() - begin_).toSec();
      if (span_.isSkipped(time)) continue;
      if (span_.isBehind(time)) break;
      SourceImage image = imageOf(instance);
      image.frame = frame;
      image.record_time = instance.getTime();
      image.camera_info.swap(camera_info_);
      if (image.error.empty()) stampUsably(image);
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

  void stampUsably(SourceImage& image) {
    const ros::Time stamp = stamps_.of(image.header.stamp, image.record_time);
    if (stamp == image.header.stamp) return;
    image.header.stamp = stamp;
    if (!image.message) return;
    const auto restamped = boost::make_shared<sensor_msgs::Image>(*image.message);
    restamped->header.stamp = stamp;
    image.message = restamped;
  }

  std::string name_;
  std::vector<std::unique_ptr<rosbag::Bag>> bags_;
  std::string image_topic_;
  std::size_t size_ = 0;
  double rate_ = 0.0;
  ros::Time begin_;
  ImageSpan span_;
  std::unique_ptr<rosbag::View> view_;
  rosbag::View::iterator position_;
  std::size_t frame_ = 0;
  sensor_msgs::CameraInfoConstPtr camera_info_;  // newest one that is not passed on yet
  UsableStamps stamps_;
  std::vector<std::string> notes_;
};

}  // namespace

std::unique_ptr<ImageSource> openBagSource(const std::vector<std::string>& paths, const SourceOptions& options) {
  return std::make_unique<BagSource>(paths, options);
}

}  // namespace laparoscope_servo
