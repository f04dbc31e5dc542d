#include "laparoscope_servo/tracking/tracker_config.h"

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::tracking {

namespace {

using parameters::Table;

void describe(Table& table, OcclusionConfig& c) {
  // "none" rather than "off", which YAML takes for a boolean.
  table.choice("colour", c.colour, {"none", "published", "normalised"},
               "gate before ESM: none, S0 cos H of the paper, or that divided by the intensity, which bears changes of "
               "brightness");
  table.number("rows", c.rows, {2, 64}, "areas", "the region is divided into as many down its height");
  table.number("columns", c.columns, {2, 64}, "areas", "the region is divided into as many across its width");
  table.number("bins", c.bins, {4, 256}, "bins", "an area's histogram has as many");
  table
      .number("threshold", c.threshold, {0, 1}, "Bhattacharyya distance",
              "an area further from its reference is occluded")
      .whileRunning();
  table.flag("structure", c.structure,
             "after alignment, areas that do not correlate with the reference are occluded, too");
  table.number("hold", c.hold, {0, 100}, "images",
               "for which an area stays occluded after it failed the structure gate");
}

void describe(Table& table, EsmConfig& c) {
  table.number("levels", c.levels, {1, 6}, "levels", "the pyramid has as many, each half as fine as the one before");
  table.number("max_iterations", c.max_iterations, {1, 100}, "iterations", "a level of the pyramid takes no more");
  table.number("min_step", c.min_step, {0.0001, 1}, "px", "converged when no corner is expected to move further");
  table.choice(
      "light", c.light, {"constant", "global", "local"},
      "how the light may differ from the reference's: not at all, by a gain and a bias, by a gain and a bias for "
      "each block of 16 px or more");
  table.flag("robust", c.robust, "residuals are weighted by Tukey's function");
  table.number("saturation", c.saturation, {1, 256}, "grey levels",
               "a pixel at least this bright in a tracked colour has weight 0; 256 turns that off");
  table.choice("channels", c.channels, {"luma", "strongest", "colour"},
               "the tracked channels: luma, the mixture that varies most across the region, or all three, which is "
               "three times the work");
}

void describe(Table& table, QualityConfig& c) {
  table
      .number("min_zncc", c.min_zncc, {0, 1}, "correlation",
              "least correlation over the pixels used; the limit is higher for a region that correlated better before")
      .whileRunning();
  table
      .number("min_visible_fraction", c.min_visible_fraction, {0, 1}, "share",
              "of the region's pixels that must be used")
      .whileRunning();
  table
      .number("min_return_fraction", c.min_return_fraction, {0, 1}, "share",
              "of the region's pixels that have to be used before it is believed again after a loss")
      .whileRunning();
  table
      .number("max_corner_error", c.max_corner_error, {0.01, 100}, "px",
              "expected standard deviation of the worst corner; not tested if block matching recognises the region")
      .whileRunning();
  table.number("max_centre_error", c.max_centre_error, {0.01, 100}, "px", "expected standard deviation of the centre")
      .whileRunning();
  table
      .number("max_area_ratio", c.max_area_ratio, {1.01, 1000}, "ratio",
              "the region's area over that in the reference, or its inverse")
      .whileRunning();
  table
      .number("max_jump", c.max_jump, {0.01, 10}, "region diagonals",
              "allowed distance of a corner from its prediction; less if little is visible")
      .whileRunning();
  table.number("max_search_time", c.max_search_time, {0, 3600}, "s", "the state is LOST after SEARCHING for longer")
      .whileRunning();
  table
      .number(
          "confirmations", c.confirmations, {1, 100}, "images",
          "number, each at most 0.2 s after the one before, that must pass every test after a loss, before the state "
          "is TRACKING again")
      .whileRunning();
}

void describe(Table& table, SearchConfig& c) {
  table.flag("features", c.features, "a lost region is looked for by points matched with keyframes");
  table.flag("correlation", c.correlation, "a lost region is looked for by sliding it over a coarse image");
  table.number("max_features", c.max_features, {50, 5000}, "points",
               "detected in an image; half as many in a keyframe");
  table.number("max_pixels", c.max_pixels, {10000, 10000000}, "px",
               "an image with more is scaled down before points are detected");
  table
      .number("max_ratio", c.max_ratio, {0.1, 1}, "ratio",
              "distance of a point's best match over that of its second best")
      .whileRunning();
  table.number("min_inliers", c.min_inliers, {4, 1000}, "matches", "least number that agree on a place").whileRunning();
  table.number("keyframes", c.keyframes, {0, 64}, "views",
               "keyframes kept beside the reference for scales and tilts that it does not show; they only give places "
               "to start from");
  table
      .number("min_detail", c.min_detail, {0, 1}, "correlation",
              "least correlation of the fine structure where a search found the region")
      .whileRunning();
  table
      .number("budget", c.budget, {0.001, 10}, "s",
              "of an image for the search, by nominal costs; the rest of the search goes on in the next image")
      .whileRunning();
}

}  // namespace

void describe(Table& table, TrackerConfig& c) {
  table.number("velocity_damping", c.velocity_damping, {0, 1}, "share", "of the last motion that is expected to go on")
      .whileRunning();
  table.number("min_roi_side", c.min_roi_side, {8, 1000}, "px", "smaller regions are refused");
  table.number("min_texture", c.min_texture, {0.01, 10}, "px",
               "a region is refused if noise of 2 grey levels moves a corner by more");
  table.group("occlusion", "which areas of the region are covered", [&] { describe(table, c.occlusion); });
  table.group("esm", "the alignment of the region with the reference", [&] { describe(table, c.esm); });
  table.group("quality", "limits of the acceptance tests of an estimate", [&] { describe(table, c.quality); });
  table.group("search", "how a lost region is searched", [&] { describe(table, c.search); });
}

std::vector<std::string> validate(const TrackerConfig& config) {
  return parameters::errorsOf(config);
}

}  // namespace laparoscope_servo::tracking
