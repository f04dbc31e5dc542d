// The tool simulate_servo as a user runs it.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "support/temporary_folder.h"

namespace {

class SimulateServo : public ::testing::Test {
 protected:
  // Runs the tool; its output, with standard error, and its exit status.
  std::string run(const std::string& arguments) {
    std::FILE* pipe = popen((std::string(SIMULATE_SERVO) + " " + arguments + " 2>&1").c_str(), "r");
    std::string output;
    char buffer[256];
    while (std::fgets(buffer, sizeof(buffer), pipe) != nullptr) output += buffer;
    const int result = pclose(pipe);
    status_ = WIFEXITED(result) ? WEXITSTATUS(result) : -1;
    return output;
  }

  std::string file(const std::string& name) const { return folder_.file(name); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
    return file(name);
  }

  std::string read(const std::string& name) const { return contentOf(file(name)); }

  static std::string contentOf(const std::string& path) {
    std::ifstream stream(path);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  std::vector<std::vector<std::string>> readCsv(const std::string& name) const {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(read(name));
    for (std::string line; std::getline(lines, line);) {
      std::vector<std::string> cells;
      std::istringstream parts(line);
      for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
      rows.push_back(cells);
    }
    return rows;
  }

  const laparoscope_servo::test_support::TemporaryFolder folder_;
  int status_ = -1;
};

const std::string kFiles = std::string("--params ") + LAPAROSCOPE_SERVO_CONFIG + "/controller.yaml --params " +
                           LAPAROSCOPE_SERVO_CONFIG + "/simulate_servo.yaml ";

TEST_F(SimulateServo, ConvergesWithoutPushingTheInsertionPoint) {
  const std::string output = run("--seed 2 --duration 20 --csv " + file("a.csv"));
  EXPECT_EQ(status_, 0) << output;
  EXPECT_NE(output.find("settled to 2 px and 2 % of scale after"), std::string::npos) << output;
  const auto rows = readCsv("a.csv");
  ASSERT_EQ(rows.size(), 1u + 1001u);  // a header, and 50 Hz from 0 to 20 s
  bool moved = false;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    ASSERT_EQ(rows[k].size(), 14u);
    EXPECT_LE(std::stod(rows[k][11]), 1e-9);
    EXPECT_LE(std::stod(rows[k][12]), 1e-9);
    EXPECT_EQ(rows[k][13], "SERVO");
    moved = moved || std::stod(rows[k][1]) != 0.0;
  }
  EXPECT_TRUE(moved);
}

TEST_F(SimulateServo, DefaultFilesChangeNothing) {
  run("--duration 3 --csv " + file("a.csv"));
  const std::string output = run(kFiles + "--duration 3 --csv " + file("b.csv"));
  EXPECT_EQ(status_, 0) << output;
  EXPECT_EQ(read("a.csv"), read("b.csv"));
  EXPECT_GT(read("a.csv").size(), 1000u);
}

TEST_F(SimulateServo, SameSeedSameFile) {
  run("--seed 5 --duration 3 --csv " + file("a.csv"));
  run("--seed 5 --duration 3 --csv " + file("b.csv"));
  run("--seed 6 --duration 3 --csv " + file("c.csv"));
  EXPECT_EQ(read("a.csv"), read("b.csv"));
  EXPECT_NE(read("a.csv"), read("c.csv"));
}

TEST_F(SimulateServo, LaterFilesOverrule) {
  const std::string overlay =
      write("overlay.yaml", "simulation: {start: {pan: 0.0, tilt: 0.0, spin: 0.0, insertion: 0.01}}\n");
  run(kFiles + "--params " + overlay + " --duration 1 --csv " + file("a.csv"));
  EXPECT_EQ(status_, 0);
  EXPECT_NEAR(std::stod(readCsv("a.csv")[1][10]), 0.11, 1e-9);
}

std::string cell(const std::vector<std::vector<std::string>>& rows, std::size_t row, const std::string& column) {
  const auto found = std::find(rows.at(0).begin(), rows.at(0).end(), column);
  return rows.at(row).at(static_cast<std::size_t>(found - rows[0].begin()));
}

double number(const std::vector<std::vector<std::string>>& rows, std::size_t row, const std::string& column) {
  return std::stod(cell(rows, row, column));
}

TEST_F(SimulateServo, SummaryHasALinePerRun) {
  const std::string overlay = write("overlay.yaml",
                                    "simulation: {start: {pan: 0, tilt: 0, spin: 0, insertion: 0},\n"
                                    "             start_spread: {pan: 0.3, tilt: 0.1, spin: 0.2, insertion: 0.01}}\n");
  const std::string output = run("--params " + overlay + " --runs 6 --seed 3 --duration 8 --rest-after 4 --summary " +
                                 file("s.csv") + " --csv " + file("a.csv"));
  ASSERT_EQ(status_, 0) << output;
  const auto rows = readCsv("s.csv");
  ASSERT_EQ(rows.size(), 7u);
  const auto steps = readCsv("a.csv");
  ASSERT_EQ(steps.size(), 402u);
  int refused = 0;
  for (std::size_t k = 1; k <= 6; ++k) {
    ASSERT_EQ(rows[k].size(), rows[0].size());
    EXPECT_EQ(number(rows, k, "seed"), 2.0 + static_cast<double>(k));
    EXPECT_LE(std::abs(number(rows, k, "start_pan")), 0.3);
    EXPECT_LE(std::abs(number(rows, k, "start_tilt")), 0.1);
    EXPECT_LE(std::abs(number(rows, k, "start_spin")), 0.2);
    EXPECT_LE(std::abs(number(rows, k, "start_insertion")), 0.01);
    refused += static_cast<int>(number(rows, k, "refused_starts"));
    EXPECT_EQ(number(rows, k, "settled"), std::max({number(rows, k, "settled_centre"), number(rows, k, "settled_scale"),
                                                    number(rows, k, "settled_orientation")}));
    EXPECT_GE(number(rows, k, "settled"), 0.1);
    EXPECT_LE(number(rows, k, "settled"), 6.0);
    EXPECT_EQ(number(rows, k, "left_image"), 0.0);
    EXPECT_GT(number(rows, k, "centre_rms"), 0.0);
    EXPECT_LT(number(rows, k, "centre_rms"), 1.0);
    EXPECT_LT(number(rows, k, "scale_rms"), 0.01);
    EXPECT_LT(number(rows, k, "orientation_rms"), 0.0087);
    EXPECT_LE(number(rows, k, "moving_share"), 0.5);
    EXPECT_GE(number(rows, k, "reversals"), 0.0);
    EXPECT_LE(number(rows, k, "max_commanded_lateral_speed"), 1e-9);
    EXPECT_LE(number(rows, k, "max_lateral_speed"), 1e-9);
    EXPECT_LE(number(rows, k, "max_lateral_offset"), 1e-9);
    EXPECT_EQ(cell(rows, k, "final_state"), "SERVO");
    EXPECT_EQ(number(rows, k, "stopped"), -1.0);
    EXPECT_EQ(number(rows, k, "holds"), 0.0);
  }
  // Half of these starts do not see the region.
  EXPECT_NE(output.find("6 runs, " + std::to_string(refused) + " starts"), std::string::npos) << output;
  EXPECT_GT(refused, 0);
  // The file of steps is the first run's: same start, same end.
  EXPECT_NEAR(number(steps, 1, "d2"), 0.1 + number(rows, 1, "start_insertion"), 1e-8);
  EXPECT_NEAR(number(steps, 1, "alpha"), -number(rows, 1, "start_spin"), 0.05);
}

TEST_F(SimulateServo, SummaryIsTheSameAgainAndOneByOne) {
  const std::string overlay = write("overlay.yaml", "simulation: {start_spread: {pan: 0.05, spin: 0.2}}\n");
  const std::string arguments = "--params " + overlay + " --duration 2 ";
  run(arguments + "--runs 3 --seed 4 --summary " + file("a.csv"));
  run(arguments + "--runs 3 --seed 4 --summary " + file("b.csv"));
  run(arguments + "--runs 1 --seed 6 --summary " + file("c.csv"));
  ASSERT_EQ(readCsv("a.csv").size(), 4u);
  EXPECT_EQ(read("a.csv"), read("b.csv"));
  ASSERT_EQ(readCsv("c.csv").size(), 2u);
  EXPECT_EQ(readCsv("a.csv")[3], readCsv("c.csv")[1]);
  EXPECT_NE(readCsv("a.csv")[1][1], readCsv("a.csv")[2][1]);
}

TEST_F(SimulateServo, SettlesLaterWithinNarrowerBounds) {
  const auto settled = [this](const std::string& bounds) {
    run("--duration 10 " + bounds + " --summary " + file("s.csv"));
    return readCsv("s.csv");
  };
  const auto rows = settled("");
  for (const auto& [option, column] : {std::pair<const char*, const char*>{"--settled-px 20", "settled_centre"},
                                       {"--settled-scale 10", "settled_scale"},
                                       {"--settled-degrees 5", "settled_orientation"}}) {
    const auto wide = settled(option);
    EXPECT_LT(number(wide, 1, column), number(rows, 1, column)) << option;
    EXPECT_GT(number(wide, 1, column), 0.0) << option;
  }
}

TEST_F(SimulateServo, DurationIsTheFilesUnlessItIsGiven) {
  const std::string overlay = write("overlay.yaml", "simulation: {duration: 1.0}\n");
  run("--params " + overlay + " --csv " + file("a.csv"));
  EXPECT_EQ(readCsv("a.csv").size(), 52u);
  run("--params " + overlay + " --duration 2 --csv " + file("a.csv"));
  EXPECT_EQ(readCsv("a.csv").size(), 102u);
}

TEST_F(SimulateServo, RefusesBadRunsAndBounds) {
  const std::string output =
      run("--runs 0 --settled-px -1 --settled-scale nan --settled-degrees 0 --duration 2 --rest-after 2 --summary " +
          file("s.csv"));
  EXPECT_EQ(status_, 1);
  for (const char* part : {"--runs = 0", "--settled-px", "--settled-scale", "--settled-degrees", "--rest-after"}) {
    EXPECT_NE(output.find(part), std::string::npos) << part << " is not in:\n" << output;
  }
  EXPECT_EQ(read("s.csv"), "");
}

// Every scenario's parameters exist, it starts where the region is seen, and the controller follows, unless what moves
// the picture is wrong: then it stops.
TEST_F(SimulateServo, EveryScenarioRuns) {
  int scenarios = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(LAPAROSCOPE_SERVO_CONFIG) + "/scenarios")) {
    if (entry.path().extension() != ".yaml") continue;
    const std::string output =
        run(kFiles + "--params " + entry.path().string() + " --duration 3 --summary " + file("s.csv"));
    ASSERT_EQ(status_, 0) << entry.path() << '\n' << output;
    const auto rows = readCsv("s.csv");
    ASSERT_EQ(rows.size(), 2u);
    const auto column = std::find(rows[0].begin(), rows[0].end(), "final_state") - rows[0].begin();
    const std::string text = contentOf(entry.path().string());
    // An axis that is a little slow or fast is no fault; one that is reversed is.
    const bool reversed = std::regex_search(text, std::regex("signs:[^\n]*-"));
    const bool faulty = reversed || text.find("picture:") != std::string::npos;
    EXPECT_EQ(rows[1].at(static_cast<std::size_t>(column)) == "SERVO", !faulty) << entry.path();
    ++scenarios;
  }
  EXPECT_GE(scenarios, 35);
}

