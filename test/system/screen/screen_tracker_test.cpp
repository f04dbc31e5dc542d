// The screen's window in front of a real tracker, whose camera does what no camera should.
#include <laparoscope_servo/TrackerState.h>
#include <sensor_msgs/CameraInfo.h>

#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QTabWidget>
#include <QTableWidget>
#include <cmath>
#include <mutex>

#include "system/screen/image_feed.h"
#include "system/screen/screen_fixture.h"

namespace laparoscope_servo {
namespace {

using test_support::hands;
using test_support::ImageFeed;
using test_support::waitFor;

const cv::Size kSize(640, 480);

class ScreenTracker : public test_support::ScreenFixture {
 protected:
  void SetUp() override { show({1280, 800}); }
  void TearDown() override { feed_.show(nullptr); }

  // The white half is white, and not under a veil: a live picture.
  bool isWhite() const {
    const QImage shown = image().grab().toImage();
    return qGray(shown.pixel(shown.width() * 2 / 3, shown.height() / 3)) > 225;
  }
  bool imageIs(const cv::Size& size) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return state_.width == static_cast<unsigned>(size.width) && state_.height == static_cast<unsigned>(size.height);
  }
  const screen::BandText& tracker() const { return find<screen::StateBand>("Tracker").text(); }
  QString answer() const { return find<QLabel>("answer").text(); }
  // By mouse, in px of the image.
  bool selects(const QSize& size, const QRect& region) {
    return ScreenFixture::selects(onDisplay(size, region.topLeft()),
                                  onDisplay(size, region.topLeft() + QPoint(region.width(), region.height())));
  }
  void track() {
    feed_.show(ImageFeed::tissue(kSize));
    ASSERT_TRUE(waitFor([this] { return imageIs(kSize) && isColoured(); })) << tracker().word;
    ASSERT_TRUE(selects({640, 480}, {250, 170, 140, 140})) << tracker().word << answer().toStdString();
  }

