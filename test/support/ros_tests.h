// The body of main() of a test that waits for messages, which other threads take in.
#pragma once

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <string>

namespace laparoscope_servo::test_support {

inline int runTests(int argc, char** argv, const std::string& node, unsigned threads = 2) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, node);
  const ros::NodeHandle keep_alive;
  ros::AsyncSpinner spinner(threads);
  spinner.start();
  const int result = RUN_ALL_TESTS();
  ros::shutdown();
  return result;
}

}  // namespace laparoscope_servo::test_support
