#include <gtest/gtest.h>

#include "laparoscope_servo/tracking/contour_texture.h"
#include "support/config_check.h"

namespace laparoscope_servo::tracking {
namespace {

using Config = ContourTextureConfig;

TEST(ContourTextureConfig, TheDefaultsAreValid) {
  EXPECT_TRUE(validate(Config()).empty());
}

TEST(ContourTextureConfig, ParametersAreTheFieldsOfTheirNames) {
  Config config;
  parameters::Table table;
  describe(table, config);
  EXPECT_EQ(table.find("min_block_share")->take(0.9), "");
  EXPECT_EQ(config.min_block_share, 0.9);
  EXPECT_EQ(table.find("min_correlation")->take(0.95), "");
  EXPECT_EQ(config.min_correlation, 0.95);
  EXPECT_EQ(table.find("max_corner_error")->take(7.0), "");
  EXPECT_EQ(config.max_corner_error, 7.0);
  EXPECT_EQ(table.find("edges/max_error")->take(6.0), "");
  EXPECT_EQ(config.edges.max_error, 6.0);
  EXPECT_EQ(config.min_block_share, 0.9) << "each by itself";
  EXPECT_EQ(config.max_corner_error, 7.0);
}

// Either may be left out, but not both: nothing would be minimised.
TEST(ContourTextureConfig, OneOfTextureAndContourHasToCount) {
  for (const bool texture : {true, false}) {
    for (const bool contour : {true, false}) {
      Config config;
      config.texture = texture;
      config.contour = contour;
      EXPECT_EQ(validate(config).empty(), texture || contour) << texture << contour;
    }
  }
  Config neither;
  neither.texture = neither.contour = false;
  EXPECT_EQ(validate(neither).at(0), "contour = false beside texture = false, expected one of them true");
  EXPECT_THROW(ContourTextureTracker{neither}, std::invalid_argument);
}

TEST(ContourTextureConfig, EachErrorNamesItsField) {
  Config config;
  config.min_block_share = 0.0;
  config.min_correlation = std::nan("");
  config.max_corner_error = -1.0;
  config.edges.spacing = 0.0;
  const std::vector<std::string> errors = validate(config);
  EXPECT_EQ(errors.size(), 4u);
  for (const char* const name : {"min_block_share", "min_correlation", "max_corner_error", "edges/spacing"})
    EXPECT_TRUE(test_support::names(errors, name)) << name;
}

}  // namespace
}  // namespace laparoscope_servo::tracking
