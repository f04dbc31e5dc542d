# Functions that keep the CMake files of the parts to a line per executable or test.

# laparoscope_servo_executable(NAME SOURCE...): rosrun laparoscope_servo NAME
function(laparoscope_servo_executable name)
  set(target ${PROJECT_NAME}_${name})
  add_executable(${target} ${ARGN})
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

# laparoscope_servo_unit_test(NAME SOURCE...): a GoogleTest without a master, linked to the core alone
function(laparoscope_servo_unit_test name)
  catkin_add_gtest(test_${name} ${ARGN})
  if(TARGET test_${name})
    target_link_libraries(test_${name} ${PROJECT_NAME}_core ${LAPAROSCOPE_SERVO_GTEST_MAIN})
  endif()
endfunction()

# laparoscope_servo_skin_test(NAME SOURCE...): a GoogleTest without a master, linked to the ROS skin
function(laparoscope_servo_skin_test name)
  catkin_add_gtest(test_${name} ${ARGN})
  if(TARGET test_${name})
    target_link_libraries(test_${name} ${PROJECT_NAME}_ros ${LAPAROSCOPE_SERVO_GTEST_MAIN})
    add_dependencies(test_${name} ${PROJECT_NAME}_generate_messages_cpp ${catkin_EXPORTED_TARGETS})
  endif()
endfunction()

# laparoscope_servo_rostest(NAME SOURCE...): NAME.test beside the sources, run by rostest under a master of its own
function(laparoscope_servo_rostest name)
  add_rostest_gtest(test_${name} ${CMAKE_CURRENT_SOURCE_DIR}/${name}.test ${ARGN})
  if(TARGET test_${name})
    target_link_libraries(test_${name} ${PROJECT_NAME}_ros)
    add_dependencies(test_${name} ${PROJECT_NAME}_generate_messages_cpp ${catkin_EXPORTED_TARGETS})
  endif()
endfunction()
