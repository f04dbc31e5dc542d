#include "laparoscope_servo/parameters/pages.h"

#include <gtest/gtest.h>

#include <limits>

namespace laparoscope_servo::parameters {
namespace {

struct Config {
  std::string port;
  double rate = 25.0;
  int levels = 3;
  std::string frame;
  double axis[3] = {0.0, 0.5, -1.0};
  double low = 1e-6;
  double high = 1e9;
};

void describe(Table& table, Config& c) {
  table.text("port", c.port, "of the line").required("/dev/ttyUSB0");
  table.number("rate", c.rate, Range::above(0.0, 100.0), "Hz", "of the images").whileRunning();
  table.group("group", "what belongs together", [&] {
    table.number("levels", c.levels, {1, 6}, "", "of the pyramid");
    table.choice("frame", c.frame, {"", "a"}, "of tf");
    table.group("inner", "", [&] {
      table.numbers("axis", c.axis, 3, Range::finite(), "m", "which way is up");
      table.number("low", c.low, {0, 1}, "s", "the least");
      table.number("high", c.high, {0, 1e9}, "s", "the most").atLeast("low");
    });
  });
}

TEST(Pages, YamlHoldsDefaultsWithUnitRangeAndMeaning) {
  Config config;
  Table table;
  describe(table, config);
  EXPECT_EQ(yamlPage(table, "One line.\nAnother."),
            "# One line.\n"
            "# Another.\n"
            "\n"
            "# port: /dev/ttyUSB0  # of the line\n"
            "rate: 25.0            # Hz, (0, 100]: of the images. May change while it runs.\n"
            "\n"
            "group:                      # what belongs together\n"
            "  levels: 3                 # [1, 6]: of the pyramid\n"
            "  frame: ''                 # nothing, a: of tf\n"
            "  inner:\n"
            "    axis: [0.0, 0.5, -1.0]  # m: which way is up\n"
            "    low: 1.0e-06            # s, [0, 1]: the least\n"
            "    high: 1.0e+09           # s, [0, 1e+09], at least low: the most\n");
}

TEST(Pages, MarkdownHasALineForEachParameterAndGroup) {
  Config config;
  Table table;
  describe(table, config);
  EXPECT_EQ(markdownTable(table, "~"),
            "| parameter | type | default | range | unit | meaning |\n"
            "| --- | --- | --- | --- | --- | --- |\n"
            "| `~port` | string | required |  |  | of the line |\n"
            "| `~rate` | double | 25 | (0, 100] | Hz | of the images. May change while it runs. |\n"
            "| **`~group/`** | | | | | *what belongs together* |\n"
            "| `~group/levels` | int | 3 | [1, 6] |  | of the pyramid |\n"
            "| `~group/frame` | string | empty | nothing, `a` |  | of tf |\n"
            "| `~group/inner/axis` | 3 doubles | 0, 0.5, -1 |  | m | which way is up |\n"
            "| `~group/inner/low` | double | 1e-06 | [0, 1] | s | the least |\n"
            "| `~group/inner/high` | double | 1e+09 | [0, 1e+09], at least `low` | s | the most |\n");
}

TEST(YamlText, IsReadBackAsWhatItWas) {
  EXPECT_EQ(yamlText(true), "true");
  EXPECT_EQ(yamlText(3), "3");
  EXPECT_EQ(yamlText(3.0), "3.0");
  EXPECT_EQ(yamlText(std::string("word_1")), "word_1");
  EXPECT_EQ(yamlText(std::string("off")), "'off'");
  EXPECT_EQ(yamlText(std::string("3")), "'3'");
  EXPECT_EQ(yamlText(std::string("/frame")), "'/frame'");
  EXPECT_EQ(yamlText(std::string()), "''");
  EXPECT_EQ(yamlText(std::vector<double>{1.0, 0.5}), "[1.0, 0.5]");
  EXPECT_EQ(yamlText(std::vector<double>{}), "[]");
  EXPECT_EQ(yamlText(std::vector<std::string>{"a", ""}), "[a, '']");
}

}  // namespace
}  // namespace laparoscope_servo::parameters
