// The kinds of image sources, for image_source.cpp alone.
#pragma once

#include <memory>
#include <string>

#include "laparoscope_servo/ros/image_source.h"

namespace laparoscope_servo::skin {

std::unique_ptr<ImageSource> openBagSource(const std::string& path, const SourceOptions& options);
std::unique_ptr<ImageSource> openVideoSource(const std::string& path, const SourceOptions& options);
std::unique_ptr<ImageSource> openFolderSource(const std::string& path, const SourceOptions& options);

}  // namespace laparoscope_servo::skin
