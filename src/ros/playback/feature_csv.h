// The CSV table of the offline tool with a tracker of features: a header line, and a line per image and feature.
#pragma once

#include <cstddef>
#include <ostream>

#include "ros/features/feature_session.h"

namespace laparoscope_servo {

// frame,stamp,state,processing_time,id,kind,feature_state,share,expected_error,parameters,deviations,outline,reason
void writeFeatureCsvHeader(std::ostream& stream);

// `frame` counts from 0; stamp and processing_time in s; states as in TrackedFeatures.msg, the first that of all; id
// and reason in quotes; kind in words; parameters by kind as in TrackedFeature.msg, their standard deviations, and
// outline (u v u v ..., px) as numbers with spaces between them. Numbers have 17 digits. An image without features has
// one line, in which id and what follows are empty but for the reason.
void writeFeatureCsvRows(std::ostream& stream, std::size_t frame, const ProcessedFeatures& processed);

}  // namespace laparoscope_servo
