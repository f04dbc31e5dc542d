// What the stand-in for tracker, robot and dead-man switch says, and a task error to begin with.
#pragma once

#include <laparoscope_servo/TaskError.h>
#include <ros/time.h>

#include <cmath>
#include <cstdint>
#include <string>

namespace laparoscope_servo {

// What is published; a test changes it through FakeCart::set.
struct Feed {
  bool task_error = true;
  bool tf = true;
  bool robot = true;
  bool dead_man = true;
  bool pressed = true;
  bool images_stop = false;      // the tracker goes on, over images that are hardly newer each time
  double stamp_offset = 0.0;     // s, added to the stamps of task errors
  bool without_stamp = false;    // task errors have none
  ros::Time fixed_stamp;         // not zero: every task error has this stamp
  double tf_stamp_offset = 0.0;  // s
  double d2 = 0.1;               // m
  double lateral = 0.0;          // m
  double optics = 0.0;           // rad, of the camera on the scope, about its x axis
  std::string robot_state = "ENABLED";
  std::uint32_t enables = 1;
  double robot_stamp_offset = 0.0;  // s
  TaskError message;
};

inline TaskError offTarget() {
  TaskError message;
  message.valid = true;
  message.e_v.x = 0.2;
  message.e_v.y = -0.1;
  message.e_v.z = 0.1;
  message.e_w.z = -0.1;
  message.x = 0.2 / 1.1;
  message.y = -0.1 / 1.1;
  message.log_depth = std::log(1.1);
  message.alpha = -0.05;
  message.m_star.z = 1.0;
  message.visible_fraction = 1.0;
  message.corner_error = 0.1;
  return message;
}

}  // namespace laparoscope_servo
