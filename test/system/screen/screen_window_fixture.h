// The screen's window, with real events of an X server, against nodes that say what the test wants.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "system/screen/fake_nodes.h"
#include "system/screen/screen_fixture.h"

namespace laparoscope_servo::test_support {

const QSize kOriginal(1280, 720);  // px, of the nodes' images

class ScreenWindow : public ScreenFixture {
 protected:
  void SetUp() override {
    static const char* const names[] = {"pan", "tilt", "spin", "insertion"};
    for (const char* name : names) ros::param::set(std::string("controller/limits/velocity/") + name, 0.1);
    show({1280, 800});
    ASSERT_TRUE(waitFor([this] { return nodes_.connected() && word("Tracker") == "IDLE" && isColoured(); }));
    nodes_.forget();
  }
  // The other hand: another window of this program, as a dialog would be.
  std::unique_ptr<QWidget> otherWindow() {
    auto other = std::make_unique<QWidget>();
    other->setGeometry(1300, 10, 200, 100);
    other->show();
    EXPECT_TRUE(waitFor([&] { return other->windowHandle()->isExposed(); })) << "the other window";
    return other;
  }
  // Draws until the screen asks for the region: a busy machine makes the picture old for a moment, and then nothing can
  // be drawn.
  bool draws(const QRect& region) {
    const QPointF from = region.topLeft();
    return waitFor([&] {
      drag(onDisplay(kOriginal, from), onDisplay(kOriginal, from + QPointF(region.width(), region.height())));
      return waitFor([this] { return !nodes_.regions().empty(); }, 5.0);
    });
  }
  bool deadManIs(bool held) {
    return waitFor([&] { return !nodes_.deadMan().empty() && nodes_.deadMan().back() == held; });
  }
  // A machine too busy for the screen to say in time that it lives ends a hold: then once more.
  void hold(const std::string& begin, const std::string& end, const std::function<bool()>& is_held) {
    for (int tries = 0; tries < 20; ++tries) {
      nodes_.forget();
      hands(begin);
      if (waitFor(is_held, 5.0)) return;
      hands(end);
      waitFor([this] { return isSilent(); });
    }
    FAIL() << "it could not be held";
  }
  bool isRepeated() const {
    const std::vector<bool> words = nodes_.deadMan();
    return words.size() >= 6 && std::count(words.begin() + 1, words.end(), false) == 0;
  }
  void holdDeadMan() {
    ASSERT_TRUE(waitFor([this] { return nodes_.connected(); }));
    hold(moveTo(centreOf(find<QWidget>("dead_man"))) + "mousedown 1", "mouseup 1", [this] { return isRepeated(); });
    EXPECT_FALSE(nodes_.deadMan().front()) << "it was seen released";
  }
  bool isSilent() {  // no word for as long as ten of them would take
    const std::size_t told = nodes_.deadMan().size() + nodes_.manual().size();
    waitFor([] { return false; }, 0.5);
    return nodes_.deadMan().size() + nodes_.manual().size() == told;
  }
  bool isStopped(int times) {
    return waitFor([&] {
      return nodes_.robot_stops == times && nodes_.controller_stops == times && nodes_.disables == times &&
             nodes_.disengages == times;
    });
  }

  FakeNodes nodes_;
};

}  // namespace laparoscope_servo::test_support
