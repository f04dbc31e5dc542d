#include "ros/playback/tracker_csv.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace laparoscope_servo {
namespace {

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> result;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) result.push_back(field);
  return result;
}

TEST(TrackerCsv, HasTheColumnsThatOthersRelyOn) {
  std::ostringstream stream;
  writeCsvHeader(stream);
  EXPECT_EQ(stream.str(),
            "frame,stamp,state,g00,g01,g02,g10,g11,g12,g20,g21,g22,visible_fraction,zncc,iterations,processing_time"
            ",corner_error,centre_error,gain,bias,reason\n");
}

TEST(TrackerCsv, ReadsBackAsTheSameNumbers) {
  Processed processed;
  processed.header.stamp = ros::Time(1600000000, 123456789);
  processed.result.state = tracking::State::kSearching;
  for (int k = 0; k < 9; ++k) processed.result.g(k / 3, k % 3) = std::pow(-1.0 / 3.0, k + 1);
  processed.result.visible_fraction = 0.1;
  processed.result.zncc = -1.0 / 7.0;
  processed.result.iterations = 17;
  processed.processing_time = 1e-3 / 3.0;
  processed.result.corner_error = std::numeric_limits<double>::infinity();
  processed.result.centre_error = 2.0 / 3.0;
  processed.result.gain = 1.1;
  processed.result.bias = -3.0 / 7.0;
  processed.result.reason = "found";
  std::ostringstream stream;
  writeCsvRow(stream, 42, processed);
  ASSERT_EQ(stream.str().back(), '\n');
  const std::vector<std::string> row = fields(stream.str());
  ASSERT_EQ(row.size(), 21u);
  const auto number = [&row](std::size_t column) { return std::strtod(row[column].c_str(), nullptr); };
  EXPECT_EQ(row[0], "42");
  EXPECT_EQ(number(1), processed.header.stamp.toSec());
  EXPECT_EQ(row[2], "2");
  for (int k = 0; k < 9; ++k) EXPECT_EQ(number(3 + static_cast<std::size_t>(k)), processed.result.g(k / 3, k % 3));
  EXPECT_EQ(number(12), 0.1);
  EXPECT_EQ(number(13), -1.0 / 7.0);
  EXPECT_EQ(row[14], "17");
  EXPECT_EQ(number(15), 1e-3 / 3.0);
  EXPECT_EQ(number(16), std::numeric_limits<double>::infinity());
  EXPECT_EQ(number(17), 2.0 / 3.0);
  EXPECT_EQ(number(18), 1.1);
  EXPECT_EQ(number(19), -3.0 / 7.0);
  EXPECT_EQ(row[20], "\"found\"\n");
}

TEST(TrackerCsv, AReasonIsOneFieldWhateverIsInIt) {
  Processed processed;
  processed.result.reason = "correlation 0.4, expected at least 0.5 (\"why\")";
  std::ostringstream stream;
  writeCsvRow(stream, 0, processed);
  EXPECT_NE(stream.str().find(",\"correlation 0.4, expected at least 0.5 (\"\"why\"\")\"\n"), std::string::npos)
      << stream.str();
}

}  // namespace
}  // namespace laparoscope_servo
