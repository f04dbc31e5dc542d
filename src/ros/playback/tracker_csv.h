// The CSV table of the offline tool: a header line and one line per image.
#pragma once

#include <cstddef>
#include <ostream>

#include "ros/tracker/tracker_session.h"

namespace laparoscope_servo {

// frame,stamp,state,g00,g01,g02,g10,g11,g12,g20,g21,g22,visible_fraction,zncc,iterations,processing_time,
// corner_error,centre_error,gain,bias,reason
void writeCsvHeader(std::ostream& stream);

// `frame` counts from 0; stamp and processing_time in s, errors in px (inf when unknown), bias in grey levels, the
// state as in Homography.msg, g with determinant 1, the reason in quotes. Numbers have 17 digits, so that they read
// back as the same doubles.
void writeCsvRow(std::ostream& stream, std::size_t frame, const Processed& processed);

}  // namespace laparoscope_servo
