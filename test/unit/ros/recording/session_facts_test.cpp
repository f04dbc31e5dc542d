#include "ros/recording/session_facts.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <fstream>

#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

TEST(SessionFacts, HoldVersionsParametersAndTheFilesThatTheseName) {
  const test_support::TemporaryFolder folder;
  std::ofstream(folder.file("trocar.yaml")) << "insertion_point:\n  x: 0.1\n";
  std::ofstream(folder.file("notes.txt")) << "not a parameter file";
  XmlRpc::XmlRpcValue parameters;
  parameters["aesop"]["insertion_point_file"] = folder.file("trocar.yaml");
  parameters["aesop"]["notes"] = folder.file("notes.txt");
  parameters["aesop"]["gone"] = "/nowhere/x.yaml";
  parameters["aesop"]["rate"] = 50;
  parameters["aesop"]["gain"] = 0.5;
  parameters["aesop"]["on"] = true;
  parameters["aesop"]["odd"] = "a: \"b\"\n<b>";
  parameters["aesop"]["list"][0] = 1.5;
  parameters["grabber"]["password"] = "secret";

  const std::string text = sessionFacts(parameters);
  EXPECT_EQ(text.find("secret"), std::string::npos);
  const YAML::Node facts = YAML::Load(text);
  EXPECT_FALSE(facts["versions"]["opencv"].as<std::string>().empty());
  EXPECT_FALSE(facts["versions"]["laparoscope_servo"].as<std::string>().empty());
  const YAML::Node aesop = facts["parameters"]["aesop"];
  EXPECT_EQ(aesop["rate"].as<int>(), 50);
  EXPECT_EQ(aesop["gain"].as<double>(), 0.5);
  EXPECT_TRUE(aesop["on"].as<bool>());
  EXPECT_EQ(aesop["odd"].as<std::string>(), "a: \"b\"\n<b>");
  EXPECT_EQ(aesop["list"][0].as<double>(), 1.5);
  ASSERT_EQ(facts["files"].size(), 1u);
  const auto content = YAML::Load(facts["files"][folder.file("trocar.yaml")].as<std::string>());
  EXPECT_EQ(content["insertion_point"]["x"].as<double>(), 0.1);
}

TEST(SessionFacts, WithoutParametersAreVersionsAlone) {
  const YAML::Node facts = YAML::Load(sessionFacts({}));
  EXPECT_TRUE(facts["parameters"].IsNull());
  EXPECT_EQ(facts["files"].size(), 0u);
}

}  // namespace
}  // namespace laparoscope_servo
