// What is wrong with tf, one fault a line: the scope stands, or goes on by what its owner says, and it is told.
#include <diagnostic_msgs/DiagnosticArray.h>
#include <laparoscope_servo/SelectTask.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdlib>
#include <cstring>
#include <limits>

#include "controller_fixture.h"
#include "fake_scope.h"

namespace laparoscope_servo {
namespace {

using Transform = geometry_msgs::TransformStamped;

struct Fault {
  const char* name;
  std::function<void(FakeScope&)> begin;
  const char* state;  // that it leads to
  const char* words;  // in the reason
};

Fault moving(const char* name, const char* state, const char* words, const FakeScope::Change& change) {
  return {name, [=](FakeScope& scope) { scope.change(change); }, state, words};
}

Fault fixed(const char* name, const char* child, const char* words, const std::function<void(Transform&)>& change) {
  return {name, [=](FakeScope& scope) { scope.makeStatic(change, child); }, "FAULT", words};
}

const double kNan = std::numeric_limits<double>::quiet_NaN();

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all{
      moving("5 cm along the shaft", "FAULT", "jumped", [](Transform& t, int) { shift(t, 0.0, 0.0, 0.05); }),
      moving("5 cm to the side", "FAULT", "jumped", [](Transform& t, int) { shift(t, 0.05, 0.0, 0.0); }),
      moving("turned by 0.4 rad", "FAULT", "jumped", [](Transform& t, int) { turn(t, 0.4); }),
      moving("two places in turn", "FAULT", "jumped", [](Transform& t, int k) { shift(t, 0.0, 0.0, 0.06 * (k % 2)); }),
      moving("not a number", "HOLD", "not finite", [](Transform& t, int) { t.transform.translation.x = kNan; }),
      moving("no rotation", "HOLD", "length 1", [](Transform& t, int) { t.transform.rotation.w = 0.5; }),
      moving("another parent", "HOLD", "two parents", [](Transform& t, int) { t.header.frame_id = "ceiling"; }),
      moving("from the future", "HOLD", "future", [](Transform& t, int) { t.header.stamp += ros::Duration(0.5); }),
      moving("late", "HOLD", "older than", [](Transform& t, int) { t.header.stamp -= ros::Duration(0.5); }),
      moving("no stamp", "HOLD", "no stamp", [](Transform& t, int) { t.header.stamp = ros::Time(); }),
      {"silent", [](FakeScope& scope) { scope.change({}, false); }, "HOLD", "older than"},
      fixed("insertion point 5 cm off", "insertion_point", "insertion point is another one",
            [](Transform& t) { shift(t, 0.0, 0.0, 0.05); }),
      fixed("scope's tip 5 cm off", "scope_tip", "scope_tip is another one",
            [](Transform& t) { shift(t, 0.0, 0.0, 0.05); }),
      fixed("scope's tip turned", "scope_tip", "scope_tip is another one", [](Transform& t) { turn(t, 0.2); }),
      fixed("camera 5 cm off", "laparoscope_optical", "laparoscope_optical is another one",
            [](Transform& t) { shift(t, 0.0, 0.05, 0.0); }),
      fixed("camera turned", "laparoscope_optical", "laparoscope_optical is another one",
            [](Transform& t) { turn(t, 0.2); })};
  return all;
}

enum class While { kServo, kHold, kManual };

class ControllerTf : public ::testing::TestWithParam<While> {
 protected:
  struct Bench {
    Bench() {
      cart.set([](Feed& feed) { feed.tf = false; });
      manual = node.advertise<ScopeVelocity>("/controller/manual", 1);
      stranger = node.advertise<tf2_msgs::TFMessage>("/stranger/tf", 100);
      static_stranger = node.advertise<tf2_msgs::TFMessage>("/stranger/tf_static", 100);
      diagnostics = node.subscribe<diagnostic_msgs::DiagnosticArray>(
          "/diagnostics", 10, [this](const diagnostic_msgs::DiagnosticArray::ConstPtr& message) {
            const std::lock_guard<std::mutex> lock(mutex);
            for (const auto& status : message->status) {
              if (status.name == "controller: control") said = status;
              if (status.name == "watcher: control") watcher = status;
            }
          });
    }
    ros::NodeHandle node;
    FakeCart cart;
    FakeScope scope;
    ros::Publisher manual, stranger, static_stranger;
    ros::Subscriber diagnostics;
    std::mutex mutex;
    diagnostic_msgs::DiagnosticStatus said;     // of the controller
    diagnostic_msgs::DiagnosticStatus watcher;  // of another one, whose owner of tf is the stranger
  };
  static Bench& bench() {
    static Bench instance;
    return instance;
  }
  static void TearDownTestSuite() {
    bench().scope.end();
    bench().cart.end();
  }

