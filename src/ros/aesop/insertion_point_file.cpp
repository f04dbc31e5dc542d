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

void readPoses(ParameterReader& reader, const std::string& file, std::vector<aesop::JointVector>& poses) {
  std::vector<double> numbers;
  reader.require("poses", "joint positions, seven numbers each");
  reader.read("poses", numbers, 0, -kLargest, kLargest);
  if (reader.has("poses") && (numbers.empty() || numbers.size() % aesop::kJoints != 0)) {
    reader.addError(file + "/poses holds " + std::to_string(numbers.size()) + " numbers, expected seven for each");
  }
  for (std::size_t k = 0; k + aesop::kJoints <= numbers.size(); k += aesop::kJoints) {
    poses.emplace_back(Eigen::Map<const aesop::JointVector>(numbers.data() + k));
  }
}

CalibratedInsertionPoint read(ParameterReader& reader, const std::string& file) {
  CalibratedInsertionPoint c;
  std::vector<double> point;
  std::vector<double> covariance;
  for (const char* number : {"stddev", "residual", "cone"}) reader.require(number, "a number");
  reader.require("insertion_point", "three numbers, m");
  reader.require("covariance", "nine numbers, m^2");
  reader.require("date", "when it was calibrated");
  reader.read("insertion_point", point, 3, -kLargest, kLargest);
  reader.read("covariance", covariance, 9, -1.0, 1.0);
  reader.read("stddev", c.stddev, 0.0, 1.0);
  reader.read("residual", c.residual, 0.0, 1.0);
  reader.read("cone", c.cone, 0.0, 1.6);
  reader.read("method", c.method, std::vector<std::string>{"HAND", "PATTERN"});
  reader.read("date", c.date);
  readPoses(reader, file, c.poses);
  reader.refuseUnknown("");
  if (point.size() == 3) c.point = Eigen::Vector3d(point.data());
  if (covariance.size() == 9) c.covariance = Eigen::Matrix3d(covariance.data());
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
  const CalibratedInsertionPoint c = read(reader, file);
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
