#include "laparoscope_servo/image/area_grid.h"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>
#include <vector>

namespace laparoscope_servo::image {
namespace {

TEST(AreaGrid, CoversEveryPixelOnceWithAreasOfNearlyEqualSize) {
  for (const auto& [width, height, rows, columns] : std::vector<std::array<int, 4>>{
           {196, 196, 14, 14}, {100, 37, 14, 14}, {14, 14, 14, 14}, {15, 200, 1, 7}, {1, 1, 1, 1}}) {
    const AreaGrid grid(width, height, rows, columns);
    std::vector<int> counted(grid.count(), 0);
    for (int j = 0; j < height; ++j) {
      for (int i = 0; i < width; ++i) {
        const int area = grid.areaOf(i, j);
        ASSERT_GE(area, 0);
        ASSERT_LT(area, grid.count());
        ++counted[area];
        EXPECT_GE(i, grid.columnBegin(grid.columnOf(i)));
        EXPECT_LT(i, grid.columnBegin(grid.columnOf(i) + 1));
        EXPECT_GE(j, grid.rowBegin(grid.rowOf(j)));
        EXPECT_LT(j, grid.rowBegin(grid.rowOf(j) + 1));
      }
    }
    int total = 0;
    for (int area = 0; area < grid.count(); ++area) {
      EXPECT_EQ(counted[area], grid.pixelsIn(area));
      EXPECT_GE(counted[area], (width / columns) * (height / rows));
      EXPECT_LE(counted[area], (width / columns + 1) * (height / rows + 1));
      total += counted[area];
    }
    EXPECT_EQ(total, width * height);
  }
}

TEST(AreaGrid, NumbersAreasRowByRow) {
  const AreaGrid grid(20, 10, 2, 4);
  EXPECT_EQ(grid.areaOf(0, 0), 0);
  EXPECT_EQ(grid.areaOf(19, 0), 3);
  EXPECT_EQ(grid.areaOf(0, 9), 4);
  EXPECT_EQ(grid.areaOf(19, 9), 7);
}

TEST(AreaGrid, RefusesMoreAreasThanPixels) {
  EXPECT_THROW(AreaGrid(10, 10, 11, 2), std::invalid_argument);
  EXPECT_THROW(AreaGrid(10, 10, 2, 11), std::invalid_argument);
  EXPECT_THROW(AreaGrid(10, 10, 0, 2), std::invalid_argument);
  EXPECT_THROW(AreaGrid(0, 10, 1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace laparoscope_servo::image
