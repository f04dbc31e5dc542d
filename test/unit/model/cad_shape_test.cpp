// Normals, chains of lines, and whether a model is convex.
#include "model/cad_shape.h"

#include <gtest/gtest.h>

#include "support/synthetic_model.h"

namespace laparoscope_servo::model {
namespace {

TEST(CadShape, aFacesNormalPointsToWhereItsPointsGoRoundCounterClockwise) {
  const std::vector<Eigen::Vector3d> points{{0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {0, 1, 2}};
  Face face;
  face.points = {0, 1, 2, 3};
  EXPECT_EQ(completeFace(points, face), "");
  EXPECT_TRUE(face.normal.isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(face.centre.isApprox(Eigen::Vector3d(0.5, 0.5, 2.0)));
  face.points = {3, 2, 1, 0};
  EXPECT_EQ(completeFace(points, face), "");
  EXPECT_TRUE(face.normal.isApprox(-Eigen::Vector3d::UnitZ()));
}

TEST(CadShape, aChainGoesRoundWhicheverWayItsLinesPoint) {
  EXPECT_EQ(chain({{0, 1}, {1, 2}, {2, 0}}), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(chain({{1, 0}, {1, 2}, {0, 2}}), (std::vector<int>{0, 1, 2}));
  EXPECT_TRUE(chain({{0, 1}, {2, 3}, {3, 0}}).empty());  // they do not join
  EXPECT_TRUE(chain({{0, 1}, {1, 2}, {2, 3}}).empty());  // it does not close
  EXPECT_TRUE(chain({{0, 1}, {1, 0}}).empty());
}

TEST(CadShape, onlyAClosedBodyWithoutDentsIsConvex) {
  EXPECT_TRUE(test::modelOf(test::kCube)->convex);
  std::string open = test::kCube;
  open.replace(open.find("6\n4 0 4 5 1\n"), 12, "5\n");  // without one face
  EXPECT_FALSE(test::modelOf(open)->convex);
  // A roof turned inwards: the apex lies below the square's plane.
  const std::string dent =
      "V1\n9\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n.5 .5 .6\n0\n0\n9\n"
      "4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n4 3 2 1 0\n3 4 5 8\n3 5 6 8\n3 6 7 8\n3 7 4 8\n0\n0\n";
  EXPECT_FALSE(test::modelOf(dent)->convex);
}

}  // namespace
}  // namespace laparoscope_servo::model
