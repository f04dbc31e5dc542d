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

TEST_F(RealFootage, AFilmThatIsNotThereIsNamed) {
  std::filesystem::remove(folder_.file("film.avi"));
  program("judge", "exit 2\n");
  const auto output = run();
  EXPECT_EQ(output.status, 1);
  EXPECT_NE(output.text.find("film.avi: no such film"), std::string::npos) << output.text;
}

}  // namespace
}  // namespace laparoscope_servo
