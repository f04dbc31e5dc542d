#include "ros/common/parameters.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <stdexcept>

#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

using XmlRpc::XmlRpcValue;

const double kInfinity = std::numeric_limits<double>::infinity();

// A YAML file that lives as long as the object.
class File {
 public:
  explicit File(const std::string& text) { std::ofstream(name()) << text; }
  std::string name() const { return folder_.file("parameters.yaml"); }

 private:
  const test_support::TemporaryFolder folder_;
};

XmlRpcValue tree(const std::string& text) {
  return parametersFromYaml(File(text).name());
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ParameterReader, KeepsTheDefaultOfWhatIsNotSet) {
  ParameterReader reader(XmlRpcValue(), "/node");
  double number = 1.5;
  int integer = 3;
  bool flag = true;
  std::string text = "a";
  std::vector<double> list{1.0};
  reader.read("number", number, 0.0, 2.0);
  reader.read("group/integer", integer, 0, 5);
  reader.read("flag", flag);
  reader.read("text", text);
  reader.read("list", list, 1, 0.0, 2.0);
  EXPECT_EQ(number, 1.5);
  EXPECT_EQ(integer, 3);
  EXPECT_TRUE(flag);
  EXPECT_EQ(text, "a");
  EXPECT_EQ(list, std::vector<double>{1.0});
  EXPECT_EQ(reader.report(), "");
}

TEST(ParameterReader, ReadsEachType) {
  ParameterReader reader(tree("{group: {number: 0.25, integer: 4}, flag: true, text: 'word', list: [1, 2.5]}"),
                         "/node");
  double number = 0.0;
  int integer = 0;
  bool flag = false;
  std::string text;
  std::vector<double> list;
  reader.read("group/number", number, 0.0, 2.0);
  reader.read("group/integer", integer, 0, 5);
  reader.read("flag", flag);
  reader.read("text", text);
  reader.read("list", list, 0, 0.0, 5.0);
  EXPECT_EQ(reader.report(), "");
  EXPECT_EQ(number, 0.25);
  EXPECT_EQ(integer, 4);
  EXPECT_TRUE(flag);
  EXPECT_EQ(text, "word");
  EXPECT_EQ(list, (std::vector<double>{1.0, 2.5}));
}

TEST(ParameterReader, TakesAnIntegerForANumberButNotTheOtherWay) {
  ParameterReader reader(tree("{a: 1, b: 1.0}"), "/node");
  double a = 0.0;
  int b = 7;
  reader.read("a", a, 0.0, 2.0);
  reader.read("b", b, 0, 2);
  EXPECT_EQ(a, 1.0);
  EXPECT_EQ(b, 7);
  ASSERT_EQ(reader.errors().size(), 1u);
  EXPECT_TRUE(contains(reader.errors()[0], "/node/b = 1")) << reader.errors()[0];
}

TEST(ParameterReader, BoundsAreInclusiveAndCatchNotANumber) {
  const std::string text = "{low: 0.0, high: 2.0, below: -0.001, above: 2.001, nan: .nan, inf: .inf, int_high: 6}";
  ParameterReader reader(tree(text), "/node");
  double value = 9.0;
  reader.read("low", value, 0.0, 2.0);
  EXPECT_EQ(value, 0.0);
  reader.read("high", value, 0.0, 2.0);
  EXPECT_EQ(value, 2.0);
  EXPECT_TRUE(reader.errors().empty());
  for (const char* name : {"below", "above", "nan", "inf"}) reader.read(name, value, 0.0, 2.0);
  int integer = 1;
  reader.read("int_high", integer, 0, 5);
  EXPECT_EQ(value, 2.0);
  EXPECT_EQ(integer, 1);
  EXPECT_EQ(reader.errors().size(), 5u) << reader.report();
  reader.read("nan", value, -kInfinity, kInfinity);
  EXPECT_EQ(reader.errors().size(), 6u) << reader.report();
}

TEST(ParameterReader, NamesNameValueAndExpectation) {
  ParameterReader reader(tree("{a: fast, b: 3.0, c: 1, d: [1], e: {f: 2}, g: up, h: 5}"), "/node");
  double number = 0.0;
  bool flag = false;
  std::string word = "left";
  reader.read("a", number, 0.0, 2.0);
  reader.read("b", number, 0.0, 2.0);
  reader.read("c", flag);
  reader.read("d", number, 0.0, 2.0);
  reader.read("e", number, 0.0, 2.0);
  reader.read("g", word, {"left", "right"});
  reader.read("h", word);
  const std::vector<std::string> expected{"/node/a = 'fast' is a string, expected a number from 0 to 2",
                                          "/node/b = 3, expected a number from 0 to 2",
                                          "/node/c = 1 is an integer, expected true or false",
                                          "/node/d is a list, expected a number from 0 to 2",
                                          "/node/e is a group of parameters, expected a number from 0 to 2",
                                          "/node/g = 'up', expected one of: left, right",
                                          "/node/h = 5 is an integer, expected a string"};
  EXPECT_EQ(reader.errors(), expected);
  EXPECT_EQ(number, 0.0);
  EXPECT_EQ(word, "left");
  EXPECT_TRUE(contains(reader.report(), "7 errors in the parameters:\n"));
}

