#include "ros/parameter_pages.h"

#include <memory>
#include <stdexcept>

#include "laparoscope_servo/parameters/pages.h"
#include "ros/aesop/aesop_parameters.h"
#include "ros/camera/camera_config.h"
#include "ros/controller/controller_parameters.h"
#include "ros/features/feature_parameters.h"
#include "ros/joystick/joystick_node.h"
#include "ros/playback/video_player_config.h"
#include "ros/recording/recorder_config.h"
#include "ros/simulation/demo_director.h"
#include "ros/simulation/scope_markers.h"
#include "ros/simulation/servo_simulation_config.h"
#include "ros/simulation/simulated_camera.h"
#include "ros/tracker/tracker_parameters.h"

namespace laparoscope_servo {

namespace {

using parameters::Table;

constexpr char kBegin[] = "<!-- parameters: begin -->\n";
constexpr char kEnd[] = "<!-- parameters: end -->";
constexpr char kMade[] =
    "\nMade by scripts/generate_parameters. A file of yours, loaded after this one, may name only what differs.";

using Rows = std::function<void(Table&)>;  // adds the rows of a file or page

ParameterPage file(const std::string& name, const std::string& heading, const Rows& rows) {
  return {"config/" + name, [=] {
            Table table;
            rows(table);
            return parameters::yamlPage(table, heading + kMade);
          }};
}

ParameterPage page(const std::string& name, const std::string& prefix, const Rows& rows) {
  return {"doc/nodes/" + name, [=] {
            Table table;
            rows(table);
            return parameters::markdownTable(table, prefix);
          }};
}

// Rows of the default configuration, which lives as long as the rows.
template <class Config>
Rows rowsOf() {
  return [config = std::make_shared<Config>()](Table& table) { describe(table, *config); };
}

Rows rowsOfEmulator() {
  return [config = std::make_shared<sim::EmulatorConfig>()](Table& table) { describeEmulator(table, *config); };
}

Rows rowsOfSimulation() {
  return [config = std::make_shared<closed_loop::SimulationConfig>()](Table& table) {
    table.group("simulation", "the simulated world", [&] { describe(table, *config); });
  };
}

Rows rowsOfCamera() {
  return [config = std::make_shared<SimulatedCameraConfig>()](Table& table) { describeCamera(table, *config); };
}

Rows rowsOfDirector() {
  return [config = std::make_shared<DemoConfig>()](Table& table) { describeDirector(table, *config); };
}

}  // namespace

std::vector<ParameterPage> parameterPages() {
  return {
      file("camera.yaml", "Parameters of the node and nodelet `camera`.", rowsOf<CameraConfig>()),
      file("recorder.yaml", "Parameters of the node `recorder`.", rowsOf<RecorderConfig>()),
      file("joystick.yaml", "Parameters of the node `joystick`.", rowsOf<JoystickNodeConfig>()),
      file(
          "tracker.yaml",
          "Parameters of the tracker: of the nodelet (private), and of track_bag (--params lays a file over this one).",
          rowsOf<TrackerParameters>()),
      file("dots.yaml", "Parameters of the nodelet `dots`, and of track_bag --tracker dots.", rowsOf<DotsParameters>()),
      file("contour.yaml", "Parameters of the nodelet `contour`, and of track_bag --tracker contour.",
           rowsOf<ContourParameters>()),
      file("edges.yaml", "Parameters of the nodelet `edges`, and of track_bag --tracker edges.",
           rowsOf<EdgesParameters>()),
      file("points.yaml", "Parameters of the nodelet `points`, and of track_bag --tracker points.",
           rowsOf<PointsParameters>()),
      file("instrument.yaml", "Parameters of the nodelet `instrument`, and of track_bag --tracker instrument.",
           rowsOf<InstrumentParameters>()),
      file("model.yaml", "Parameters of the nodelet `model`, and of track_bag --tracker model.",
           rowsOf<ModelParameters>()),
      file("motion.yaml", "Parameters of the nodelet `motion`, and of track_bag --tracker motion.",
           rowsOf<MotionParameters>()),
      file("controller.yaml", "Parameters of the node `controller`, and of the tool simulate_servo.",
           rowsOf<ControllerNodeConfig>()),
      file("aesop.yaml", "Parameters of the node `aesop`.", rowsOf<AesopParameters>()),
      file("emulator.yaml",
           "Parameters of `aesop_emulator`; the arm's geometry is the group `kinematics` of aesop.yaml.",
           rowsOfEmulator()),
      file("simulation.yaml",
           "Parameters of the node `simulated_camera`. Where the arm stands at the start is in emulator.yaml, its "
           "geometry\n"
           "in aesop.yaml; the node reads those too.",
           rowsOf<sim::SceneConfig>()),
      file("simulate_servo.yaml",
           "What the tool simulate_servo simulates. The controller's parameters are those of controller.yaml.",
           rowsOfSimulation()),
      page("tracker.md", "~", rowsOf<TrackerParameters>()),
      page("dots.md", "~", rowsOf<DotsParameters>()),
      page("contour.md", "~", rowsOf<ContourParameters>()),
      page("edges.md", "~", rowsOf<EdgesParameters>()),
      page("points.md", "~", rowsOf<PointsParameters>()),
      page("instrument.md", "~", rowsOf<InstrumentParameters>()),
      page("model.md", "~", rowsOf<ModelParameters>()),
      page("motion.md", "~", rowsOf<MotionParameters>()),
      page("controller.md", "~", rowsOf<ControllerNodeConfig>()),
      page("aesop.md", "~", rowsOf<AesopParameters>()),
      page("camera.md", "~", rowsOf<CameraConfig>()),
      page("recorder.md", "~", rowsOf<RecorderConfig>()),
      page("joystick.md", "~", rowsOf<JoystickNodeConfig>()),
      page("aesop_emulator.md", "", rowsOfEmulator()),
      page("simulate_servo.md", "", rowsOfSimulation()),
      page("simulated_camera.md", "~", rowsOfCamera()),
      page("video_player.md", "~", rowsOf<VideoPlayerConfig>()),
      page("scope_markers.md", "~", rowsOf<ScopeMarkersConfig>()),
      page("demo_director.md", "~", rowsOfDirector()),
  };
}

std::string withParameters(const ParameterPage& page, const std::string& old) {
  const std::string& name = page.file;
  if (name.size() < 3 || name.substr(name.size() - 3) != ".md") return page.text();
  const std::size_t begin = old.find(kBegin);
  const std::size_t end = old.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos || end < begin)
    throw std::runtime_error(name + " has no lines '" + std::string(kBegin, sizeof kBegin - 2) + "' and '" + kEnd +
                             "'");
  return old.substr(0, begin) + kBegin + page.text() + old.substr(end);
}

}  // namespace laparoscope_servo
