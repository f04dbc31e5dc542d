#include "laparoscope_servo/closed_loop/servo_runs.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <random>
#include <stdexcept>

#include "laparoscope_servo/robust/largest.h"
#include "laparoscope_servo/robust/median.h"

namespace laparoscope_servo::closed_loop {

namespace {

constexpr int kMaxDraws = 10000;
constexpr double kDegree = M_PI / 180.0;

// Finds the time from which a value stays within its bound; NaN is outside.
class Settling {
 public:
  explicit Settling(double bound) : bound_(bound) {}
  void add(double time, double value) {
    if (!(std::abs(value) <= bound_)) {
      since_ = -1.0;
    } else if (since_ < 0.0) {
      since_ = time;
    }
  }
  double since() const { return since_; }

 private:
  double bound_;
  double since_ = -1.0;
};

class Reversals {
 public:
  void add(const Eigen::Vector4d& command) {
    for (int k = 0; k < 4; ++k) {
      if (command[k] == 0.0) continue;
      if (command[k] * last_[k] < 0.0) ++count_;
      last_[k] = std::copysign(1.0, command[k]);
    }
  }
  int count() const { return count_; }

 private:
  Eigen::Vector4d last_ = Eigen::Vector4d::Zero();
  int count_ = 0;
};

// Displacements of the scope, and what stops it.
class Stopping {
 public:
  Stopping(double from, const Eigen::Vector4d& start) : from_(from), place_(start) {}
  void add(const SimulationSample& s, RunSummary& run) {
    const bool ended = s.state == servo::ControllerState::kLost || s.state == servo::ControllerState::kFault;
    if (ended && run.stopped < 0.0) run.stopped = s.t;
    if (s.state == servo::ControllerState::kHold && before_ != servo::ControllerState::kHold) ++run.holds;
    if (!ended && s.state != servo::ControllerState::kIdle) {
      run.evidence = robust::largest(run.evidence, s.evidence);
      run.unconfirmed = robust::largest(run.unconfirmed, s.unconfirmed);
      run.leash = robust::largest(run.leash, s.leash);
    }
    before_ = s.state;
    const Eigen::Vector4d place = place_ + s.moved;
    if (s.t <= from_) {
      start_ = s.moved;
      off_ = place;
    }
    const Eigen::Vector4d way = s.moved - start_;
    run.turned = robust::largest(robust::largest(run.turned, way.head<2>().norm()), std::abs(way[2]));
    run.inserted = robust::largest(run.inserted, std::abs(way[3]));
    run.turned_away = robust::largest(run.turned_away, place.head<2>().norm() - off_.head<2>().norm());
    run.turned_away = robust::largest(run.turned_away, std::abs(place[2]) - std::abs(off_[2]));
    run.inserted_away = robust::largest(run.inserted_away, std::abs(place[3]) - std::abs(off_[3]));
  }

