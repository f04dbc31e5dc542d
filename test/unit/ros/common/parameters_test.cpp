#include "ros/common/parameters.h"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

using XmlRpc::XmlRpcValue;

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

struct Config {
  double number = 1.5;
  int integer = 3;
  bool flag = true;
  std::string text = "a";
  std::string word = "left";
  std::vector<double> list{1.0};
  std::vector<std::string> names{"kept"};
};

void describe(parameters::Table& table, Config& c) {
  table.number("number", c.number, {0, 2}, "m", "of it");
  table.group("group", "", [&] { table.number("integer", c.integer, {0, 5}, "", "of it"); });
  table.flag("flag", c.flag, "of it");
  table.text("text", c.text, "of it");
  table.choice("word", c.word, {"left", "right"}, "of it");
  table.numbers("list", c.list, 3, {0, 10}, "", "of it");
  table.texts("names", c.names, "of it");
}

std::vector<std::string> validate(const Config& config) {
  std::vector<std::string> errors = parameters::errorsOf(config);
  if (config.flag && config.integer == 5) errors.emplace_back("flag = true beside group/integer = 5");
  return errors;
}

struct Read {
  Config config;
  std::vector<std::string> errors;
};

Read read(const XmlRpcValue& parameters) {
  Read result;
  ParameterReader reader(parameters, "/node");
  parameters::Table table;
  describe(table, result.config);
  reader.read(table);
  result.errors = reader.errors();
  return result;
}

TEST(ParameterReader, KeepsTheDefaultOfWhatIsNotSet) {
  const Read got = read(XmlRpcValue());
  EXPECT_TRUE(got.errors.empty());
  EXPECT_EQ(got.config.number, 1.5);
  EXPECT_EQ(got.config.integer, 3);
  EXPECT_TRUE(got.config.flag);
  EXPECT_EQ(got.config.text, "a");
  EXPECT_EQ(got.config.list, std::vector<double>{1.0});
  EXPECT_EQ(got.config.names, std::vector<std::string>{"kept"});
}

TEST(ParameterReader, ReadsEachType) {
  const Read got =
      read(tree("{group: {integer: 4}, number: 0.25, flag: false, text: 'b', word: right, list: [1, 2.5, 3],"
                " names: [a, '1']}"));
  EXPECT_TRUE(got.errors.empty()) << got.errors.front();
  EXPECT_EQ(got.config.number, 0.25);
  EXPECT_EQ(got.config.integer, 4);
  EXPECT_FALSE(got.config.flag);
  EXPECT_EQ(got.config.text, "b");
  EXPECT_EQ(got.config.word, "right");
  EXPECT_EQ(got.config.list, (std::vector<double>{1.0, 2.5, 3.0}));
  EXPECT_EQ(got.config.names, (std::vector<std::string>{"a", "1"}));
  EXPECT_TRUE(read(tree("names: []")).config.names.empty());
}

TEST(ParameterReader, TakesAnIntegerForANumberButNotTheOtherWay) {
  const Read got = read(tree("{number: 1, group: {integer: 1.0}}"));
  EXPECT_EQ(got.config.number, 1.0);
  EXPECT_EQ(got.config.integer, 3);
  EXPECT_EQ(got.errors, std::vector<std::string>{"/node/group/integer = 1 is a number, expected an integer in [0, 5]"});
}

TEST(ParameterReader, EndsOfARangeAreInItAndNotANumberIsNot) {
  for (const char* good : {"number: 0.0", "number: 2.0", "group: {integer: 0}", "group: {integer: 5}"})
    EXPECT_TRUE(read(tree(good)).errors.empty()) << good;
  for (const char* bad : {"number: -0.001", "number: 2.001", "number: .nan", "number: .inf", "group: {integer: 6}",
                          "list: [1, .nan, 2]"}) {
    const Read got = read(tree(bad));
    EXPECT_EQ(got.errors.size(), 1u) << bad;
    EXPECT_EQ(got.config.number, 1.5) << bad;
    EXPECT_EQ(got.config.integer, 3) << bad;
  }
}

TEST(ParameterReader, NamesNameValueAndExpectation) {
  const std::pair<const char*, const char*> cases[] = {
      {"number: fast", "/node/number = 'fast' is a string, expected a number in [0, 2] m"},
      {"number: 3.0", "/node/number = 3, expected a number in [0, 2] m"},
      {"flag: 1", "/node/flag = 1 is an integer, expected true or false"},
      {"number: [1]", "/node/number is a list, expected a number in [0, 2] m"},
      {"number: {f: 2}", "/node/number is a group of parameters, expected a number in [0, 2] m"},
      {"word: up", "/node/word = 'up', expected one of: left, right"},
      {"text: 5", "/node/text = 5 is an integer, expected a string"},
      {"list: [1, 2]", "/node/list has 2 elements, expected a list of 3 numbers in [0, 10]"},
      {"list: [1, two, 3]", "/node/list[1] = 'two' is a string, expected a list of 3 numbers in [0, 10]"},
      {"list: [1, 2, 30]", "/node/list[2] = 30, expected a list of 3 numbers in [0, 10]"},
      {"list: [1, [2], 3]", "/node/list[1] is a list, expected a list of 3 numbers in [0, 10]"},
      {"list: 4", "/node/list = 4 is an integer, expected a list of 3 numbers in [0, 10]"},
      {"names: a", "/node/names = 'a' is a string, expected a list of strings"},
      {"names: [a, 1]", "/node/names[1] = 1 is an integer, expected a list of strings"}};
  for (const auto& [text, error] : cases) EXPECT_EQ(read(tree(text)).errors, std::vector<std::string>{error}) << text;
}