  void SetUp() override {
    ASSERT_TRUE(cart_.waitForController());
    ASSERT_TRUE(waitFor([this] { return bench_.stranger.getNumSubscribers() > 0; }, 10.0));
    ASSERT_TRUE(waitFor([this] { return bench_.static_stranger.getNumSubscribers() > 0; }, 10.0));
    SelectTask task;
    task.request.task = GetParam() == While::kManual ? "MANUAL" : "HOLD_VIEW";
    ASSERT_TRUE(ros::service::call("/controller/select_task", task));
  }

  void drive(double pan) {
    ScopeVelocity message;
    message.pan = pan;
    bench_.manual.publish(message);
  }

  // The stick is released once: it has to be seen at rest before it counts.
  bool moves() {
    if (GetParam() == While::kManual) {
      drive(0.0);
      cart_.nextCommands(2);
      drive(0.05);
    }
    const std::vector<ScopeVelocity> commands = cart_.nextCommands(2);
    return !commands.empty() && !isZero(commands.back());
  }

  bool movesAsTold() {
    return waitFor([this] { return moves(); });
  }

  bool engageAndMove() {
    bool success = false;
    cart_.engage(false, success);
    if (!success || !cart_.engageWhenReady()) return false;
    bool moved = false;
    waitFor([&] {
      moved = moves();
      return moved || cart_.state().state == "FAULT";
    });
    return moved;
  }

  // Everything is as it should be, and the controller in the state in which the fault finds it.
  void begin() {
    bool success = false;
    cart_.engage(false, success);
    ASSERT_TRUE(success);
    scope_.change({});
    scope_.makeStatic({});
    cart_.set([](Feed& feed) { feed = Feed{}, feed.tf = false, feed.message = offTarget(); });
    // The way back from where the last fault has put it is a jump, too, as long as it is under way.
    ASSERT_TRUE(waitFor([this] { return engageAndMove(); }, 10.0)) << cart_.state().reason << cart_.answer();
    if (GetParam() != While::kHold) return;
    cart_.set([](Feed& feed) { feed.message.visible_fraction = 0.0; });
    ASSERT_TRUE(cart_.waitForState("HOLD"));
  }

  // Nothing but tf is missing, and somebody pushes the stick.
  bool standsWhateverIsAsked() {
    cart_.set([](Feed& feed) { feed.message = offTarget(); });
    for (int k = 0; k < 3; ++k) {
      drive(0.05);
      for (const ScopeVelocity& command : cart_.nextCommands(3)) {
        if (!isZero(command)) return false;
      }
    }
    return true;
  }

  diagnostic_msgs::DiagnosticStatus said() {
    const std::lock_guard<std::mutex> lock(bench_.mutex);
    return bench_.said;
  }

  std::string watched() {
    const std::lock_guard<std::mutex> lock(bench_.mutex);
    std::string text = bench_.watcher.message;
    for (const auto& value : bench_.watcher.values) text += '\n' + value.key + ": " + value.value;
    return text;
  }

  std::string value(const std::string& key) {
    for (const auto& value : said().values) {
      if (value.key == key) return value.value;
    }
    return "";
  }