TEST(ParameterReader, WithoutBoundsItAsksForANumber) {
  ParameterReader reader(tree("{a: fast}"), "/node");
  double number = 0.0;
  reader.read("a", number, -kInfinity, kInfinity);
  EXPECT_EQ(reader.errors(), std::vector<std::string>{"/node/a = 'fast' is a string, expected a number"});
}

TEST(ParameterReader, ListsAreCheckedElementByElement) {
  ParameterReader reader(tree("{short: [1, 2], wrong: [1, two, 3], far: [1, 2, 30], scalar: 4, good: [1, 2, 3]}"),
                         "/node");
  std::vector<double> list{0.0};
  for (const char* name : {"short", "wrong", "far", "scalar"}) {
    reader.read(name, list, 3, 0.0, 10.0);
    EXPECT_EQ(list, std::vector<double>{0.0}) << name;
  }
  EXPECT_EQ(reader.errors().size(), 4u);
  EXPECT_TRUE(contains(reader.report(), "/node/short has 2 elements, expected a list of 3 numbers")) << reader.report();
  EXPECT_TRUE(contains(reader.report(), "/node/wrong[1] = 'two' is a string")) << reader.report();
  EXPECT_TRUE(contains(reader.report(), "/node/far[2] = 30")) << reader.report();
  reader.read("good", list, 3, 0.0, 10.0);
  EXPECT_EQ(list, (std::vector<double>{1.0, 2.0, 3.0}));
}

TEST(ParameterReader, ListsOfStrings) {
  std::vector<std::string> value{"kept"};
  ParameterReader good(tree("names: [a, '1']\nnone: []"), "/node");
  good.read("absent", value);
  EXPECT_EQ(value, (std::vector<std::string>{"kept"}));
  good.read("names", value);
  EXPECT_EQ(value, (std::vector<std::string>{"a", "1"}));
  good.read("none", value);
  EXPECT_TRUE(value.empty());
  EXPECT_TRUE(good.errors().empty()) << good.report();

  value = {"kept"};
  ParameterReader bad(tree("name: a\nmixed: [a, 1]"), "/node");
  bad.read("name", value);
  bad.read("mixed", value);
  ASSERT_EQ(bad.errors().size(), 2u);
  EXPECT_TRUE(contains(bad.errors()[0], "/node/name = 'a'")) << bad.errors()[0];
  EXPECT_TRUE(contains(bad.errors()[1], "/node/mixed[1] = 1")) << bad.errors()[1];
  EXPECT_EQ(value, (std::vector<std::string>{"kept"}));
}

TEST(ParameterReader, RefusesWhatNobodyReads) {
  const XmlRpcValue parameters = tree("{known: 1, unknown: 2, group: {known: 1, other: 2, deep: {deeper: 3}}}");
  ParameterReader reader(parameters, "/node");
  int value = 0;
  reader.read("known", value, 0, 9);
  reader.read("group/known", value, 0, 9);
  reader.read("group/absent", value, 0, 9);
  reader.refuseUnknown("group");
  EXPECT_EQ(reader.errors(), (std::vector<std::string>{"/node/group/deep/deeper is no parameter of this program",
                                                       "/node/group/other is no parameter of this program"}));
  ParameterReader root(parameters, "/node");
  root.read("known", value, 0, 9);
  root.refuseUnknown("");
  EXPECT_EQ(root.errors().size(), 4u) << root.report();
  EXPECT_TRUE(contains(root.report(), "/node/unknown is no parameter")) << root.report();
  ParameterReader empty(XmlRpcValue(), "/node");
  empty.refuseUnknown("");
  empty.refuseUnknown("group");
  EXPECT_TRUE(empty.errors().empty());
}

TEST(ParameterReader, NamesWhatAMisspeltParameterIsMostLike) {
  ParameterReader reader(tree("{limits: {velocty: 1.0}, velocity: 2.0, colour_of_the_cart: red}"), "/node");
  double value = 0.0;
  reader.read("limits/velocity", value, 0.0, 9.0);
  reader.read("limits/acceleration", value, 0.0, 9.0);
  reader.refuseUnknown("");
  EXPECT_EQ(
      reader.errors(),
      (std::vector<std::string>{"/node/colour_of_the_cart is no parameter of this program",
                                "/node/limits/velocty is no parameter of this program; is /node/limits/velocity meant?",
                                "/node/velocity is no parameter of this program; is /node/limits/velocity meant?"}));
}