TEST_F(SimulateServo, AsksForTheCsv) {
  const std::string output = run("--duration 1");
  EXPECT_EQ(status_, 1);
  EXPECT_NE(output.find("csv"), std::string::npos) << output;
}

TEST_F(SimulateServo, ListsAllBadParameters) {
  const std::string bad =
      write("bad.yaml", "gains: {pan: -1, tilt: fast}\nsimulation: {tissue: {distance: .nan}, typo: 3}\n");
  const std::string output = run("--params " + bad + " --duration -4 --csv " + file("a.csv"));
  EXPECT_EQ(status_, 1);
  for (const char* part :
       {"gains/pan = -1", "/gains/tilt = 'fast'", "tissue/distance", "typo is no parameter", "--duration"}) {
    EXPECT_NE(output.find(part), std::string::npos) << part << " is not in:\n" << output;
  }
  EXPECT_EQ(read("a.csv"), "");
}

TEST_F(SimulateServo, SaysWhatIsWrongWithItsArguments) {
  for (const std::string& arguments :
       {"--params /does/not/exist.yaml --csv " + file("a.csv"), std::string("--csv /does/not/exist/a.csv --duration 1"),
        "--sed 4 --csv " + file("a.csv"), "--seed x --csv " + file("a.csv")}) {
    const std::string output = run(arguments);
    EXPECT_EQ(status_, 1) << arguments;
    EXPECT_EQ(output.rfind("simulate_servo: ", 0), 0u) << output;
  }
}

TEST_F(SimulateServo, Helps) {
  EXPECT_NE(run("--help").find("--csv"), std::string::npos);
  EXPECT_EQ(status_, 0);
}

}  // namespace
