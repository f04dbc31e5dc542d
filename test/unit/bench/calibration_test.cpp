// bench/calibration.py with a tracker whose words are known: a script that hands out prepared tables, one for each time
// that it is run.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/videoio.hpp>
#include <sstream>
#include <vector>

#include "support/command_output.h"
#include "support/temporary_folder.h"

namespace laparoscope_servo {
namespace {

struct Said {
  double x = 0.0, y = 0.0;  // px, by which the region has moved
  double corner_error = 0.1, centre_error = 0.1;
  int state = 1;
};

class Calibration : public testing::Test {
 protected:
  void SetUp() override {
    static const int missing = test_support::outputOf("/usr/bin/python3 -c 'import cv2, numpy'").status;
    if (missing != 0) GTEST_SKIP() << "no python3-opencv or python3-numpy";
    std::ofstream script(folder_.file("tracker"));
    script << "#!/bin/bash\ncd '" << folder_.path()
           << "'\nn=$(ls | grep -c '^used')\ncp table$n.csv \"$5\" && : >used$n\n";
    script.close();
    std::filesystem::permissions(folder_.file("tracker"), std::filesystem::perms::owner_all);
  }
  // What the tracker says when it is run for the nth time.
  void says(int n, const std::vector<Said>& images) const {
    std::ofstream table(folder_.file("table" + std::to_string(n) + ".csv"));
    table << "frame,state,g00,g01,g02,g10,g11,g12,g20,g21,g22,visible_fraction,corner_error,centre_error\n";
    for (std::size_t k = 0; k < images.size(); ++k) {
      const Said& s = images[k];
      table << k << ',' << s.state << ",1,0," << s.x << ",0,1," << s.y << ",0,0,1,1," << s.corner_error << ','
            << s.centre_error << '\n';
    }
  }
  std::string film(int images) const {
    const std::string file = folder_.file("film.avi");
    cv::VideoWriter writer(file, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25.0, cv::Size(160, 120));
    for (int k = 0; k < images; ++k) writer.write(cv::Mat(120, 160, CV_8UC3, cv::Scalar(40, 60, 120)));
    std::ofstream(folder_.file("regions.csv")) << "film,roi,from\nfilm.avi,\"30,30,60,50\",0\n";
    return " --data '" + folder_.path() + "' --regions '" + folder_.file("regions.csv") + "'";
  }
  // The numbers of the last line that is printed, after its name: images, then claim, rms, ratio and most, of the
  // corner and of the centre.
  std::vector<double> measure(const std::string& options, const std::string& way) const {
    // The tracker's arguments are SOURCE --roi ROI --csv TABLE.
    const auto output = test_support::outputOf("'" CALIBRATION "' '" + folder_.file("tracker") + "'" + options);
    EXPECT_EQ(output.status, 0) << output.text;
    std::vector<double> numbers;
    const std::size_t at = output.text.rfind(" " + way + " ");
    if (at == std::string::npos) {
      ADD_FAILURE() << output.text;
      return std::vector<double>(9);
    }
    std::istringstream text(output.text.substr(at + way.size() + 2));
    for (double number = 0.0; text >> number;) numbers.push_back(number);
    numbers.resize(9);
    return numbers;
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(Calibration, ComparesClaimsWithTheTruth) {
  std::filesystem::create_directory(folder_.file("frames"));
  std::ofstream(folder_.file("scene.json")) << R"({"roi": [30, 30, 60, 50]})";
  std::ofstream(folder_.file("truth.csv")) << "frame,g00,g01,g02,g10,g11,g12,g20,g21,g22,occluded\n"
                                              "0,1,0,0,0,1,0,0,0,1,0\n1,1,0,2,0,1,0,0,0,1,0\n"
                                              "2,1,0,4,0,1,0,0,0,1,0\n3,1,0,6,0,1,0,0,0,1,0\n";
  says(0, {{}, {2.3, 0.4, 0.25, 0.5}, {99.0, 0.0, 0.25, 0.5, 2}, {6.0, -1.0, 1.0, 0.5}});
  const std::vector<double> n = measure(" --sequence '" + folder_.path() + "'", "truth");
  EXPECT_EQ(n[0], 2.0);  // neither the reference nor what is not tracked
  EXPECT_NEAR(n[1], 0.729, 1e-3);
  EXPECT_NEAR(n[2], 0.791, 1e-3);
  EXPECT_NEAR(n[3], 1.58, 1e-2);  // of 2 and 1
  EXPECT_NEAR(n[4], 2.0, 1e-2);
  EXPECT_NEAR(n[5], 0.5, 1e-3);
  EXPECT_NEAR(n[7], 1.58, 1e-2);  // of 1 and 2
}

TEST_F(Calibration, ComparesTwoMeasurementsWithWhatBothClaim) {
  const std::string options = film(4);
  says(0, {{0.0, 0.0, 0.0, 0.0}, {1.0, 0.0, 0.3, 0.3}, {2.0, 0.0, 0.3, 0.3}, {3.0, 0.0, 0.3, 0.3, 2}});
  says(1, {{0.0, 0.0, 0.0, 0.0}, {2.0, 0.0, 0.4, 0.4}, {2.0, 0.5, 0.4, 0.4}, {90.0, 0.0, 0.4, 0.4}});
  const std::vector<double> n = measure(options + " --way noise_1", "noise_1");
  EXPECT_EQ(n[0], 3.0);
  EXPECT_NEAR(n[1], 0.5, 1e-3);
  EXPECT_NEAR(n[2], 0.791, 1e-3);
  EXPECT_NEAR(n[3], 1.58, 1e-2);
  EXPECT_NEAR(n[4], 2.0, 1e-2);
}

TEST_F(Calibration, ComparesTimeBackwardsWithTheClaimsOfThree) {
  const std::string options = film(4);
  says(0, {{0.0, 0.0, 0.3, 0.3}, {1.0, 0.0, 0.3, 0.3}, {2.0, 0.0, 0.3, 0.3}, {3.0, 0.0, 0.4, 0.4}});
  says(1, {{}, {-1.0, 1.0, 1.2, 1.2}, {-2.0, 1.0, 1.2, 1.2}, {-3.0, 1.0, 1.2, 1.2}});  // of images 3, 2, 1, 0
  const std::vector<double> n = measure(options + " --way backward", "backward");
  EXPECT_EQ(n[0], 3.0);
  EXPECT_NEAR(n[1], 1.3, 1e-3);  // of 0.3, 0.4 and 1.2
  EXPECT_NEAR(n[2], 1.0, 1e-3);
  EXPECT_NEAR(n[4], 0.77, 1e-2);
}

}  // namespace
}  // namespace laparoscope_servo
