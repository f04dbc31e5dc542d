#include "ros/playback/tracker_csv.h"

#include <cstdio>
#include <string>

namespace laparoscope_servo {

namespace {

std::string exact(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.17g", value);
  return text;
}

// Quoted by RFC 4180, so that a comma or a quote in the text does not end the field.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

}  // namespace

void writeCsvHeader(std::ostream& stream) {
  stream << "frame,stamp,state,g00,g01,g02,g10,g11,g12,g20,g21,g22,visible_fraction,zncc,iterations,processing_time"
            ",corner_error,centre_error,gain,bias,reason\n";
}

void writeCsvRow(std::ostream& stream, std::size_t frame, const Processed& processed) {
  const tracking::TrackResult& result = processed.result;
  stream << frame << ',' << exact(processed.header.stamp.toSec()) << ',' << static_cast<int>(result.state);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) stream << ',' << exact(result.g(row, column));
  }
  stream << ',' << exact(result.visible_fraction) << ',' << exact(result.zncc) << ',' << result.iterations << ','
         << exact(processed.processing_time) << ',' << exact(result.corner_error) << ',' << exact(result.centre_error)
         << ',' << exact(result.gain) << ',' << exact(result.bias) << ',' << quoted(result.reason) << '\n';
}

}  // namespace laparoscope_servo
