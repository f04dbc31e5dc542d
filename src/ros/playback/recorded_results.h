// What the tracker had said when a case was recorded, found to the images of its bag.
#pragma once

#include <laparoscope_servo/Homography.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <deque>
#include <memory>
#include <string>
#include <vector>

namespace laparoscope_servo {

class RecordedResults {
 public:
  // `paths`: as of the image source; what are no bags have none, nor have bags that cannot be read, for the images'
  // source says so. `image_topic`: of the tracker that is meant where there were several; may be empty.
  RecordedResults(const std::vector<std::string>& paths, const std::string& image_topic);

  bool any() const { return !topic_.empty(); }
  const std::string& topic() const { return topic_; }
  // That of the image with this stamp, recorded at this time of the bag; null when there is none. Images may come in
  // any order, but it is meant for one after the other.
  HomographyConstPtr at(const ros::Time& stamp, const ros::Time& record_time);

 private:
  void choose(const std::string& image_topic);
  void open(const ros::Time& from);
  void readUntil(const ros::Time& until);

  std::vector<std::unique_ptr<rosbag::Bag>> bags_;
  std::string topic_;
  std::unique_ptr<rosbag::View> view_;
  rosbag::View::iterator position_;
  ros::Time read_until_;  // of the bag
  std::deque<HomographyConstPtr> window_;
};

}  // namespace laparoscope_servo