 private:
  double from_;
  Eigen::Vector4d place_;                          // displacement of the start from the reference pose
  Eigen::Vector4d off_ = Eigen::Vector4d::Zero();  // displacement from the reference pose at from_
  servo::ControllerState before_ = servo::ControllerState::kIdle;
  Eigen::Vector4d start_ = Eigen::Vector4d::Zero();
};

// Adds a sample to the figures of rest, which are sums until they are divided.
void addRest(const SimulationSample& s, double offset, double scale, RunSummary& run) {
  run.centre_rms += offset * offset;
  run.scale_rms += scale * scale;
  run.orientation_rms += s.alpha * s.alpha;
  if (s.command.vector() != Eigen::Vector4d::Zero()) run.moving_share += 1.0;
}

void divideRest(double count, RunSummary& run) {
  run.centre_rms = std::sqrt(run.centre_rms / count);
  run.scale_rms = std::sqrt(run.scale_rms / count);
  run.orientation_rms = std::sqrt(run.orientation_rms / count);
  run.moving_share /= count;
}

// Prints "median, 95 %, worst", by nearest rank; infinity means never, NaN not observable.
void printSpread(const std::string& name, std::vector<double> values, const std::string& unit, std::ostream& stream) {
  std::replace_if(
      values.begin(), values.end(), [](double v) { return std::isnan(v); }, std::numeric_limits<double>::infinity());
  stream << name << ": median ";
  const auto print = [&](double value) {
    if (std::isinf(value)) {
      stream << '-';
    } else {
      stream << value << unit;
    }
  };
  print(robust::nearestRank(values, 0.5));
  stream << ", 95 % ";
  print(robust::nearestRank(values, 0.95));
  stream << ", worst ";
  print(robust::nearestRank(values, 1.0));
  stream << '\n';
}

}  // namespace

DrawnStart drawStart(const SimulationConfig& config, unsigned seed) {
  DrawnStart drawn;
  drawn.start = config.start;
  const Eigen::Vector4d spread = config.start_spread.vector();
  if (spread == Eigen::Vector4d::Zero()) return drawn;
  // Other random numbers than those of the noise, and defined by the standard, see Noise in servo_simulation.cpp.
  std::seed_seq sequence{seed, 1u};
  std::mt19937 random(sequence);
  const auto uniform = [&random] { return (static_cast<double>(random()) + 0.5) / 2147483648.0 - 1.0; };
  SimulationConfig candidate = config;
  for (; drawn.refused < kMaxDraws; ++drawn.refused) {
    Eigen::Vector4d start = config.start.vector();
    for (int k = 0; k < 4; ++k) start[k] += uniform() * spread[k];
    candidate.start = drawn.start = scope::Velocity::fromVector(start);
    if (startSeesRoi(candidate)) return drawn;
  }
  throw std::invalid_argument("of " + std::to_string(kMaxDraws) +
                              " starts within simulation/start_spread none sees the region of interest");
}

RunSummary summariseRun(const std::vector<SimulationSample>& samples, const SimulationConfig& config,
                        const RunBounds& bounds) {
  RunSummary run;
  Settling centre(bounds.centre), scale(bounds.scale), orientation(bounds.orientation), slant(bounds.slant);
  Reversals reversals;
  const bool freezes = config.picture.frozen_from < samples.back().t;
  Stopping stopping(freezes ? config.picture.frozen_from : 0.0, config.start.vector());
  double count = 0.0;
  for (const SimulationSample& s : samples) {
    const double offset = (Eigen::Vector2d(s.u, s.v) - config.roi.centre()).norm();
    const double scale_error = std::exp(-s.log_depth) - 1.0;
    centre.add(s.t, offset);
    scale.add(s.t, scale_error);
    orientation.add(s.t, s.alpha);
    slant.add(s.t, s.slant);
    run.slant = s.slant;
    if (run.normal_error < 0.0 && !std::isnan(s.normal_error)) run.normal_error = s.normal_error;
    run.left_image = run.left_image || !(s.worst_corner >= 0.0);
    run.max_commanded_lateral_speed = robust::largest(run.max_commanded_lateral_speed, s.commanded_lateral_speed);
    run.max_lateral_speed = robust::largest(run.max_lateral_speed, s.lateral_speed);
    run.max_lateral_offset = robust::largest(run.max_lateral_offset, s.lateral_offset);
    run.final_state = s.state;
    stopping.add(s, run);
    if (s.t < bounds.rest_after) continue;
    count += 1.0;
    addRest(s, offset, scale_error, run);
    reversals.add(s.command.vector());
  }
  run.settled_centre = centre.since();
  run.settled_scale = scale.since();
  run.settled_orientation = orientation.since();
  run.faced = slant.since();
  if (std::min({run.settled_centre, run.settled_scale, run.settled_orientation}) >= 0.0) {
    run.settled = std::max({run.settled_centre, run.settled_scale, run.settled_orientation});
  }
  run.reversals = reversals.count();
  divideRest(count, run);
  return run;
}

void writeRuns(const std::vector<RunSummary>& runs, std::ostream& stream) {
  stream << "seed,start_pan,start_tilt,start_spin,start_insertion,refused_starts,settled,settled_centre,settled_scale,"
            "settled_orientation,left_image,centre_rms,scale_rms,orientation_rms,moving_share,reversals,"
            "max_commanded_lateral_speed,max_lateral_speed,max_lateral_offset,final_state,stopped,holds,"
            "turned,inserted,turned_away,inserted_away,evidence,unconfirmed,leash,faced,slant,normal_error\n";
  stream.precision(9);
  for (const RunSummary& r : runs) {
    const scope::Velocity& start = r.drawn.start;
    stream << r.seed << ',' << start.pan << ',' << start.tilt << ',' << start.spin << ',' << start.insertion << ','
           << r.drawn.refused << ',' << r.settled << ',' << r.settled_centre << ',' << r.settled_scale << ','
           << r.settled_orientation << ',' << (r.left_image ? 1 : 0) << ',' << r.centre_rms << ',' << r.scale_rms << ','
           << r.orientation_rms << ',' << r.moving_share << ',' << r.reversals << ',' << r.max_commanded_lateral_speed
           << ',' << r.max_lateral_speed << ',' << r.max_lateral_offset << ',' << name(r.final_state) << ','
           << r.stopped << ',' << r.holds << ',' << r.turned << ',' << r.inserted << ',' << r.turned_away << ','
           << r.inserted_away << ',' << r.evidence << ',' << r.unconfirmed << ',' << r.leash << ',' << r.faced << ','
           << r.slant << ',' << r.normal_error << '\n';
  }
}

void printRuns(const std::vector<RunSummary>& runs, const RunBounds& bounds, std::ostream& stream) {
  int refused = 0, left = 0, settled = 0, stopped = 0, held = 0;
  std::string failed;
  for (const RunSummary& run : runs) {
    refused += run.drawn.refused;
    left += run.left_image ? 1 : 0;
    settled += run.settled >= 0.0 ? 1 : 0;
    stopped += run.stopped >= 0.0 ? 1 : 0;
    held += run.holds;
    if (run.settled < 0.0) failed += ' ' + std::to_string(run.seed);
  }
  stream << runs.size() << " runs, " << refused << " starts that do not see the region were drawn again, " << left
         << " runs left the image\nsettled to " << bounds.centre << " px, " << 100.0 * bounds.scale
         << " % of scale and " << bounds.orientation / kDegree << " deg: " << settled << '\n';
  if (!failed.empty()) stream << "not settled, seeds:" << failed << '\n';
  const auto all = [&runs](const std::function<double(const RunSummary&)>& value) {
    std::vector<double> values;
    for (const RunSummary& run : runs) values.push_back(value(run));
    return values;
  };
  printSpread("after", all([](const RunSummary& r) {
                return r.settled < 0.0 ? std::numeric_limits<double>::infinity() : r.settled;
              }),
              " s", stream);
  stream << "from " << bounds.rest_after << " s on\n";
  printSpread("  centre rms", all([](const RunSummary& r) { return r.centre_rms; }), " px", stream);
  printSpread("  scale rms", all([](const RunSummary& r) { return 100.0 * r.scale_rms; }), " %", stream);
  printSpread("  spin rms", all([](const RunSummary& r) { return r.orientation_rms / kDegree; }), " deg", stream);
  printSpread("  moving", all([](const RunSummary& r) { return 100.0 * r.moving_share; }), " % of the time", stream);
  printSpread("  reversals", all([](const RunSummary& r) { return static_cast<double>(r.reversals); }), "", stream);
  stream << "stopped: " << stopped << ", held: " << held << '\n';
  printSpread("  turned", all([](const RunSummary& r) { return r.turned / kDegree; }), " deg", stream);
  printSpread("  inserted", all([](const RunSummary& r) { return 1e3 * r.inserted; }), " mm", stream);
  printSpread("  turned away", all([](const RunSummary& r) { return r.turned_away / kDegree; }), " deg", stream);
  printSpread("  inserted away", all([](const RunSummary& r) { return 1e3 * r.inserted_away; }), " mm", stream);
  printSpread("  evidence of a fault", all([](const RunSummary& r) { return r.evidence; }), "", stream);
  printSpread("  share of the motion allowed unseen", all([](const RunSummary& r) { return r.unconfirmed; }), "",
              stream);
  printSpread("  share of the leash", all([](const RunSummary& r) { return r.leash; }), "", stream);
  if (runs.front().normal_error >= 0.0) {
    stream << "the image plane against the tissue\n";
    printSpread("  error of the normal", all([](const RunSummary& r) { return r.normal_error / kDegree; }), " deg",
                stream);
    printSpread("  slant at the end", all([](const RunSummary& r) { return r.slant / kDegree; }), " deg", stream);
    printSpread("  below the bound after", all([](const RunSummary& r) {
                  return r.faced < 0.0 ? std::numeric_limits<double>::infinity() : r.faced;
                }),
                " s", stream);
  }
  stream << "at the insertion point\n";
  printSpread("  commanded lateral speed", all([](const RunSummary& r) { return r.max_commanded_lateral_speed; }),
              " m/s", stream);
  printSpread("  true lateral speed", all([](const RunSummary& r) { return r.max_lateral_speed; }), " m/s", stream);
  printSpread("  lateral offset", all([](const RunSummary& r) { return r.max_lateral_offset; }), " m", stream);
}

}  // namespace laparoscope_servo::closed_loop