  Bench& bench_ = bench();
  FakeCart& cart_ = bench_.cart;
  FakeScope& scope_ = bench_.scope;
};

TEST_P(ControllerTf, WhatIsWrongStopsTheScope) {
  for (const Fault& fault : faults()) {
    SCOPED_TRACE(fault.name);
    ASSERT_NO_FATAL_FAILURE(begin());
    const double time = steadyNow();
    fault.begin(scope_);
    const bool arrived = waitFor([&] {
      if (GetParam() == While::kManual) drive(0.05);
      const ControllerState state = cart_.state();
      return state.state == fault.state && state.reason.find(fault.words) != std::string::npos;
    });
    EXPECT_TRUE(arrived) << cart_.state().state << ": " << cart_.state().reason;
    EXPECT_TRUE(standsWhateverIsAsked());
    if (GetParam() == While::kHold) continue;
    std::printf("| %-26s | %-6s | %-5s | %4.0f ms |\n", fault.name, GetParam() == While::kManual ? "MANUAL" : "SERVO",
                fault.state, 1e3 * (cart_.stoodAt() - time));
  }
}

// Half a second later the same goes on by itself, if it was a hold.
TEST_P(ControllerTf, AStrayTransformIsLeftOut) {
  ASSERT_NO_FATAL_FAILURE(begin());
  const std::uint64_t before = std::strtoull(value("transforms refused as nonsense").c_str(), nullptr, 10);
  scope_.change([](Transform& t, int k) {
    if (k % 40 == 0) t.transform.translation.z = kNan;
  });
  EXPECT_TRUE(
      waitFor([&] { return std::strtoull(value("transforms refused as nonsense").c_str(), nullptr, 10) > before; }));
  scope_.change({});
  if (GetParam() != While::kHold) {
    EXPECT_TRUE(movesAsTold()) << cart_.state().reason;
  }
  EXPECT_TRUE(cart_.state().engaged) << cart_.state().reason;
}

TEST_P(ControllerTf, AStrangersTransformsNeverCount) {
  ASSERT_NO_FATAL_FAILURE(begin());
  tf2_msgs::TFMessage lies;
  for (const char* child : {"end_effector", "scope_tip", "laparoscope_optical", "insertion_point"}) {
    lies.transforms.push_back(fakeTransform("aesop_base", child, 0.05));
  }
  lies.transforms.push_back(fakeTransform("elsewhere", "insertion_point", kNan));
  EXPECT_TRUE(waitFor([&] {
    if (GetParam() == While::kManual) drive(0.05);
    for (Transform& lie : lies.transforms) lie.header.stamp = ros::Time::now();
    bench_.stranger.publish(lies);
    bench_.static_stranger.publish(lies);
    const diagnostic_msgs::DiagnosticStatus status = said();
    return status.message.find("of /stranger is refused") != std::string::npos;
  })) << said().message;
  EXPECT_GE(said().level, diagnostic_msgs::DiagnosticStatus::WARN);
  EXPECT_NEAR(std::stod(value("d2 [m]")), 0.1, 1e-6);
  EXPECT_EQ(cart_.state().state, GetParam() == While::kHold ? "HOLD" : "SERVO") << cart_.state().reason;
  if (GetParam() != While::kHold) {
    EXPECT_TRUE(movesAsTold()) << cart_.state().reason;
  }
}

// Frames of somebody else, 10 kHz: the loop keeps its rate, which every command shows.
TEST_P(ControllerTf, AFloodOfForeignFramesChangesNothing) {
  ASSERT_NO_FATAL_FAILURE(begin());
  std::atomic<bool> end{false};
  std::atomic<int> sent{0};
  std::thread flood([&] {
    tf2_msgs::TFMessage message;
    message.transforms = {fakeTransform("map", "odom", 0.0)};
    while (!end) {
      for (int k = 0; k < 10; ++k, ++sent) bench_.stranger.publish(message);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  EXPECT_TRUE(waitFor([&] { return sent > 5000; }, 20.0));
  if (GetParam() != While::kHold) {
    EXPECT_TRUE(movesAsTold()) << cart_.state().reason;
  }
  EXPECT_GE(cart_.nextCommands(20).size(), 20u);
  EXPECT_EQ(cart_.state().state, GetParam() == While::kHold ? "HOLD" : "SERVO") << cart_.state().reason;
  end = true;
  flood.join();
}

// Killed and started again, without a word of goodbye: its static frames were true of another process.
TEST_P(ControllerTf, AnOwnerThatDiesTakesItsInsertionPointAlong) {
  const auto statics = [](double point) {
    tf2_msgs::TFMessage message;
    message.transforms = {fakeTransform("end_effector", "scope_tip", 0.3),
                          fakeTransform("scope_tip", "laparoscope_optical", 0.0),
                          fakeTransform("aesop_base", "insertion_point", -point)};
    return message;
  };
  const auto d2Becomes = [this](double expected) {
    return waitFor(
        [&] {
          tf2_msgs::TFMessage moving;
          moving.transforms = {fakeTransform("aesop_base", "end_effector", -0.3)};
          bench_.stranger.publish(moving);
          std::this_thread::sleep_for(std::chrono::milliseconds(10));
          const std::lock_guard<std::mutex> lock(bench_.mutex);
          for (const auto& value : bench_.watcher.values) {
            if (value.key == "d2 [m]") return std::abs(std::stod(value.value) - expected) < 1e-6;
          }
          return false;
        },
        20.0);
  };
  const auto dies = [this] {
    bench_.static_stranger.publish(tf2_msgs::TFMessage());  // without a transform
    return waitFor([this] { return bench_.static_stranger.getNumSubscribers() == 0; }, 10.0) &&
           waitFor([this] { return bench_.static_stranger.getNumSubscribers() > 0; }, 10.0);
  };
  ASSERT_TRUE(dies());  // whatever it has said before
  bench_.static_stranger.publish(statics(0.1));
  EXPECT_TRUE(d2Becomes(0.1)) << watched();
  ASSERT_TRUE(dies());
  EXPECT_TRUE(d2Becomes(0.0)) << "it is unknown, whatever moves";
  bench_.static_stranger.publish(statics(0.15));
  EXPECT_TRUE(d2Becomes(0.15)) << watched();
}

INSTANTIATE_TEST_SUITE_P(While, ControllerTf, ::testing::Values(While::kServo, While::kHold, While::kManual));

// Another node: says on tf what the test tells it to.
int beStranger() {
  ros::NodeHandle node;
  const ros::Publisher tf = node.advertise<tf2_msgs::TFMessage>("/tf", 100);
  const ros::Publisher tf_static = node.advertise<tf2_msgs::TFMessage>("/tf_static", 100, true);
  const auto relay = [](const ros::Publisher& to) {
    return boost::function<void(const tf2_msgs::TFMessage::ConstPtr&)>(
        [to](const tf2_msgs::TFMessage::ConstPtr& message) { to.publish(message); });
  };
  const ros::Subscriber moving_subscriber = node.subscribe<tf2_msgs::TFMessage>("/stranger/tf", 1000, relay(tf));
  const ros::Subscriber static_subscriber = node.subscribe<tf2_msgs::TFMessage>(
      "/stranger/tf_static", 1000,
      boost::function<void(const tf2_msgs::TFMessage::ConstPtr&)>([&](const tf2_msgs::TFMessage::ConstPtr& message) {
        if (message->transforms.empty()) std::_Exit(0);
        tf_static.publish(message);
      }));
  ros::spin();
  return 0;
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  const bool stranger = argc > 1 && std::strcmp(argv[1], "--stranger") == 0;
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, stranger ? "stranger" : "controller_tf");
  if (stranger) return laparoscope_servo::beStranger();
  return RUN_ALL_TESTS();
}
