#include "ros/playback/recorded_results.h"

#include <ros/message_traits.h>

#include <algorithm>
#include <cstddef>
#include <set>

namespace laparoscope_servo {

namespace {

// s of the bag about an image in which its result is looked for: an encoder of images and the tracker may each be late.
const ros::Duration kAround(2.0);
const ros::Duration kJump(10.0);  // s: further on than this it is read from there
constexpr std::size_t kMostKept = 1000;

std::size_t commonLetters(const std::string& a, const std::string& b) {
  const std::size_t length = std::min(a.size(), b.size());
  return static_cast<std::size_t>(
      std::mismatch(a.begin(), a.begin() + static_cast<std::ptrdiff_t>(length), b.begin()).first - a.begin());
}

ros::Time before(const ros::Time& time) {
  return time.toSec() > kAround.toSec() ? time - kAround : ros::TIME_MIN;
}

}  // namespace

RecordedResults::RecordedResults(const std::vector<std::string>& paths, const std::string& image_topic) {
  try {
    for (const std::string& path : paths) {
      auto bag = std::make_unique<rosbag::Bag>();
      bag->open(path, rosbag::bagmode::Read);
      bags_.push_back(std::move(bag));
    }
    choose(image_topic);
  } catch (const rosbag::BagException&) {
    topic_.clear();
  }
}

// Chooses the topic whose name shares the most letters at its beginning with that of the images; none if two share as
// many.
void RecordedResults::choose(const std::string& image_topic) {
  std::set<std::string> topics;
  for (const auto& bag : bags_) {
    rosbag::View all(*bag);
    for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
      if (connection->datatype == ros::message_traits::datatype<Homography>()) topics.insert(connection->topic);
    }
  }
  const std::string images = image_topic.empty() || image_topic[0] == '/' ? image_topic : '/' + image_topic;
  std::size_t best = 0;
  bool several = false;
  for (const std::string& topic : topics) {
    const std::size_t likeness = commonLetters(topic, images);
    if (likeness < best) continue;
    several = likeness == best && !topic_.empty();
    topic_ = topic;
    best = likeness;
  }
  if (several) topic_.clear();
}

void RecordedResults::open(const ros::Time& from) {
  window_.clear();
  view_ = std::make_unique<rosbag::View>();
  for (const auto& bag : bags_) view_->addQuery(*bag, rosbag::TopicQuery(topic_), from);
  position_ = view_->begin();
  read_until_ = from;
}

void RecordedResults::readUntil(const ros::Time& until) {
  for (; position_ != view_->end() && position_->getTime() <= until; ++position_) {
    if (const HomographyConstPtr result = position_->instantiate<Homography>()) window_.push_back(result);
    if (window_.size() > kMostKept) window_.pop_front();
  }
  read_until_ = std::max(read_until_, until);
}

HomographyConstPtr RecordedResults::at(const ros::Time& stamp, const ros::Time& record_time) {
  if (!any()) return nullptr;
  try {
    if (!view_ || record_time + kAround < read_until_ || record_time > read_until_ + kJump) open(before(record_time));
    readUntil(record_time + kAround);
  } catch (const ros::Exception&) {  // a damaged bag: the images' source says so
    view_.reset();
    return nullptr;
  }
  for (auto result = window_.rbegin(); result != window_.rend(); ++result) {
    if ((*result)->header.stamp == stamp) return *result;
  }
  return nullptr;
}

}  // namespace laparoscope_servo
