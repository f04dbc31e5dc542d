// The options that say which images are tracked, and how: of the tools track_bag and select_region.
#pragma once

#include <XmlRpcValue.h>

#include <boost/program_options/options_description.hpp>
#include <string>
#include <vector>

#include "ros/playback/tracker_offline.h"

namespace laparoscope_servo {

// Into `options`; `parameters`: the file that is laid over the package's.
void describeInput(boost::program_options::options_description& description, OfflineOptions& options,
                   std::string& parameters);

// The same as they stand on a command line, for another tool that reads them.
std::vector<std::string> inputArguments(const OfflineOptions& options, const std::string& parameters);

// The package's parameters of this name, e.g. tracker.yaml, with those of `file` laid over them; empty: none. Throws
// std::runtime_error for a file that cannot be read.
XmlRpc::XmlRpcValue readOfflineTree(const std::string& name, const std::string& file);

// The package's parameters of the region tracker, as the launch files load them, then those of `file`; empty: none.
// Throws std::runtime_error with everything that is wrong.
TrackerParameters readOfflineParameters(const std::string& file);

}  // namespace laparoscope_servo
