// What is found on the master; that it is subscribed to is shown by the test screen_features.
#include "screen/features/feature_link.h"

#include <gtest/gtest.h>

namespace laparoscope_servo::screen {
namespace {

const char* const kType = "laparoscope_servo/TrackedFeatures";

XmlRpc::XmlRpcValue answerWith(const std::vector<std::pair<std::string, std::string>>& topics) {
  XmlRpc::XmlRpcValue answer;
  answer[0] = 1;
  answer[1] = "current topics";
  answer[2].setSize(static_cast<int>(topics.size()));
  for (int k = 0; k < answer[2].size(); ++k) {
    answer[2][k][0] = topics[static_cast<std::size_t>(k)].first;
    answer[2][k][1] = topics[static_cast<std::size_t>(k)].second;
  }
  return answer;
}

TEST(FeatureLink, FindsTheTrackersOfItsNamespaceByTheirType) {
  const XmlRpc::XmlRpcValue answer = answerWith({{"/left/instrument/features", kType},
                                                 {"/left/edges/features", kType},
                                                 {"/left/edges/overlay", "sensor_msgs/Image"},
                                                 {"/left/camera/features", "std_msgs/String"},
                                                 {"/left/far/away/features", kType},
                                                 {"/left/other", kType},
                                                 {"/dots/features", kType},
                                                 {"/right/dots/features", kType}});
  EXPECT_EQ(featureTrackersIn(answer, "/left"), (std::vector<std::string>{"edges", "instrument"}));
  EXPECT_EQ(featureTrackersIn(answer, "/"), (std::vector<std::string>{"dots"}));
  EXPECT_EQ(featureTrackersIn(answer, "/nowhere"), std::vector<std::string>());
}

TEST(FeatureLink, FindsNothingInAnAnswerThatIsNone) {
  XmlRpc::XmlRpcValue number, broken = answerWith({{"/edges/features", kType}});
  number = 7;
  EXPECT_TRUE(featureTrackersIn(number, "/").empty());
  EXPECT_TRUE(featureTrackersIn({}, "/").empty());
  broken[2][0] = "text";
  EXPECT_TRUE(featureTrackersIn(broken, "/").empty());
  broken[2][0] = number;
  EXPECT_TRUE(featureTrackersIn(broken, "/").empty());
  broken[2] = 3;
  EXPECT_TRUE(featureTrackersIn(broken, "/").empty());
}

}  // namespace
}  // namespace laparoscope_servo::screen