  ros::NodeHandle node_;
  std::mutex mutex_;
  TrackerState state_;
  ros::Subscriber states_ =
      node_.subscribe<TrackerState>("tracker/state", 10, [this](const TrackerStateConstPtr& state) {
        const std::lock_guard<std::mutex> lock(mutex_);
        state_ = *state;
      });
  ImageFeed feed_;
};

TEST_F(ScreenTracker, EveryKindOfPictureIsShown) {
  for (const char* encoding : {"bgr8", "rgb8", "bgra8", "mono8", "mono16"}) {
    feed_.show(ImageFeed::halves(kSize, encoding));
    EXPECT_TRUE(waitFor([this] { return word("Tracker") == "IDLE" && isWhite(); })) << encoding;
    feed_.show(nullptr);
    EXPECT_TRUE(waitFor([this] { return !isWhite(); })) << encoding;
  }
  const cv::Size large(3840, 2160), least(1, 1);
  for (const cv::Size& size : {large, least}) {
    feed_.show(ImageFeed::halves(size, "bgr8"));
    EXPECT_TRUE(waitFor([&] { return imageIs(size) && isWhite(); })) << size;
  }
  feed_.show([make = ImageFeed::halves({641, 479}, "bgr8")](int turn) {
    sensor_msgs::Image image = make(turn), wide = image;
    wide.step = image.step + 7;
    wide.data.assign(std::size_t{wide.step} * wide.height, 90);
    for (std::size_t row = 0; row < image.height; ++row)
      std::copy_n(image.data.begin() + row * image.step, image.step, wide.data.begin() + row * wide.step);
    return wide;
  });
  EXPECT_TRUE(waitFor([&] { return imageIs({641, 479}) && isWhite(); })) << "rows with a rest";
}

TEST_F(ScreenTracker, WhatIsNoPictureIsSaid) {
  const auto halves = ImageFeed::halves(kSize, "bgr8");
  const std::vector<std::pair<const char*, std::function<void(sensor_msgs::Image&)>>> kinds{
      {"Bayer", [](sensor_msgs::Image& image) { image.encoding = "bayer_rggb8"; }},
      {"nonsense", [](sensor_msgs::Image& image) { image.encoding = "<b>nonsense</b>"; }},
      {"half of it", [](sensor_msgs::Image& image) { image.data.resize(image.data.size() / 2); }},
      {"nothing", [](sensor_msgs::Image& image) { image.width = image.height = 0; }}};
  for (const auto& [name, spoil] : kinds) {
    feed_.show(halves);
    ASSERT_TRUE(waitFor([this] { return word("Tracker") == "IDLE" && isWhite(); })) << name;
    feed_.show([&, spoil = spoil](int turn) {
      sensor_msgs::Image image = halves(turn);
      spoil(image);
      return image;
    });
    EXPECT_TRUE(waitFor([this] { return word("Tracker") == "NO IMAGE" && !isWhite(); })) << name << tracker().word;
    EXPECT_TRUE(waitFor([this] { return tracker().detail.find("refused") != std::string::npos; })) << tracker().detail;
    EXPECT_FALSE(tracker().sentence.empty() || tracker().cure.empty()) << name;
    feed_.show(nullptr);  // what it is made of ends with this turn
    waitFor([] { return false; }, 0.2);
  }
}

TEST_F(ScreenTracker, ACameraThatComesBackWithAnotherSizeIsDrawnInAsItIsNow) {
  track();
  feed_.show(nullptr);
  ASSERT_TRUE(waitFor([this] { return word("Tracker") == "NO IMAGE" && !isColoured(); }));
  feed_.show(ImageFeed::tissue({960, 540}));
  ASSERT_TRUE(waitFor([this] {
    return word("Tracker") == "IDLE" && imageIs({960, 540}) && isColoured();
  })) << tracker().word
      << ": a region of another size is none";
  ASSERT_TRUE(selects({960, 540}, {600, 200, 150, 120})) << answer().toStdString();
  // The screen may have heard of it before this test has.
  EXPECT_TRUE(waitFor([this] {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::abs(state_.region[0] - 600.0) <= 3.0 && std::abs(state_.region[5] - 319.0) <= 3.0;
  }));
}

TEST_F(ScreenTracker, TimeThatJumpsBackAndIntrinsicsOfZeroDoNoHarm) {
  track();
  ros::Publisher infos = node_.advertise<sensor_msgs::CameraInfo>("camera/camera_info", 1, true);
  infos.publish(sensor_msgs::CameraInfo());
  feed_.setClock(-1000.0);
  EXPECT_TRUE(waitFor([this] { return !isColoured() && word("Tracker") != "TRACKING"; }))
      << "a picture of long ago is not live";
  feed_.setClock(0.0);
  EXPECT_TRUE(waitFor([this] { return isColoured(); })) << tracker().word;
  EXPECT_TRUE(word("Tracker") == "IDLE" || selects({640, 480}, {250, 170, 140, 140})) << tracker().word;
}

TEST_F(ScreenTracker, StopSaysThatThereIsNoArm) {
  ASSERT_TRUE(waitFor([this] { return word("Tracker") == "NO IMAGE"; })) << "there is a master";
  hands("key Escape");
  EXPECT_TRUE(waitFor([this] {
    return answer() == "STOP: done. There is no arm and no controller here: nothing had to be stopped.";
  })) << answer().toStdString();
  click("enable");
  EXPECT_TRUE(waitFor([this] { return answer().contains("NOT DONE. No node offers /aesop/enable"); }))
      << answer().toStdString();
}

TEST_F(ScreenTracker, ANameOfMarkupIsText) {
  track();
  find<QTabWidget>("tabs").setCurrentIndex(1);
  const QString name = QString("<b>&\"'<img src=x onerror=alert(1)>").leftJustified(64, 'm');
  find<QLineEdit>("view_name").setText(name);
  click("store_view");
  auto& list = find<QListWidget>("views");
  ASSERT_TRUE(waitFor([&] { return list.count() == 1; })) << answer().toStdString();
  EXPECT_EQ(list.item(0)->text(), name);
  EXPECT_EQ(find<QLabel>("answer").textFormat(), Qt::PlainText);
}

TEST_F(ScreenTracker, AParameterThatTheNodeRefusesIsSaidWithItsReason) {
  feed_.show(ImageFeed::tissue(kSize));
  find<QTabWidget>("tabs").setCurrentIndex(3);
  auto& table = find<QTableWidget>("parameters");
  const auto row = [&] {
    for (int k = 0; k < table.rowCount(); ++k) {
      if (table.item(k, 0)->text() == "tracker/tracking/quality/min_zncc") return k;
    }
    return -1;
  };
  ASSERT_TRUE(waitFor([&] { return row() >= 0; }));
  const QString before = table.item(row(), 1)->text();
  const auto set = [&](const QString& text) {
    table.selectRow(row());
    find<QLineEdit>("value").setText(text);
    click("set_parameter");
  };
  set("7");
  ASSERT_TRUE(waitFor([this] { return answer().contains("REFUSED"); })) << answer().toStdString();
  EXPECT_TRUE(answer().contains("min_zncc")) << answer().toStdString();
  EXPECT_EQ(table.item(row(), 1)->text(), before);
  set("0.43");
  EXPECT_TRUE(waitFor([&] { return table.item(row(), 1)->text() == "0.43"; })) << answer().toStdString();
}

}  // namespace
}  // namespace laparoscope_servo

int main(int argc, char** argv) {
  return laparoscope_servo::test_support::runScreenTests(argc, argv, "screen_tracker_test");
}
