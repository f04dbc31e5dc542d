// Two carts on one master: each goes by its own frames, and two that publish the same ones are told so.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <cmath>
#include <functional>
#include <map>
#include <string>

namespace laparoscope_servo {
namespace {

class TwoCarts : public ::testing::Test {
 protected:
  TwoCarts() {
    subscriber_ = node_.subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", 100, [this](const diagnostic_msgs::DiagnosticArray::ConstPtr& message) {
          for (const auto& status : message->status) {
            if (status.name.find("control") == std::string::npos) continue;
            const bool is_a = status.name.find("a/controller") != std::string::npos;
            std::map<std::string, std::string>& said = said_[is_a ? "a" : "b"];
            said["message"] = status.message;
            for (const auto& value : status.values) said[value.key] = value.value;
            ++count_;
          }
        });
  }

  bool waitFor(const std::function<bool()>& condition, double seconds = 30.0) {
    const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(seconds);
    while (ros::SteadyTime::now() < end) {
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
      if (condition()) return true;
    }
    return false;
  }

  double d2(const std::string& cart) {
    const std::string& text = said_[cart]["d2 [m]"];
    return text.empty() ? 0.0 : std::stod(text);
  }

  ros::NodeHandle node_;
  ros::Subscriber subscriber_;
  std::map<std::string, std::map<std::string, std::string>> said_;
  int count_ = 0;
};

TEST_F(TwoCarts, EachHasAnInsertionDepthOfItsOwn) {
  ASSERT_TRUE(waitFor([this] { return d2("a") > 0.0 && d2("b") > 0.0; })) << said_["a"]["message"];
  const double a = d2("a"), b = d2("b");
  EXPECT_GT(std::abs(a - b), 0.02) << a << ' ' << b;
  const int before = count_;
  EXPECT_TRUE(waitFor([&] {
    EXPECT_NEAR(d2("a"), a, 1e-3);
    EXPECT_NEAR(d2("b"), b, 1e-3);
    return count_ > before + 20;
  }));
  const std::string refused = "is refused, only that of /a/aesop counts";
  const bool conflict = ros::param::param("~conflict", false);
  EXPECT_EQ(waitFor([&] { return said_["a"]["message"].find(refused) != std::string::npos; }, conflict ? 30.0 : 0.0),
            conflict)
      << said_["a"]["message"];
  EXPECT_EQ(said_["a"]["transforms of others refused"] == "0", !conflict);
  EXPECT_EQ(said_["b"]["transforms of others refused"] == "0", !conflict);
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "two_carts");
  return RUN_ALL_TESTS();
}