TEST(ParameterReader, LeavesToLibrariesWhatIsTheirsInTheNamespaceOfANode) {
  ParameterReader reader(tree("{diagnostic_period: 0.5, overlay: {compressed: {format: png, jpeg_quality: 80}}, "
                              "rte: 5, group: {}, overly: {wrong: 1}}"),
                         "/node");
  double value = 0.0;
  reader.read("rate", value, 0.0, 9.0);
  reader.refuseUnknownOfNode();
  EXPECT_EQ(reader.errors(),
            (std::vector<std::string>{"/node/overly/wrong is no parameter of this program",
                                      "/node/rte is no parameter of this program; is /node/rate meant?"}));
}

TEST(ParameterReader, AValueInPlaceOfAGroupHidesNothingElse) {
  ParameterReader reader(tree("{group: 5}"), "/node");
  double value = 1.0;
  reader.read("group/value", value, 0.0, 9.0);
  EXPECT_EQ(value, 1.0);
  reader.refuseUnknown("");
  EXPECT_EQ(reader.errors(), std::vector<std::string>{"/node/group is no parameter of this program"});
}

TEST(ParameterReader, RootHasToBeAGroup) {
  ParameterReader reader(XmlRpcValue(5), "/node");
  EXPECT_EQ(reader.errors(), std::vector<std::string>{"/node is an integer, expected a group of parameters"});
}

TEST(ParameterReader, RequireNamesWhatIsMissing) {
  ParameterReader reader(tree("{port: x}"), "/node");
  EXPECT_TRUE(reader.has("port"));
  EXPECT_FALSE(reader.has("baud"));
  reader.require("port", "a device");
  reader.require("baud", "a rate");
  EXPECT_EQ(reader.errors(), std::vector<std::string>{"/node/baud is not set, expected a rate"});
}

TEST(ParametersFromYaml, ReadsScalarsAsRosparamDoes) {
  XmlRpcValue t = tree("{i: 3, d: 3.0, e: 1e3, b: false, s: word, q: '3', l: [], m: {}}");
  EXPECT_EQ(t["i"].getType(), XmlRpcValue::TypeInt);
  EXPECT_EQ(t["d"].getType(), XmlRpcValue::TypeDouble);
  EXPECT_EQ(t["e"].getType(), XmlRpcValue::TypeDouble);
  EXPECT_EQ(t["b"].getType(), XmlRpcValue::TypeBoolean);
  EXPECT_EQ(t["s"].getType(), XmlRpcValue::TypeString);
  EXPECT_EQ(t["q"].getType(), XmlRpcValue::TypeString);
  EXPECT_EQ(t["l"].getType(), XmlRpcValue::TypeArray);
  EXPECT_EQ(t["l"].size(), 0);
  EXPECT_EQ(t["m"].getType(), XmlRpcValue::TypeStruct);
}

TEST(ParametersFromYaml, AnEmptyFileSetsNothing) {
  ParameterReader reader(tree("# nothing\n"), "/node");
  EXPECT_TRUE(reader.errors().empty());
}

TEST(ParametersFromYaml, NamesTheFileThatCannotBeUsed) {
  EXPECT_THROW(parametersFromYaml("/does/not/exist.yaml"), std::runtime_error);
  const File broken("a: [1, 2\nb: }");
  const File list("[1, 2]");
  for (const File* file : {&broken, &list}) {
    try {
      parametersFromYaml(file->name());
      ADD_FAILURE() << "no error";
    } catch (const std::runtime_error& error) {
      EXPECT_TRUE(contains(error.what(), file->name())) << error.what();
    }
  }
}

TEST(MergeParameters, OverlayWinsKeyByKey) {
  XmlRpcValue merged =
      mergeParameters(tree("{a: 1, g: {x: 1, y: 2, l: [1, 2, 3]}}"), tree("{g: {y: 5, z: 6, l: [9]}, b: 7}"));
  EXPECT_EQ(static_cast<int>(merged["a"]), 1);
  EXPECT_EQ(static_cast<int>(merged["b"]), 7);
  EXPECT_EQ(static_cast<int>(merged["g"]["x"]), 1);
  EXPECT_EQ(static_cast<int>(merged["g"]["y"]), 5);
  EXPECT_EQ(static_cast<int>(merged["g"]["z"]), 6);
  EXPECT_EQ(merged["g"]["l"].size(), 1);
}

TEST(MergeParameters, NothingIsNeutral) {
  const XmlRpcValue base = tree("{a: 1}");
  EXPECT_EQ(mergeParameters(base, XmlRpcValue()), base);
  EXPECT_EQ(mergeParameters(XmlRpcValue(), base), base);
}

}  // namespace
}  // namespace laparoscope_servo
