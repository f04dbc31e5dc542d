// The tool simulate_servo as a user runs it.
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace {

class SimulateServo : public ::testing::Test {
 protected:
  void SetUp() override {
    char name[] = "/tmp/simulate_servo_XXXXXX";
    ASSERT_NE(mkdtemp(name), nullptr);
    folder_ = name;
  }
  void TearDown() override { std::system(("rm -r " + folder_).c_str()); }

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

  std::string file(const std::string& name) const { return folder_ + "/" + name; }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
    return file(name);
  }

  std::string read(const std::string& name) const {
    std::ifstream stream(file(name));
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

  std::string folder_;
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
