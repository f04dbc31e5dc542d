#include "ros/aesop/insertion_point_file.h"

#include <cmath>
#include <ctime>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include "ros/common/output_file.h"
#include "ros/common/parameters.h"

namespace laparoscope_servo {

namespace {

constexpr double kLargest = 100.0;             // m, rad
constexpr double kResidualTolerance = 0.0005;  // m

template <typename Numbers>
std::string list(const Numbers& numbers) {
  std::ostringstream text;
  text.precision(9);
  for (Eigen::Index k = 0; k < numbers.size(); ++k) text << (k == 0 ? "" : ", ") << numbers.data()[k];
  return text.str();
}

std::string toYaml(const CalibratedInsertionPoint& c) {
  std::ostringstream text;
  text.precision(6);
  text << "# Insertion point, calibrated by the node `aesop`, which loads this file by ~insertion_point_file.\n"
       << "insertion_point: [" << list(c.point) << "]   # m, in aesop_base\n"
       << "covariance: [" << list(c.covariance) << "]   # m^2, row by row\n"
       << "stddev: " << c.stddev << "   # m, along the worst axis\n"
       << "residual: " << c.residual << "   # m, root mean square distance of the shafts from the point\n"
       << "cone: " << c.cone << "   # rad, root mean square of the shafts' directions from their mean\n"
       << "method: " << c.method << '\n'
       << "date: '" << c.date << "'   # UTC\n"
       << "poses: [   # joints 1 to 7 of each, m for prismatic ones, else rad";
  for (const aesop::JointVector& q : c.poses) text << (&q == c.poses.data() ? "" : ",") << "\n  " << list(q);
  text << "]\n";
  return text.str();
}

CalibratedInsertionPoint read(ParameterReader& reader) {
  CalibratedInsertionPoint c;
  std::vector<double> poses;
  parameters::Table table;
  table.numbers("insertion_point", c.point.data(), 3, {-kLargest, kLargest}, "m", "")
      .required("[0.574, -0.079, -0.05]");
  table.numbers("covariance", c.covariance.data(), 9, {-1, 1}, "m^2", "").required("nine of them");
  table.number("stddev", c.stddev, {0, 1}, "m", "").required("0.001");
  table.number("residual", c.residual, {0, 1}, "m", "").required("0.001");
  table.number("cone", c.cone, {0, 1.6}, "rad", "").required("0.1");
  table.choice("method", c.method, {"HAND", "PATTERN"}, "");
  table.text("date", c.date, "").required("2026-01-02T03:04:05Z");
  table.numbers("poses", poses, 0, {-kLargest, kLargest}, "m or rad", "").required("seven for each");
  reader.read(table);
  reader.refuseUnknown("");
  if (reader.has("poses") && (poses.empty() || poses.size() % aesop::kJoints != 0))
    reader.addJudgement({"poses holds " + std::to_string(poses.size()) + " numbers, expected seven for each"});
  for (std::size_t k = 0; k + aesop::kJoints <= poses.size(); k += aesop::kJoints) {
    c.poses.emplace_back(Eigen::Map<const aesop::JointVector>(poses.data() + k));
  }
  return c;
}

}  // namespace

std::string utcDate() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  char text[32];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

double residual(const aesop::Kinematics& kinematics, const std::vector<aesop::JointVector>& poses,
                const Eigen::Vector3d& point) {
  double squares = 0.0;
  for (const aesop::JointVector& q : poses) {
    squares += Eigen::Vector3d(kinematics.endEffector(q).inverse() * point).head<2>().squaredNorm();
  }
  return poses.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(poses.size()));
}

void saveInsertionPoint(const std::string& file, const CalibratedInsertionPoint& calibrated) {
  writeTextFile(file, [&](std::ostream& stream) { stream << toYaml(calibrated); });
}

CalibratedInsertionPoint loadInsertionPoint(const std::string& file, const aesop::Kinematics& kinematics) {
  ParameterReader reader(parametersFromYaml(file), file);
  const CalibratedInsertionPoint c = read(reader);
  if (!reader.errors().empty()) throw std::runtime_error(reader.report());
  const double now = residual(kinematics, c.poses, c.point);
  if (!(std::abs(now - c.residual) <= kResidualTolerance)) {
    std::ostringstream text;
    text << file << ": was calibrated with another table of joints: its shafts pass the point at " << now
         << " m by the one that is configured, expected " << c.residual;
    throw std::runtime_error(text.str());
  }
  return c;
}

}  // namespace laparoscope_servo
