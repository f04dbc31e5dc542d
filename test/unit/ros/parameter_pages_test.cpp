#include "ros/parameter_pages.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "ros/aesop/aesop_parameters.h"
#include "ros/common/parameters.h"
#include "ros/controller/controller_parameters.h"
#include "ros/simulation/servo_simulation_config.h"
#include "ros/simulation/simulated_camera.h"
#include "ros/tracker/tracker_parameters.h"

namespace laparoscope_servo {
namespace {

const std::string kFolder = std::string(LAPAROSCOPE_SERVO_CONFIG) + "/..";

std::string contentOf(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(ParameterPages, AreThoseOfTheTables) {
  EXPECT_EQ(parameterPages().size(), 35u);
  for (const ParameterPage& page : parameterPages()) {
    const std::string text = contentOf(kFolder + "/" + page.file);
    ASSERT_FALSE(text.empty()) << page.file;
    EXPECT_EQ(withParameters(page, text), text) << page.file << " differs: run scripts/generate_parameters";
  }
}

TEST(ParameterPages, ReplaceWhatIsBetweenTheMarkersOfAPage) {
  const ParameterPage page{"doc/a.md", [] { return std::string("| new |\n"); }};
  EXPECT_EQ(withParameters(page, "before\n<!-- parameters: begin -->\n| old |\n<!-- parameters: end -->\nafter\n"),
            "before\n<!-- parameters: begin -->\n| new |\n<!-- parameters: end -->\nafter\n");
  EXPECT_THROW(withParameters(page, "no markers\n"), std::runtime_error);
  EXPECT_THROW(withParameters(page, "<!-- parameters: end -->\n<!-- parameters: begin -->\n"), std::runtime_error);
}

// Each file of config/ read back leaves every parameter at its default, and each of its values has a place of its own.
template <class Config>
class FilesTest : public testing::Test {};

std::vector<std::string> filesOf(const TrackerParameters&) {
  return {"tracker.yaml"};
}
std::vector<std::string> filesOf(const ControllerNodeConfig&) {
  return {"controller.yaml"};
}
std::vector<std::string> filesOf(const AesopParameters&) {
  return {"aesop.yaml"};
}
std::vector<std::string> filesOf(const ServoSimulationParameters&) {
  return {"controller.yaml", "simulate_servo.yaml"};
}
std::vector<std::string> filesOf(const sim::SceneConfig&) {
  return {"simulation.yaml"};
}

using Configs = testing::Types<TrackerParameters, ControllerNodeConfig, AesopParameters, ServoSimulationParameters,
                               sim::SceneConfig>;
TYPED_TEST_SUITE(FilesTest, Configs);

template <class Config>
XmlRpc::XmlRpcValue treeOf(const Config& config) {
  XmlRpc::XmlRpcValue tree;
  for (const std::string& file : filesOf(config))
    tree = mergeParameters(tree, parametersFromYaml(std::string(LAPAROSCOPE_SERVO_CONFIG) + "/" + file));
  return tree;
}

TYPED_TEST(FilesTest, ReadBackAreTheDefaults) {
  TypeParam config;
  const XmlRpc::XmlRpcValue tree = treeOf(config);
  parameters::Table table;
  describe(table, config);
  // Away from the defaults first: what the file does not name would stay so.
  std::vector<parameters::Value> defaults;
  for (const parameters::Row& row : table.rows()) {
    defaults.push_back(row.get());
    if (row.kind == parameters::Row::Kind::kNumber) row.set(-123.0);
    if (row.kind == parameters::Row::Kind::kInteger) row.set(-123);
  }
  ParameterReader reader(tree, "/node");
  reader.read(table);
  reader.refuseUnknown("");
  for (const std::string& error : reader.errors())
    EXPECT_NE(error.find(" is not set, expected "), std::string::npos) << error;
  for (std::size_t k = 0; k < defaults.size(); ++k) {
    if (!reader.has(table.rows()[k].name)) {
      EXPECT_FALSE(table.rows()[k].example.empty()) << table.rows()[k].name;
    } else {
      EXPECT_EQ(table.rows()[k].get(), defaults[k]) << table.rows()[k].name;
    }
  }
}

// No two rows stand for one field, and setting one changes nothing else.
TYPED_TEST(FilesTest, EveryRowHasAFieldOfItsOwn) {
  TypeParam config;
  parameters::Table table;
  describe(table, config);
  EXPECT_EQ(table.names().size(), table.rows().size()) << "two rows of one name";
  std::vector<parameters::Value> before;
  for (const parameters::Row& row : table.rows()) before.push_back(row.get());
  for (std::size_t k = 0; k < before.size(); ++k) {
    const parameters::Row& row = table.rows()[k];
    parameters::Value other = before[k];
    if (auto* flag = std::get_if<bool>(&other)) *flag = !*flag;
    if (auto* integer = std::get_if<int>(&other)) *integer += 1;
    if (auto* number = std::get_if<double>(&other)) *number += 0.125;
    if (auto* text = std::get_if<std::string>(&other))
      *text = row.choices.empty() ? "1,2,3,4" : *text == row.choices.back() ? row.choices.front() : row.choices.back();
    if (auto* numbers = std::get_if<std::vector<double>>(&other)) numbers->back() = row.only_whole ? 6.0 : 0.125;
    if (auto* texts = std::get_if<std::vector<std::string>>(&other)) texts->push_back("another");
    row.set(other);
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (i == k) continue;
      EXPECT_EQ(table.rows()[i].get(), before[i]) << row.name << " changes " << table.rows()[i].name;
    }
    EXPECT_EQ(row.get(), other) << row.name;
    row.set(before[k]);
    EXPECT_EQ(row.get(), before[k]) << row.name;
  }
}

TYPED_TEST(FilesTest, DefaultsAreValidAndEveryRowSaysWhatItMeans) {
  TypeParam config;
  parameters::Table table;
  describe(table, config);
  EXPECT_TRUE(table.errors().empty()) << table.errors().front();
  EXPECT_TRUE(validate(config).empty()) << validate(config).front();
  for (const parameters::Row& row : table.rows()) {
    EXPECT_FALSE(row.meaning.empty()) << row.name;
    EXPECT_TRUE(row.meaning.empty() || row.meaning.back() != '.') << row.name;
    EXPECT_EQ(row.meaning.find('|'), std::string::npos) << row.name;
  }
}

}  // namespace
}  // namespace laparoscope_servo
