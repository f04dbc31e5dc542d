// What of a model is seen, and the hysteresis of what comes and goes.
#include "model/visibility.h"

#include <gtest/gtest.h>

#include "model/strands.h"
#include "support/synthetic_model.h"

namespace laparoscope_servo::model {
namespace {

constexpr double kFocal = 500.0;  // px

int seenFaces(const CadModel& model, const Visibility& visibility) {
  int count = 0;
  for (std::size_t f = 0; f < model.faces.size(); ++f) count += visibility.faceIsSeen(static_cast<int>(f)) ? 1 : 0;
  return count;
}

int seenPieces(const Visibility& visibility, int strand) {
  int count = 0;
  for (int k = 0; k < Visibility::kPieces; ++k) count += visibility.isSeen(strand, k) ? 1 : 0;
  return count;
}

TEST(Visibility, ofACubeThreeFacesAndNineEdgesAreSeenFromACorner) {
  const auto model = test::modelOf(test::kCube);
  Visibility visibility(*model);
  Occluders occluders(*model);
  visibility.update(*model, test::viewOf(*model, 0.6), kFocal, occluders);
  EXPECT_EQ(seenFaces(*model, visibility), 3);
  int whole = 0;
  for (int e = 0; e < 12; ++e) {
    const int pieces = seenPieces(visibility, e);
    EXPECT_TRUE(pieces == 0 || pieces == Visibility::kPieces);
    whole += pieces > 0 ? 1 : 0;
  }
  EXPECT_EQ(whole, 9);
}

// A face appears at 7 degrees and stays until 5: between them what was seen before decides.
TEST(Visibility, aFaceThatAppearedStaysWhileItTurnsALittleBack) {
  const auto model = test::modelOf(test::kCube);
  Occluders occluders(*model);
  const auto isSeenAt = [&](Visibility& visibility, double degrees) {
    // One side across the view but for this angle.
    const Eigen::Isometry3d pose = test::viewOf(*model, 10.0, degrees * M_PI / 180.0, 0.6);
    visibility.update(*model, pose, kFocal, occluders);
    return seenFaces(*model, visibility) == 3;
  };
  Visibility visibility(*model);
  // The side's ray is tilted against the horizontal as well, which makes its angle smaller than the turn.
  double appears = 0.0, disappears = 0.0;
  isSeenAt(visibility, 0.0);
  for (double turn = 0.0; turn < 20.0 && appears == 0.0; turn += 0.1) {
    if (isSeenAt(visibility, turn)) appears = turn;
  }
  for (double turn = appears; turn > 0.0 && disappears == 0.0; turn -= 0.1) {
    if (!isSeenAt(visibility, turn)) disappears = turn;
  }
  EXPECT_GT(disappears, 2.0);
  EXPECT_GT(appears, disappears + 1.5);
  EXPECT_LT(appears, 15.0);
  // Without what was before, the decision lies between the two.
  Visibility fresh(*model);
  EXPECT_TRUE(isSeenAt(fresh, appears));
  Visibility other(*model);
  EXPECT_FALSE(isSeenAt(other, disappears));
}

// A tube in front of a cube: pieces of the cube's edges are hidden where the ray to them meets the tube.
TEST(Visibility, whatIsBehindATubeIsHidden) {
  const auto model = test::modelOf(test::kCubeAndTube);
  Visibility visibility(*model);
  Occluders occluders(*model);
  const Eigen::Isometry3d pose = test::viewOf(*model, 0.6, 0.98);  // the tube is between
  visibility.update(*model, pose, kFocal, occluders);
  const Strands strands(*model);
  int part = 0;
  for (int e = 0; e < strands.edges; ++e) {
    const int pieces = seenPieces(visibility, e);
    part += pieces > 0 && pieces < Visibility::kPieces ? 1 : 0;
  }
  EXPECT_GT(part, 0);
  EXPECT_EQ(seenPieces(visibility, strands.edges), Visibility::kPieces);  // its own side
  // From the other side the tube is behind the cube.
  visibility.forget();
  visibility.update(*model, test::viewOf(*model, 0.6, 0.98 + M_PI), kFocal, occluders);
  EXPECT_LT(seenPieces(visibility, strands.edges) + seenPieces(visibility, strands.edges + 1), 2 * Visibility::kPieces);
  for (int e = 0; e < strands.edges; ++e) {
    const int pieces = seenPieces(visibility, e);
    EXPECT_TRUE(pieces == 0 || pieces > Visibility::kPieces - 10) << e;  // near its ends the next face is in front
  }
}

// A wire behind the border of a square: 0.6 px to the piece, and half of it hidden.
TEST(Visibility, aPieceThatWasHiddenComesBackOnlyWhenItIsClear) {
  const auto model =
      test::modelOf("V1\n6\n-1 -1 4\n-1 1 4\n1 1 4\n1 -1 4\n1.1 0 5\n1.5 0 5\n1\n4 5\n0\n1\n4 0 1 2 3\n0\n0\n");
  int wire = 0;
  while (!model->edges[static_cast<std::size_t>(wire)].faces.empty()) ++wire;
  Occluders occluders(*model);
  Visibility fresh(*model), after(*model);
  fresh.update(*model, Eigen::Isometry3d::Identity(), kFocal, occluders);
  // From 0.06 m further to the left the square hides 1.5 px more.
  Eigen::Isometry3d left = Eigen::Isometry3d::Identity();
  left.translation().x() = 0.06;
  after.update(*model, left, kFocal, occluders);
  after.update(*model, Eigen::Isometry3d::Identity(), kFocal, occluders);
  const int before = seenPieces(fresh, wire), now = seenPieces(after, wire);
  EXPECT_GT(before, 20);
  EXPECT_LT(before, 44);
  EXPECT_LT(now, before);
  EXPECT_GE(now, before - 3);
}

TEST(Visibility, aStepOfPiecesAgreesWithEachOfThem) {
  const auto model = test::modelOf(test::kCubeAndTube);
  Occluders occluders(*model);
  const Eigen::Isometry3d pose = test::viewOf(*model, 0.6, 0.98);
  Visibility fine(*model), coarse(*model);
  fine.update(*model, pose, kFocal, occluders);
  coarse.update(*model, pose, kFocal, occluders, 8);
  int differ = 0;
  for (int s = 0; s < Strands(*model).count(); ++s) {
    for (int k = 0; k < Visibility::kPieces; ++k) differ += fine.isSeen(s, k) != coarse.isSeen(s, k) ? 1 : 0;
  }
  EXPECT_LT(differ, 8 * 8);
}

}  // namespace
}  // namespace laparoscope_servo::model
