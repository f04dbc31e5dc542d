// The task PARALLEL: the image plane is brought parallel to the tissue, by pan and tilt under the insertion point
// (survey, IV.B.2).
//
// 1. Somebody engages: the scope goes round a small circle through where it stands, until the normal is known.
// 2. Once the arm stands, the engagement ends with an announcement of what the turn will do from there.
// 3. Somebody engages again: the optical axis is turned onto the normal, and held there.
//
// Where the normal does not become known on so many circles, or where the turn is not possible, the scope stands, with
// the reason; the next time that somebody engages it begins anew.
#pragma once

#include <Eigen/Geometry>
#include <deque>
#include <limits>
#include <optional>
#include <string>

#include "laparoscope_servo/scope/geometry.h"
#include "laparoscope_servo/scope/velocity.h"
#include "laparoscope_servo/servo/parallel_figures.h"
#include "laparoscope_servo/servo/shaping_config.h"
#include "laparoscope_servo/servo/task_config.h"
#include "laparoscope_servo/servo/view_motion.h"
#include "servo/prediction/command_history.h"
#include "servo/task/parallel/parallel_goal.h"
#include "servo/task/parallel/plane_normal.h"
#include "servo/task/parallel/pose_history.h"

namespace laparoscope_servo::servo {

struct ParallelPose {
  double time = 0.0;  // s
  Eigen::Isometry3d base_T_tip = Eigen::Isometry3d::Identity();
  scope::Geometry scope;
};

class ParallelTask {
 public:
  // The configuration must be valid.
  ParallelTask(const ParallelConfig& config, const Workspace& range, double desired_depth);

  // Forgets everything: another task, another anchor image, a clock that jumped.
  void restart();

  // Somebody engages at `time` [s]. A normal that was found a while ago, or announced from elsewhere, is searched anew.
  void engage(double time);

  // Nobody is engaged any more: a circle that is not over is not gone on with, and nothing comes of it.
  void leaveCircle();

  // Takes a pose; `commands`, each executed `delay` [s] after it was given, tell what the scope did since the last one.
  void move(const ParallelPose& pose, const CommandHistory& commands, double delay);

  // Takes a view of `time` [s]; one that is not newer than the last changes nothing. `anchor` identifies the anchor,
  // `moves`: the scope may move.
  void see(double time, double anchor, const ViewMotion& motion, bool moves);

  // The next step of the circle, `period` [s] after the last one.
  scope::Velocity circle(double period);

  ParallelStage stage() const { return figures_.stage; }
  // Why the task cannot go on; empty: it can.
  const std::string& problem() const { return problem_; }
  // In kAnnounced: what the turn will do.
  const std::string& announcement() const { return announcement_; }
  // In kTurn, at the time of the last pose: the error of the goal, and of where the turn goes first. That is pan or
  // tilt alone as long as much of it is left: an axis that is much slower than the other one shows too little for the
  // guard of effect to see whether it does what it is told.
  TaskError goalError() const { return errorOf(filtered_); }
  TaskError error() const { return errorOf(next_); }
  double errorTime() const { return filtered_at_; }
  const ParallelFigures& figures() const { return figures_; }

 private:
  struct Waiting {
    double time = 0.0;
    ViewMotion motion;
    bool moves = false;
  };

  void measure(const Waiting& image, const Eigen::Isometry3d& base_T_shaft);
  void settle();
  void announce();
  void compare(const Waiting& image, const Eigen::Isometry3d& base_T_shaft);
  void fail(const std::string& problem);
  void chooseAxis();
  TaskError errorOf(const Eigen::Vector3d& normal) const;

  ParallelConfig config_;
  Workspace range_;
  double desired_depth_;
  PoseHistory poses_;
  std::deque<Waiting> waiting_;
  std::optional<double> anchor_;
  std::optional<double> seen_at_;  // s, time of the last view
  std::optional<ParallelPose> pose_;
  PlaneNormal plane_;
  PlaneEstimate estimate_;  // of the circle that ended
  Eigen::Vector3d normal_in_anchor_ = Eigen::Vector3d::UnitZ();
  double phase_ = 0.0;                                             // s, of the circle
  double settles_from_ = 0.0;                                      // s, end of the circle
  double since_ = 0.0;                                             // s, of the announcement
  Eigen::Vector3d announced_from_ = Eigen::Vector3d::UnitZ();      // the shaft then, in the base
  Eigen::Vector3d filtered_ = Eigen::Vector3d::UnitZ();            // the normal in the shaft's axes
  double filtered_at_ = -std::numeric_limits<double>::infinity();  // s
  Eigen::Vector3d next_ = Eigen::Vector3d::UnitZ();                // the direction to which the turn goes first
  std::optional<int> turning_;                                     // about this axis of the shaft alone
  int strange_ = 0;                                                // images in a row by which the normal is elsewhere
  std::string problem_;
  std::string announcement_;
  ParallelFigures figures_;
};

}  // namespace laparoscope_servo::servo
