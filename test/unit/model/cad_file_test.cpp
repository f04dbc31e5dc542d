// ViSP's format .cao: what is read, and what is said of a file that cannot be.
#include <gtest/gtest.h>

#include "laparoscope_servo/model/cad_model.h"
#include "support/error_text.h"
#include "support/synthetic_model.h"

namespace laparoscope_servo::model {
namespace {

std::string errorOf(const std::string& text) {
  return test_support::errorText<CadFileError>([&] { test::modelOf(text); });
}

// A tetrahedron's points, one to a line from line 3 on.
const std::string kPoints = "V1\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";

TEST(CadFile, readsACube) {
  const auto model = test::modelOf(test::kCube);
  EXPECT_EQ(model->points.size(), 8u);
  EXPECT_EQ(model->faces.size(), 6u);
  EXPECT_EQ(model->edges.size(), 12u);
  for (const Edge& edge : model->edges) EXPECT_EQ(edge.faces.size(), 2u);
  EXPECT_TRUE(model->convex);
  EXPECT_NEAR(model->radius, 0.042 * std::sqrt(3.0), 1e-12);
  EXPECT_TRUE(model->centre.isApprox(Eigen::Vector3d(-0.042, 0.042, 0.042)));
  // Counter-clockwise as seen from outside: the first face is the one at y = 0, seen from -y.
  EXPECT_TRUE(model->faces[0].normal.isApprox(Eigen::Vector3d(0.0, -1.0, 0.0)));
}

TEST(CadFile, readsCylindersAndCircles) {
  const auto model = test::modelOf(test::kCubeAndTube);
  ASSERT_EQ(model->cylinders.size(), 1u);
  EXPECT_EQ(model->cylinders[0].radius, 0.04);
  EXPECT_TRUE(model->cylinders[0].end.isApprox(Eigen::Vector3d(-0.15, -0.03, 0.11)));
  ASSERT_EQ(model->circles.size(), 1u);
  const Circle& circle = model->circles[0];
  EXPECT_NEAR(circle.u.dot(circle.v), 0.0, 1e-12);
  EXPECT_TRUE(circle.u.cross(circle.v).isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_FALSE(model->convex);
}

TEST(CadFile, readsCommentsAndSettingsOfTheLevelOfDetail) {
  const auto model = test::modelOf(
      "# made by hand\nV1 # the version\n4\n0 0 0 # first\n1 0 0\n0 1 0\n0 0 1\n"
      "1\n0 1 name=rim useLod=true minLineLengthThreshold=50\n0\n1\n3 0 2 3 minPolygonAreaThreshold=100\n0\n0\n");
  EXPECT_EQ(model->edges.size(), 4u);
  EXPECT_TRUE(model->edges[0].faces.empty());  // the line alone: a wire
}

TEST(CadFile, makesFacesOfLines) {
  const auto model = test::modelOf(kPoints + "3\n0 1\n2 1\n2 0\n1\n3 0 1 2\n0\n0\n0\n");
  ASSERT_EQ(model->faces.size(), 1u);
  EXPECT_EQ(model->faces[0].points, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(model->edges.size(), 3u);
  EXPECT_TRUE(model->faces[0].normal.isApprox(Eigen::Vector3d::UnitZ()));
}

TEST(CadFile, hasNoEdgeBetweenFacesOfOnePlane) {
  const auto model = test::modelOf("V1\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0\n0\n2\n3 0 1 2\n3 0 2 3\n0\n0\n");
  EXPECT_EQ(model->edges.size(), 4u);
}

TEST(CadFile, errorsNameLineValueAndExpectation) {
  EXPECT_EQ(errorOf(""), "test.cao, line 0: the file ends, expected V1, the version of the format");
  EXPECT_EQ(errorOf("V2\n0\n"), "test.cao, line 1: V2, expected V1, the version of the format");
  EXPECT_EQ(
      errorOf("V1\nload(\"part.cao\")\n"),
      "test.cao, line 2: load(\"part.cao\"), expected the number of points: parts in other files are not supported");
  EXPECT_EQ(errorOf("V1\n1\n0 nan 0\n"), "test.cao, line 3: nan, expected a finite coordinate of point 0, m");
  EXPECT_EQ(errorOf("V1\n1\n0 1e999 0\n"), "test.cao, line 3: 1e999, expected a finite coordinate of point 0, m");
  EXPECT_EQ(errorOf("V1\n1\n0 0.1x 0\n"), "test.cao, line 3: 0.1x, expected a finite coordinate of point 0, m");
  EXPECT_EQ(errorOf("V1\n1\n0 -1e200 0\n"), "test.cao, line 3: -1e200, expected a coordinate of point 0 below 1000 m");
  EXPECT_EQ(errorOf(kPoints + "0\n0\n1\n3 0 1 4\n0\n0\n"),
            "test.cao, line 10: 4, expected the index of a point of the face, a whole number from 0 to 3");
  EXPECT_EQ(errorOf(kPoints + "1\n0 -1\n0\n0\n0\n0\n"),
            "test.cao, line 8: -1, expected the index of a point of the line, a whole number from 0 to 3");
  EXPECT_EQ(errorOf(kPoints + "1\n1 1\n0\n0\n0\n0\n"),
            "test.cao, line 8: a line without length, expected two different points");
  EXPECT_EQ(errorOf(kPoints + "0\n0\n0\n1\n0 1 0\n0\n"),
            "test.cao, line 11: 0, expected a radius of the cylinder above 0 m");
  EXPECT_EQ(errorOf(kPoints + "0\n0\n0\n1\n0 1 1e200\n0\n"),
            "test.cao, line 11: 1e200, expected a radius of the cylinder below 1000 m");
  EXPECT_EQ(errorOf(kPoints + "0\n0\n0\n1\n1 1 0.5\n0\n"),
            "test.cao, line 11: an axis without length, expected two different points on the cylinder's axis");
  EXPECT_EQ(errorOf(kPoints + "0\n0\n0\n0\n1\n-1 0 1 2\n"),
            "test.cao, line 12: -1, expected a radius of the circle above 0 m");
  EXPECT_EQ(
      errorOf(kPoints + "0\n0\n0\n0\n1\n1 0 1 1\n"),
      "test.cao, line 12: three points on one line, expected the centre and two points that span the circle's plane");
  EXPECT_EQ(errorOf(kPoints + "0\n0\n1\n2 0 1\n0\n0\n"),
            "test.cao, line 10: 2, expected the number of points of the face, a whole number from 3 to 100000");
  EXPECT_EQ(errorOf(kPoints + "0\n0\n1\n3 0 1 0\n0\n0\n"),
            "test.cao, line 10: a face without area, expected at least three points of one plane, not on one line");
  EXPECT_EQ(errorOf(kPoints + "0\n0\n1\n4 0 1 1 2\n0\n0\n"),
            "test.cao, line 10: a face whose side from point 1 has no length, expected at least three points of one "
            "plane, not on one line");
  EXPECT_EQ(errorOf(kPoints + "0\n0\n1\n4 0 1 2 3\n0\n0\n").substr(0, 36), "test.cao, line 10: a face whose poin");
  EXPECT_EQ(errorOf(kPoints + "0\n1\n3 0 1 2\n0\n0\n0\n"), "test.cao, line 9: no lines, expected a line for the face");
  EXPECT_EQ(errorOf(kPoints + "0\n0\n0\n0\n0\n"),
            "test.cao, line 11: nothing to be seen, expected lines, faces, cylinders or circles");
  EXPECT_EQ(errorOf("V1\n99999999999\n"),
            "test.cao, line 2: 99999999999, expected the number of points, a whole number from 0 to 100000");
  EXPECT_EQ(errorOf(std::string(test::kCube) + "7\n"),
            "test.cao, line 22: 7, expected the end of the file after the circles");
}

// Wherever it is cut off, at a word or within one, it is refused; nothing is taken for a smaller model.
TEST(CadFile, refusesAFileThatIsCutOff) {
  const std::string whole = test::kCubeAndTube;
  const std::string::size_type last = whole.find_last_not_of("\n");
  for (std::string::size_type length = 0; length + 2 < last; ++length) {
    EXPECT_NE(errorOf(whole.substr(0, length)), "") << "the first " << length << " characters";
  }
}

TEST(CadFile, saysThatAFileCannotBeOpened) {
  try {
    readCadModel(std::string("/nowhere/cube.cao"));
    FAIL() << "it was opened";
  } catch (const CadFileError& error) {
    EXPECT_STREQ(error.what(), "/nowhere/cube.cao cannot be opened, expected a model in ViSP's format .cao");
  }
}

}  // namespace
}  // namespace laparoscope_servo::model
