// The closed loop without ROS and without images: the controller, an ideal scope under an insertion point, a plane of
// tissue.
//
// The camera measures the exact homography of the plane, with noise on the ROI's corners; in STABILISE on those of
// servo::viewRegion(), as long as enough of the reference image is in view for AnchoredMotion; in CENTRE_TIP
// the ROI's centre is an instrument's tip, which a hand moves as the patient's tissue moves, and in FOLLOW the middle
// of an object; in POINTS there are 36 points in the ROI, of which a share may be astray; POSITION goes by
// that homography; in PARALLEL the view is followed from image to image where too little of the reference image is
// left. The robot executes the commands after a delay and with a dead zone, as the end-effector's velocity of eq. (12).
// Tissue and insertion point may move, the optics may be oblique, and the controller's depths and delay may be wrong.
// Deterministic: the same configuration and seed give the same numbers. World frame: the camera's at the reference
// pose.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/servo/controller.h"
#include "laparoscope_servo/sim/patient.h"
#include "laparoscope_servo/sim/scope_actuator.h"
#include "laparoscope_servo/sim/scope_body.h"

namespace laparoscope_servo::closed_loop {

// Faults of the picture between scope and tracker.
struct PictureConfig {
  double roll = 0.0;            // rad: the picture is turned against the configured optics
  std::string mirror = "none";  // "left_right" or "up_down", before it is rolled
  double frozen_from = 1e9;     // s: from then on the picture is frozen, with new noise, like that of another camera
};

// Instruments that cross the region, one after the other.
struct CrossingConfig {
  double period = 0.0;    // s, from one to the next; 0: none
  double duration = 2.0;  // s
  double cover = 0.7;     // share of the region that is covered in the middle of a crossing
  double noise = 4.0;     // factor on the noise of the corners meanwhile
};

struct SimulationConfig {
  std::string task = "HOLD_VIEW";  // or another task that follows a picture
  double frame_rate = 25.0;        // Hz, of the camera
  double image_delay = 0.0;        // s, from the exposure to the task error
  double corner_noise = 0.3;       // px, standard deviation of each corner coordinate
  // px, standard deviation of each coordinate of the view's corners from an image to the next, where the view is
  // followed so
  double step_noise = 0.03;
  double reading_time = 1.0;                                   // s, from PARALLEL's announcement to engaging again
  double points_astray = 0.0;                                  // share of the points of POINTS that do not move
  double width = 640.0;                                        // px, of the image
  double height = 480.0;                                       // px
  geometry::PinholeCamera camera{400.0, 400.0, 319.5, 239.5};  // px
  geometry::Rectangle roi{270.0, 190.0, 100.0, 100.0};         // px, in the reference image
  double tissue_distance = 0.08;                               // m, Z*, from the reference camera to the plane
  double tissue_slant_x = 0.0;                                 // rad, of the plane, about the camera's x axis
  double tissue_slant_y = 0.0;                                 // rad, about its y axis
  double depth = 0.1;                                          // m, d2 at the reference pose
  double scope_length = 0.35;                                  // m, l = d1 + d2
  double believed_depth_factor = 1.0;                          // ratio of the controller's d2 to the true one
  double optics_angle = 0.0;                                   // rad, between shaft and optical axis
  double optics_roll = 0.0;                                    // rad, of the camera on the scope, about the shaft
  sim::Wrist wrist = sim::Wrist::kStiff;
  // Start of the loop relative to the reference pose: turned about the insertion point [rad], then pushed in [m].
  scope::Velocity start{0.1511, 0.0873, 0.1745, 0.02};
  scope::Velocity start_spread{0.0, 0.0, 0.0, 0.0};  // in the units of `start`; see drawStart()
  double duration = 20.0;                            // s, of simulated time
  double rest_from = 0.75;  // share of the duration after which the figures of rest are computed
  sim::ScopeActuatorConfig robot;
  bool reports = true;              // the robot reports its velocity
  double report_noise = 0.002;      // rad/s, and a tenth of it in m/s
  bool poses = false;               // the controller gets the shaft's pose, and may estimate the insertion point
  double pose_noise = 0.0005;       // m, standard deviation per axis
  double direction_noise = 0.0035;  // rad, of the shaft's direction, per axis
  double pose_turn = 1.0;           // times: of the turns since the start, what the poses tell
  sim::PatientConfig patient;
  PictureConfig picture;
  CrossingConfig crossing;
  std::vector<double> signs{1.0, 1.0, 1.0, 1.0};  // factors on pan, tilt, spin, insertion; -1: reversed; 0: none
};

// The controller under test.
struct ControllerSetup {
  servo::ControllerConfig control;
  double rate = 50.0;  // Hz, of its commands
};

// One step of the controller. Errors are true ones, without noise.
struct SimulationSample {
  double t = 0.0;           // s
  scope::Velocity command;  // the controller's present command
  double u = 0.0;           // px, the ROI's centre in the image
  double v = 0.0;           // px
  double log_depth = 0.0;   // log(Z/Z*) from the ROI's area
  double alpha = 0.0;       // rad, orientation of the ROI
  double d1 = 0.0;          // m
  double d2 = 0.0;          // m
  // m/s, executed velocity of the scope across the shaft, eq. (9): at the true insertion point, and at the one assumed
  // by the controller
  double lateral_speed = 0.0;
  double commanded_lateral_speed = 0.0;
  double lateral_offset = 0.0;  // m, from the insertion point to the shaft
  double worst_corner = 0.0;    // px, least distance of the ROI's corners from the image's border; negative: outside
  // rad, m: displacement of the scope since the start (pan, tilt, spin, insertion)
  Eigen::Vector4d moved = Eigen::Vector4d::Zero();
  double evidence = 0.0;     // evidence of the effect guard
  double unconfirmed = 0.0;  // used share of the effect budget
  double leash = 0.0;        // used share of the leash
  double slant = 0.0;        // rad, of the tissue against the image plane
  // rad, between the normal that PARALLEL knows and the true one, in the arm's base; NaN: none is known
  double normal_error = 0.0;
  servo::ControllerState state = servo::ControllerState::kIdle;
};

// Whether the whole ROI is in the image at the start.
bool startSeesRoi(const SimulationConfig& config);

// Runs for `duration` [s] of simulated time. Throws std::invalid_argument if the tissue is not visible at the start
// pose.
std::vector<SimulationSample> simulate(const ControllerSetup& controller, const SimulationConfig& config, unsigned seed,
                                       double duration);

struct SimulationSummary {
  double settling_time = -1.0;      // s, from which centre and scale stay within the bounds; -1: they do not
  double final_offset = 0.0;        // px, rms of the centre's distance over the last quarter
  double final_scale_error = 0.0;   // rms over the last quarter, 0.01 is 1 %
  double final_alpha = 0.0;         // rad, rms over the last quarter
  double moving_share = 0.0;        // share of the last quarter with a command other than zero
  double max_lateral_speed = 0.0;   // m/s
  double max_lateral_offset = 0.0;  // m
};

// Settled: the centre within `offset_bound` [px], the scale within `scale_bound` [1] of the reference.
SimulationSummary summarise(const std::vector<SimulationSample>& samples, const SimulationConfig& config,
                            double offset_bound = 2.0, double scale_bound = 0.02);

// The file of interface.md: a header line and a line per sample.
void writeCsv(const std::vector<SimulationSample>& samples, std::ostream& stream);

}  // namespace laparoscope_servo::closed_loop
