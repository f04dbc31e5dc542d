#include "ros/playback/tracker_csv.h"

#include <string>

#include "ros/playback/csv_text.h"

namespace laparoscope_servo {

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
