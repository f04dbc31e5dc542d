#include <cmath>
#include <ostream>

#include "laparoscope_servo/closed_loop/servo_simulation.h"
#include "laparoscope_servo/robust/largest.h"

namespace laparoscope_servo::closed_loop {

SimulationSummary summarise(const std::vector<SimulationSample>& samples, const SimulationConfig& config,
                            double offset_bound, double scale_bound) {
  SimulationSummary summary;
  const Eigen::Vector2d target = config.roi.centre();
  const std::size_t rest = samples.size() - samples.size() / 4;  // where the last quarter begins
  double count = 0.0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const SimulationSample& s = samples[k];
    const double offset = (Eigen::Vector2d(s.u, s.v) - target).norm();
    const double scale = std::exp(-s.log_depth) - 1.0;
    const bool settled = offset <= offset_bound && std::abs(scale) <= scale_bound;  // false for NaN
    if (!settled) summary.settling_time = -1.0;
    if (settled && summary.settling_time < 0.0) summary.settling_time = s.t;
    summary.max_lateral_speed = robust::largest(summary.max_lateral_speed, s.lateral_speed);
    summary.max_lateral_offset = robust::largest(summary.max_lateral_offset, s.lateral_offset);
    if (k < rest) continue;
    count += 1.0;
    summary.final_offset += offset * offset;
    summary.final_scale_error += scale * scale;
    summary.final_alpha += s.alpha * s.alpha;
    if (s.command.vector() != Eigen::Vector4d::Zero()) summary.moving_share += 1.0;
  }
  if (count == 0.0) return summary;
  summary.final_offset = std::sqrt(summary.final_offset / count);
  summary.final_scale_error = std::sqrt(summary.final_scale_error / count);
  summary.final_alpha = std::sqrt(summary.final_alpha / count);
  summary.moving_share /= count;
  return summary;
}

void writeCsv(const std::vector<SimulationSample>& samples, std::ostream& stream) {
  stream << "t,pan,tilt,spin,insertion,u,v,log_depth,alpha,d1,d2,lateral_speed_at_insertion_point,"
            "lateral_offset_at_insertion_point,state\n";
  stream.precision(12);
  for (const SimulationSample& s : samples) {
    stream << s.t << ',' << s.command.pan << ',' << s.command.tilt << ',' << s.command.spin << ','
           << s.command.insertion << ',' << s.u << ',' << s.v << ',' << s.log_depth << ',' << s.alpha << ',' << s.d1
           << ',' << s.d2 << ',' << s.lateral_speed << ',' << s.lateral_offset << ',' << name(s.state) << '\n';
  }
}

}  // namespace laparoscope_servo::closed_loop