TEST(ParameterReader, ListsAllErrorsAtOnce) {
  const Read got = read(tree("{number: 3.0, flag: 1, list: [1]}"));
  EXPECT_EQ(got.errors.size(), 3u);
  ParameterReader reader(tree("{number: 3.0, flag: 1, list: [1]}"), "/node");
  Config config;
  reader.readAll(config);
  EXPECT_TRUE(contains(reader.report(), "errors in the parameters:\n")) << reader.report();
}

TEST(ParameterReader, OfANodeJudgesParametersTogether) {
  ParameterReader reader(tree("group: {integer: 5}"), "/node");
  Config config;
  config.list = {1.0, 2.0, 3.0};
  reader.readAll(config);
  EXPECT_EQ(reader.errors(), std::vector<std::string>{"/node/flag = true beside group/integer = 5"});
}

TEST(ParameterReader, RefusesWhatNobodyReads) {
  const XmlRpcValue parameters = tree("{number: 1, unknown: 2, group: {integer: 1, other: 2, deep: {deeper: 3}}}");
  Config config;
  parameters::Table table;
  describe(table, config);
  ParameterReader reader(parameters, "/node");
  reader.read(table);
  reader.refuseUnknown("group");
  EXPECT_EQ(reader.errors(), (std::vector<std::string>{"/node/group/deep/deeper is no parameter of this program",
                                                       "/node/group/other is no parameter of this program"}));
  reader.refuseUnknown("");
  EXPECT_EQ(reader.errors().size(), 3u) << reader.report();
  EXPECT_TRUE(contains(reader.report(), "/node/unknown is no parameter")) << reader.report();
  ParameterReader empty(XmlRpcValue(), "/node");
  empty.refuseUnknown("");
  empty.refuseUnknown("group");
  EXPECT_TRUE(empty.errors().empty());
}

TEST(ParameterReader, NamesWhatAMisspeltParameterIsMostLike) {
  Config config;
  parameters::Table table;
  describe(table, config);
  ParameterReader reader(tree("{group: {intger: 1}, integer: 2, colour_of_the_cart: red}"), "/node");
  reader.read(table);
  reader.refuseUnknown("");
  EXPECT_EQ(reader.errors(), (std::vector<std::string>{
                                 "/node/colour_of_the_cart is no parameter of this program",
                                 "/node/group/intger is no parameter of this program; is /node/group/integer meant?",
                                 "/node/integer is no parameter of this program; is /node/group/integer meant?"}));
}

TEST(ParameterReader, AllowsWhatAnotherTableTellsOf) {
  Config config;
  parameters::Table table;
  describe(table, config);
  ParameterReader reader(tree("{number: 99.0, numbr: 1.0}"), "/node");
  reader.allow(table);
  reader.refuseUnknown("");
  EXPECT_EQ(reader.errors(),
            std::vector<std::string>{"/node/numbr is no parameter of this program; is /node/number meant?"});
}

TEST(ParameterReader, LeavesToLibrariesWhatIsTheirsInTheNamespaceOfANode) {
  Config config;
  parameters::Table table;
  describe(table, config);
  ParameterReader reader(tree("{diagnostic_period: 0.5, overlay: {compressed: {format: png, jpeg_quality: 80}}, "
                              "numbr: 5, group: {}, overly: {wrong: 1}}"),
                         "/node");
  reader.read(table);
  reader.refuseUnknownOfNode();
  EXPECT_EQ(reader.errors(),
            (std::vector<std::string>{"/node/numbr is no parameter of this program; is /node/number meant?",
                                      "/node/overly/wrong is no parameter of this program"}));
}

TEST(ParameterReader, AValueInPlaceOfAGroupHidesNothingElse) {
  Config config;
  parameters::Table table;
  describe(table, config);
  ParameterReader reader(tree("{group: 5}"), "/node");
  reader.read(table);
  EXPECT_EQ(config.integer, 3);
  reader.refuseUnknown("");
  EXPECT_EQ(reader.errors(), std::vector<std::string>{"/node/group is no parameter of this program"});
}

TEST(ParameterReader, RootHasToBeAGroup) {
  ParameterReader reader(XmlRpcValue(5), "/node");
  EXPECT_EQ(reader.errors(), std::vector<std::string>{"/node is an integer, expected a group of parameters"});
}

TEST(ParameterReader, NamesWhatIsMissing) {
  std::string port;
  int baud = 0;
  parameters::Table table;
  table.text("port", port, "of the line").required("/dev/ttyUSB0");
  table.number("baud", baud, {1, 9}, "bit/s", "of the line").required("9");
  ParameterReader reader(tree("{port: x}"), "/node");
  EXPECT_TRUE(reader.has("port"));
  EXPECT_FALSE(reader.has("baud"));
  reader.read(table);
  EXPECT_EQ(reader.errors(),
            std::vector<std::string>{"/node/baud is not set, expected an integer in [1, 9] bit/s, e.g. 9"});
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
