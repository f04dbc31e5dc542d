#include "ros/aesop/insertion_point_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "support/error_text.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

using test_support::errorText;

const aesop::Kinematics kKinematics{aesop::KinematicsConfig()};

CalibratedInsertionPoint example() {
  CalibratedInsertionPoint c;
  c.point = Eigen::Vector3d(0.574123456, -0.079, -0.05);
  c.covariance = Eigen::Vector3d(1e-8, 2e-8, 3e-7).asDiagonal();
  c.covariance(0, 1) = c.covariance(1, 0) = 5e-9;
  c.stddev = 0.00055;
  c.cone = 0.12;
  c.method = "HAND";
  c.date = utcDate();
  aesop::JointVector q;
  q << 0.25, -0.9, 1.5, 0.0, 0.01, 0.02, 0.3;
  c.poses = {q, 1.01 * q, 0.99 * q};
  c.residual = residual(kKinematics, c.poses, c.point);
  return c;
}

std::string contentOf(const std::string& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

TEST(InsertionPointFile, WhatIsSavedIsLoaded) {
  const test_support::TemporaryFolder folder;
  const std::string file = folder.file("point.yaml");
  const CalibratedInsertionPoint saved = example();
  saveInsertionPoint(file, saved);
  const CalibratedInsertionPoint loaded = loadInsertionPoint(file, kKinematics);
  EXPECT_LT((loaded.point - saved.point).norm(), 1e-9);
  EXPECT_LT((loaded.covariance - saved.covariance).norm(), 1e-14);
  EXPECT_NEAR(loaded.stddev, saved.stddev, 1e-8);
  EXPECT_NEAR(loaded.residual, saved.residual, 1e-7);
  EXPECT_NEAR(loaded.cone, saved.cone, 1e-6);
  EXPECT_EQ(loaded.method, saved.method);
  EXPECT_EQ(loaded.date, saved.date);
  ASSERT_EQ(loaded.poses.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LT((loaded.poses[k] - saved.poses[k]).norm(), 1e-8);
}

TEST(InsertionPointFile, DateIsUtcInIso8601) {
  EXPECT_TRUE(std::regex_match(utcDate(), std::regex("20\\d\\d-\\d\\d-\\d\\dT\\d\\d:\\d\\d:\\d\\dZ"))) << utcDate();
}

TEST(InsertionPointFile, ReplacesAsAWholeOrNotAtAll) {
  const test_support::TemporaryFolder folder;
  const std::string file = folder.file("point.yaml");
  saveInsertionPoint(file, example());
  CalibratedInsertionPoint other = example();
  other.method = "PATTERN";
  saveInsertionPoint(file, other);
  EXPECT_EQ(loadInsertionPoint(file, kKinematics).method, "PATTERN");

  const std::string before = contentOf(file);
  std::filesystem::create_directory(file + ".partial");  // so that the new file cannot be made
  EXPECT_NE(errorText<std::runtime_error>([&] {
              saveInsertionPoint(file, example());
            }).find("'" + file + "' cannot be written"),
            std::string::npos);
  EXPECT_EQ(contentOf(file), before);
  std::filesystem::remove(file + ".partial");

  const std::string folder_name = folder.file("a_folder");
  std::filesystem::create_directory(folder_name);
  EXPECT_NE(errorText<std::runtime_error>([&] { saveInsertionPoint(folder_name, example()); }).find("a_folder"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_name + ".partial")) << "nothing is left behind";
  EXPECT_NE(errorText<std::runtime_error>([&] {
              saveInsertionPoint(folder.file("no/such/point.yaml"), example());
            }).find("No such file"),
            std::string::npos);
}

TEST(InsertionPointFile, SaysWhatIsWrongInAFile) {
  const test_support::TemporaryFolder folder;
  const std::string file = folder.file("point.yaml");
  saveInsertionPoint(file, example());
  const std::string good = contentOf(file);
  const auto errorWith = [&](const std::string& pattern, const std::string& text) {
    std::ofstream(file) << std::regex_replace(good, std::regex(pattern), text);
    const std::string error = errorText<std::runtime_error>([&] { loadInsertionPoint(file, kKinematics); });
    EXPECT_NE(error.find(file), std::string::npos) << "names the file: " << error;
    return error;
  };
  EXPECT_NE(errorWith("insertion_point: \\[[^,]*,", "insertion_point: [").find("has 2 elements, expected"),
            std::string::npos);
  EXPECT_NE(errorWith("insertion_point: \\[[^,]*,", "insertion_point: [.nan,").find("insertion_point"),
            std::string::npos);
  EXPECT_NE(errorWith("method: HAND", "method: FOOT").find("'FOOT', expected one of: HAND, PATTERN"),
            std::string::npos);
  EXPECT_NE(errorWith("stddev: [^ ]*", "stddev: -1").find("stddev = -1"), std::string::npos);
  EXPECT_NE(errorWith("date: [^ ]*", "day: 'x'").find("date"), std::string::npos);
  EXPECT_NE(errorWith("cone: [^ ]*", "kone: 0.1").find("kone"), std::string::npos);
  EXPECT_NE(errorWith("poses:[^]*", "poses: []\n").find("poses"), std::string::npos);
  EXPECT_NE(errorWith("poses:[^]*", "poses: [1, 2]\n").find("holds 2 numbers, expected seven"), std::string::npos);
  EXPECT_NE(errorWith("poses:[^]*", "").find("poses"), std::string::npos);
  EXPECT_NE(errorWith("[^]*", "").find("insertion_point"), std::string::npos) << "an empty file";
  EXPECT_NE(errorWith("[^]*", "{").find("point.yaml"), std::string::npos);
  EXPECT_NE(errorWith("[^]*", "just words").find("mapping"), std::string::npos);
  EXPECT_NE(errorText<std::runtime_error>([&] {
              loadInsertionPoint(folder.file("absent.yaml"), kKinematics);
            }).find("absent.yaml"),
            std::string::npos);
}

TEST(InsertionPointFile, RefusesPosesOfOtherKinematics) {
  const test_support::TemporaryFolder folder;
  const std::string file = folder.file("point.yaml");
  saveInsertionPoint(file, example());
  aesop::KinematicsConfig other;
  other.joints[1].a += 0.01;
  const std::string error = errorText<std::runtime_error>([&] { loadInsertionPoint(file, aesop::Kinematics(other)); });
  EXPECT_NE(error.find("another table of joints"), std::string::npos) << error;
  other = aesop::KinematicsConfig();
  other.scope_length = 0.35;  // behind O_7, where the shafts are the same
  EXPECT_EQ(errorText<std::runtime_error>([&] { loadInsertionPoint(file, aesop::Kinematics(other)); }), "");
}

}  // namespace
}  // namespace laparoscope_servo
