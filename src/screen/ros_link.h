// The screen's link to the nodes: listens, asks, stops. None of its functions waits for anybody.
//
// Its threads: one that connects, one that listens, one that says what is held (HoldSender), one for each call of a
// service. Names are relative, so that a screen in a namespace belongs to the cart there.
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <QRect>
#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "screen/fact_keeper.h"
#include "screen/held_control.h"
#include "screen/hold_sender.h"
#include "screen/service_calls.h"

namespace laparoscope_servo::screen {

class RosLink {
 public:
  // After ros::init. `news` is called from the link's threads when there is a new picture, or an answer.
  explicit RosLink(const std::function<void()>& news);
  ~RosLink();
  RosLink(const RosLink&) = delete;
  RosLink& operator=(const RosLink&) = delete;

  Facts facts() const { return keeper_.facts(); }

  // Over connections that are open already, without a master; then also by the services, if there is one.
  void stop();

  void enable() { trigger("aesop/enable", "Enable"); }
  void disable() { trigger("aesop/disable", "Disable"); }
  void pause() { trigger("aesop/pause", "Hold"); }
  void resume() { trigger("aesop/resume", "Resume"); }
  void clearFault() { trigger("aesop/clear_fault", "Clear fault"); }
  void clearRegion() { trigger("tracker/reset", "Clear region"); }
  void engage(bool on);
  void selectTask(const std::string& task);
  void selectRegion(const QRect& pixels);  // of the original image

  HeldControl& deadMan() { return dead_man_; }
  HeldControl& slider() { return slider_; }
  // -1 to 1 of the limits, while the slider is held.
  void setShares(const std::array<double, 4>& shares);
  // What is held has changed: say it at once.
  void said();

 private:
  // Everything that needs a master to begin with.
  struct Connection {
    ros::NodeHandle node;
    std::unique_ptr<HoldSender> sender;
    ros::Publisher robot_stop, controller_stop;
    ros::Subscriber preview, homography, areas, tracker_state, controller_state, command, operating_state;
    bool limits_wanted = true;
  };

  void run();
  std::unique_ptr<Connection> connect();
  void look(Connection& connection);
  std::string resolved(const std::string& name) const;
  void trigger(const std::string& service, const std::string& what);

  std::function<void()> news_;
  FactKeeper keeper_;
  HeldControl dead_man_;
  HeldControl slider_;
  std::atomic<bool> ends_{false};

  ros::CallbackQueue queue_;
  mutable std::mutex mutex_;  // of the pointer that follows; never held while a master is asked
  std::unique_ptr<Connection> connection_;
  ServiceCalls calls_;
  std::thread thread_;
};

}  // namespace laparoscope_servo::screen
