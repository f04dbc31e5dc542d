// bench/real.py with a bench_film and a judge whose words are known.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/videoio.hpp>
#include <regex>
#include <sstream>

#include "support/command_output.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

class RealFootage : public testing::Test {
 protected:
  void SetUp() override {
    static const int missing = test_support::outputOf("/usr/bin/python3 -c 'import cv2, numpy'").status;
    if (missing != 0) GTEST_SKIP() << "no python3-opencv or python3-numpy";
    std::filesystem::create_directories(folder_.file("build/bench"));
    // Keeps its arguments, and writes a table for each of two trackers where --tables says.
    program("build/bench/bench_film",
            "echo \"$@\" >'" + folder_.file("arguments") +
                "'\nwhile [ \"$1\" != --tables ]; do shift; done\n"
                "for t in klt ours; do { echo frame,state,processing_time; echo 5,1,9; echo 6,1,0.002; echo 7,1,0.003; "
                "echo 8,1,0.010; echo 9,3,nan; } >\"$2/$t.csv\"; done\n");
    cv::VideoWriter writer(folder_.file("film.avi"), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 20.0,
                           cv::Size(160, 120));
    for (int k = 0; k < 3; ++k) writer.write(cv::Mat(120, 160, CV_8UC3, cv::Scalar(40, 60, 120)));
    std::ofstream(folder_.file("regions.csv")) << "film,roi,from\nfilm.avi,\"30,20,60,50\",5\n";
  }
  void program(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.file(name)) << "#!/bin/bash\n" << text;
    std::filesystem::permissions(folder_.file(name), std::filesystem::perms::owner_all);
  }
  test_support::CommandOutput run(const std::string& options = "") const {
    return test_support::outputOf("'" REAL_FOOTAGE "' '" + folder_.file("build") + "' --data '" + folder_.path() +
                                  "' --checker '" + folder_.file("judge") + "' --regions '" +
                                  folder_.file("regions.csv") + "' " + options);
  }
  std::string contents(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(folder_.file(name)).rdbuf();
    return text.str();
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(RealFootage, ARowIsWhatTheJudgeSaysOfATrackerAndItsTimes) {
  program(
      "judge",
      "[ \"$3 $4\" = '--roi 30,20,60,50' ] || exit 3\n"
      "echo words of another kind\n"
      "case $2 in *ours.csv) e=0.5;; *) e=7.5;; esac\n"
      "echo '{\"tracking\": 0.75, \"wrong\": 2, \"unsupported\": 1, \"longest_seen_run\": 4, \"error_median\": '$e', "
      "\"unavoidable_median\": null}'\n");
  const auto output = run("--limit 9 --tracker ours --json '" + folder_.file("rows.json") + "'");
  EXPECT_EQ(output.status, 0) << output.text;
  EXPECT_NE(contents("arguments").find("film.avi --roi 30,20,60,50 --from 5 --limit 9 --rate 20.0 --tables"),
            std::string::npos)
      << contents("arguments");
  EXPECT_NE(contents("arguments").find("--tracker ours"), std::string::npos);
  // Ours first; the first image, the reference, has no time.
  EXPECT_TRUE(std::regex_search(output.text, std::regex("ours +0.750 +2 +1 +4 +0.50 \\( +-\\) +- +3.00 +9.9\n[^\n]*"
                                                        "klt +0.750 +2 +1 +4 +7.50")))
      << output.text;
  EXPECT_NE(contents("rows.json").find("\"error_median\": 7.5"), std::string::npos) << contents("rows.json");
}

TEST_F(RealFootage, AJudgeThatFailsIsQuoted) {
  program("judge", "echo no such patches >&2; exit 2\n");
  const auto output = run();
  EXPECT_EQ(output.status, 0) << output.text;
  EXPECT_NE(output.text.find("no such patches"), std::string::npos) << output.text;
}

// A tracker that refuses each second region, and keeps where it was asked to track.
class DrawnRegions : public RealFootage {
 protected:
  void SetUp() override {
    RealFootage::SetUp();
    if (IsSkipped()) return;
    program("build/bench/bench_film",
            "film=$1 roi=$3 from=$5\n"
            "while [ \"$1\" != --tables ]; do shift; done\n"
            "n=$(cat '" +
                folder_.file("count") + "' 2>/dev/null || echo 0); echo $((n + 1)) >'" + folder_.file("count") +
                "'\n"
                "state=$((n % 2 ? 1 : 3)); [ $state = 3 ] || echo $roi $from >>'" +
                folder_.file("asked") +
                "'\n"
                "{ echo frame,state,processing_time; echo 0,$state,9; echo 1,$state,0.002; } >\"$2/ours.csv\"\n");
    program("judge",
            "echo '{\"tracking\": 0.5, \"wrong\": 2, \"unsupported\": 1, \"unclear\": 0, \"longest_seen_run\": 0}'\n");
  }
  std::string asked(const std::string& options) {
    for (const char* name : {"asked", "count"}) std::filesystem::remove(folder_.file(name));
    const auto output = run("--limit 2 " + options);
    EXPECT_EQ(output.status, 0) << output.text;
    text_ = output.text;
    return contents("asked");
  }

  std::string text_;  // of the last run
};

TEST_F(DrawnRegions, AreTakenInTheirOrderAndLieInTheFilm) {
  const std::string first = asked("--random 6 --seed 3");
  std::istringstream lines(first);
  int x, y, width, height, from, count = 0;
  for (char comma; lines >> x >> comma >> y >> comma >> width >> comma >> height >> from; ++count) {
    EXPECT_TRUE(x >= 0 && y >= 0 && width >= 40 && height >= 40 && x + width <= 160 && y + height <= 120) << first;
    EXPECT_TRUE(from >= 0 && from <= 1) << first;  // of three images two are wanted
  }
  EXPECT_EQ(count, 6) << first;
  EXPECT_NE(text_.find("6 regions were refused"), std::string::npos) << text_;
  EXPECT_TRUE(std::regex_search(text_, std::regex("all films +ours +0.500 +12 +6 +of 6 TRACKING images of 6 regions")))
      << text_;
  EXPECT_EQ(asked("--random 6 --seed 3"), first);
  EXPECT_NE(asked("--random 6 --seed 4"), first);
}

TEST_F(DrawnRegions, AreWrittenForAnotherBuild) {
  const std::string drawn = asked("--random 3 --keep '" + folder_.file("kept") + "'");
  std::istringstream table(contents("kept/drawn.csv"));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "film,roi,from");
  std::string written;
  std::smatch row;
  while (std::getline(table, line) && std::regex_match(line, row, std::regex("film.avi,\"([0-9,]+)\",([0-9]+)")))
    written += row[1].str() + " " + row[2].str() + "\n";
  EXPECT_EQ(written, drawn);
}

TEST_F(DrawnRegions, FilmsWithoutARegionThatIsTakenAreGivenUp) {
  program("build/bench/bench_film",
          "while [ \"$1\" != --tables ]; do shift; done\n"
          "{ echo frame,state,processing_time; echo 0,3,9; } >\"$2/ours.csv\"\n");
  const auto output = run("--random 2");
  EXPECT_EQ(output.status, 1);
  EXPECT_NE(output.text.find("51 regions were refused, 0 taken"), std::string::npos) << output.text;
}

TEST_F(RealFootage, AFilmThatIsNotThereIsNamed) {
  std::filesystem::remove(folder_.file("film.avi"));
  program("judge", "exit 2\n");
  const auto output = run();
  EXPECT_EQ(output.status, 1);
  EXPECT_NE(output.text.find("film.avi: no such film"), std::string::npos) << output.text;
}

}  // namespace
}  // namespace laparoscope_servo
