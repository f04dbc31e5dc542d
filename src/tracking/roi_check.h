// What an image and a region of interest (ROI) must be, to be tracked.
#pragma once

#include <opencv2/core.hpp>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/image/field_mask.h"
#include "laparoscope_servo/image/lens.h"
#include "laparoscope_servo/tracking/tracker_config.h"
#include "tracking/align/region_aligner.h"
#include "tracking/selection/selection_mask.h"

namespace laparoscope_servo::tracking {

// Throws std::invalid_argument for an image that is empty, or of another type than CV_8UC1 and CV_8UC3.
void checkImage(const cv::Mat& image);

// The ROI in whole pixels. Throws std::invalid_argument when a side is below `min_side` [px], or a part of it is not in
// the image. With a lens (null: none) the image is raw, and the ROI in rectified pixels.
geometry::Rectangle checkedRoi(const cv::Mat& image, const geometry::Rectangle& roi, int min_side,
                               const image::Lens* lens);

// Throws std::invalid_argument when most of the ROI shows nothing, since it lies beyond the endoscope's field of view.
void checkWithinField(const geometry::Rectangle& roi, const image::FieldMask& field, const image::Lens* lens);

// Throws std::invalid_argument when most of the ROI is not 0 in `instruments`, which is of the image's size, or empty:
// the ROI would follow an instrument.
void checkClearOfInstruments(const geometry::Rectangle& roi, const cv::Mat& instruments, const image::Lens* lens);

// px, the corner error that noise causes in the aligner's reference, see ReferenceTexture. Throws std::invalid_argument
// when it is more than `max_error`: the ROI has too little texture.
double checkedCornerError(RegionAligner& aligner, double max_error);

// Throws std::invalid_argument when the ROI has room for blocks, see BlockMatching, but too few of them have unique
// texture: block matching could then not contradict a wrong estimate.
void checkTellingBlocks(const RegionAligner& aligner);

// All of these checks: makes the ROI the reference of `aligner`, whose configuration and lens (null: none) are those
// that are given, and returns its corner error. Throws std::invalid_argument as they do; the aligner's reference is
// then not to be used. `selectable` is of this image.
double takeReference(const cv::Mat& image, const geometry::Rectangle& wanted, const SelectionMask& selectable,
                     const TrackerConfig& config, const image::Lens* lens, RegionAligner& aligner);
// `mask`: see RegionTracker::select.
double takeReference(const cv::Mat& image, const geometry::Rectangle& wanted, const cv::Mat& mask,
                     const TrackerConfig& config, const image::Lens* lens, RegionAligner& aligner);

}  // namespace laparoscope_servo::tracking
