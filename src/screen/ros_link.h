// The screen's link to the nodes: subscribes, calls services, stops. None of its functions blocks.
//
// Its threads: one that connects, one that receives, one that publishes the held controls (HoldSender), and one for
// each service call. Names are relative, so that a screen in a namespace belongs to the cart there.
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "screen/fact_keeper.h"
#include "screen/features/feature_link.h"
#include "screen/held_control.h"
#include "screen/hold_sender.h"
#include "screen/parameter_link.h"
#include "screen/registration.h"
#include "screen/service_calls.h"
#include "screen/stop_report.h"
#include "screen/tracker_link.h"
#include "screen/wish.h"

namespace laparoscope_servo::screen {

class RosLink {
 public:
  // Construct it after ros::init. `news` is called from the link's threads for a new picture or an answer. `space`: the
  // namespace of the cart, seen from that of the process; empty: the same.
  explicit RosLink(const std::function<void()>& news, const std::string& space = "");
  ~RosLink();
  RosLink(const RosLink&) = delete;
  RosLink& operator=(const RosLink&) = delete;

  Facts facts() const { return keeper_.facts(); }
  std::vector<MinuteHistory::Step> minute(double now) const { return keeper_.minute(now); }
  void controlPlayback(const std::string& command, double position);
  TrackerLink& tracker() { return tracker_; }
  ParameterLink& parameters() { return parameters_; }

  // Stops over open connections, without a master; then also by the services, if there is a master.
  void stop();

  // What lets the arm or the controller move is asked to end once more, if it is answered only after its end was asked
  // for.
  void enable();
  void disable();
  void pause();
  void resume();
  void clearFault() { trigger("aesop/clear_fault", "Clear fault"); }
  void engage(bool on);
  void selectTask(const std::string& task);
  // Makes the present view the one that the task STABILISE keeps.
  void keepView();

  HeldControl& deadMan() { return dead_man_; }
  HeldControl& slider() { return slider_; }
  // -1 to 1 of the limits; used while the slider is held.
  void setShares(const std::array<double, 4>& shares);
  // Call when a held control has changed: publishes at once.
  void said();

 private:
  // All objects that need a master when they are created.
  struct Connection {
    explicit Connection(const std::string& space) : node(space) {}
    ros::NodeHandle node;
    std::unique_ptr<HoldSender> sender;
    std::unique_ptr<FeatureLink> features;
    ros::Publisher robot_stop, controller_stop;
    ros::Subscriber preview, homography, recorded, areas, tracker_state, controller_state, command, operating_state,
        playback, diagnostics;
    ros::Subscriber features_preview;
    std::string features_shown;  // the tracker of features whose picture is shown; empty: the region tracker's is
    bool limits_wanted = true;
    unsigned turns = 0;
  };

  void run();
  std::unique_ptr<Connection> connect();
  void look(Connection& connection);
  void choosePicture(Connection& connection, bool tracker, const FeatureLink::Connected& features);
  void renewed();
  std::string resolved(const std::string& name) const;
  void trigger(const std::string& service, const std::string& what, const ServiceCalls::Manner& manner = {});
  void setEngaged(bool on, const std::string& what, const ServiceCalls::Manner& manner);
  // Of a call of STOP: its answer is for the report.
  ServiceCalls::Manner reportOf(StopReport::Node node);
  void take(const Answer& answer);

  std::function<void()> news_;
  std::string space_;
  FactKeeper keeper_;
  TrackerLink tracker_;
  HeldControl dead_man_;
  HeldControl slider_;
  std::atomic<bool> ends_{false};

  ros::CallbackQueue queue_;
  mutable std::mutex mutex_;  // guards the pointer below; never held during a call to a master
  std::unique_ptr<Connection> connection_;
  std::mutex stop_mutex_;
  StopReport stop_report_;  // of the last STOP
  Wish stopped_;            // ended by the next STOP
  Wish enabled_, resumed_, engaged_;
  ParameterLink parameters_;
  ServiceCalls calls_;
  std::thread thread_;
};

}  // namespace laparoscope_servo::screen
