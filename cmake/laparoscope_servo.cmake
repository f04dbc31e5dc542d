# Functions that keep the CMake files of the parts to a line per executable or test.

# Reading these again for each source is most of what compiling takes. Sources include what they use all the same;
# -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON shows whether they do.
set(LAPAROSCOPE_SERVO_CORE_HEADERS
  <algorithm> <array> <chrono> <cmath> <deque> <functional> <limits> <map> <memory> <optional> <sstream> <stdexcept>
  <string> <vector> <Eigen/Dense> <opencv2/core.hpp> <opencv2/imgproc.hpp>)
set(LAPAROSCOPE_SERVO_ROS_HEADERS ${LAPAROSCOPE_SERVO_CORE_HEADERS}
  <diagnostic_updater/diagnostic_updater.h> <ros/ros.h> <sensor_msgs/CameraInfo.h> <sensor_msgs/Image.h>
  <std_srvs/Trigger.h> <tf2_ros/transform_listener.h>)

# laparoscope_servo_sources(LIBRARY SOURCE...): of the folder that calls it, into the library core or ros
function(laparoscope_servo_sources library)
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  target_sources(${PROJECT_NAME}_${library} PRIVATE ${ARGN})
endfunction()

# laparoscope_servo_executable(NAME SOURCE...): rosrun laparoscope_servo NAME; keeps to the loopback address (src/loopback)
function(laparoscope_servo_executable name)
  set(target ${PROJECT_NAME}_${name})
  add_executable(${target} ${ARGN} $<TARGET_OBJECTS:${PROJECT_NAME}_xmlrpc_bind>)
  set_property(GLOBAL APPEND PROPERTY LAPAROSCOPE_SERVO_PROGRAMS ${target})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${name} PREFIX "")
  target_link_libraries(${target} ${PROJECT_NAME}_ros)
  add_dependencies(${target} ${PROJECT_NAME}_generate_messages_cpp ${catkin_EXPORTED_TARGETS})
  install(TARGETS ${target} RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
endfunction()

# GoogleTest's main: an imported target where CMake finds GoogleTest installed (Debian 12), one of the build where catkin
# compiles its sources (Noetic).
if(TARGET GTest::gtest_main)
  set(LAPAROSCOPE_SERVO_GTEST_MAIN GTest::gtest_main)
else()
  set(LAPAROSCOPE_SERVO_GTEST_MAIN gtest_main)
endif()

# A program that is never built holds what the tests precompile: of the core's, and of the ROS part's.
function(laparoscope_servo_test_headers)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/test_headers.cpp)
  if(NOT EXISTS ${source})
    file(WRITE ${source} "int main() {}\n")
  endif()
  add_executable(test_headers_core EXCLUDE_FROM_ALL ${source})
  target_link_libraries(test_headers_core ${PROJECT_NAME}_core ${LAPAROSCOPE_SERVO_GTEST_MAIN})
  target_precompile_headers(test_headers_core PRIVATE ${LAPAROSCOPE_SERVO_CORE_HEADERS} <random> <gtest/gtest.h>)
  add_executable(test_headers_ros EXCLUDE_FROM_ALL ${source})
  target_link_libraries(test_headers_ros ${PROJECT_NAME}_ros ${LAPAROSCOPE_SERVO_GTEST_MAIN})
  target_precompile_headers(test_headers_ros PRIVATE ${LAPAROSCOPE_SERVO_ROS_HEADERS} <random> <gtest/gtest.h>)
endfunction()

# What the kinds of test have in common: KIND of headers, core or ros, and LIBRARIES
function(laparoscope_servo_test_target name kind)
  if(TARGET test_${name})
    target_link_libraries(test_${name} ${ARGN})
    target_precompile_headers(test_${name} REUSE_FROM test_headers_${kind})
    if(kind STREQUAL ros)
      add_dependencies(test_${name} ${PROJECT_NAME}_generate_messages_cpp ${catkin_EXPORTED_TARGETS})
    endif()
  endif()
endfunction()

# laparoscope_servo_core_test(NAME SOURCE...): a GoogleTest without a master, linked to the core alone
function(laparoscope_servo_core_test name)
  catkin_add_gtest(test_${name} ${ARGN})
  laparoscope_servo_test_target(${name} core ${PROJECT_NAME}_core ${LAPAROSCOPE_SERVO_GTEST_MAIN})
endfunction()

# laparoscope_servo_ros_test(NAME SOURCE...): a GoogleTest without a master, linked to the ROS part
function(laparoscope_servo_ros_test name)
  catkin_add_gtest(test_${name} ${ARGN})
  laparoscope_servo_test_target(${name} ros ${PROJECT_NAME}_ros ${LAPAROSCOPE_SERVO_GTEST_MAIN})
endfunction()

# laparoscope_servo_tests(KIND PREFIX FILE...): one for each file, core or ros; FOLDER/NAME_test.cpp is the test PREFIXNAME
function(laparoscope_servo_tests kind prefix)
  foreach(file ${ARGN})
    get_filename_component(name ${file} NAME_WE)
    string(REGEX REPLACE "_test$" "" name ${name})
    if(kind STREQUAL ros)
      laparoscope_servo_ros_test(${prefix}${name} ${file})
    else()
      laparoscope_servo_core_test(${prefix}${name} ${file})
    endif()
  endforeach()
endfunction()

# laparoscope_servo_rostest(NAME SOURCE...): NAME.test beside the sources, run by rostest under a master of its own
function(laparoscope_servo_rostest name)
  add_rostest_gtest(test_${name} ${CMAKE_CURRENT_SOURCE_DIR}/${name}.test ${ARGN})
  laparoscope_servo_test_target(${name} ros ${PROJECT_NAME}_ros)
endfunction()
