// Which points find tissue again: for each method of OpenCV's, the share of views of a region in which its matches lead
// to the region, and what that takes of one core. The views are other images of the same film, as they are, turned,
// zoomed, dimmed, veiled, half covered.
#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/version.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "bench/support/arguments.h"
#include "bench/support/scenes.h"
#include "bench/support/sequence.h"
#include "laparoscope_servo/tracking/tracker_config.h"
#include "ros/common/json_writer.h"
#include "tracking/search/coarse_image.h"

namespace laparoscope_servo::bench {

namespace {

constexpr int kMinInliers = 8;
constexpr double kInlier = 4.0;   // px, of the coarse image
constexpr double kNear = 0.2;     // of the region's side: a start from where the alignment gets there
constexpr int kMostOfView = 300;  // points of the reference
constexpr int kMostOfImage = 600;
constexpr double kRatio = 0.85;
constexpr int kSaturation = 250;

struct Method {
  std::string name;
  cv::Ptr<cv::Feature2D> of_image, of_view;
  int norm;
  double around;   // of the region's diagonal: from how far around it points are taken
  int max_pixels;  // of the image that they are drawn from
  bool twice;      // the weaker ones are left away before they are described, which is dear
};

std::vector<Method> methods() {
  std::vector<Method> all;
  const auto add = [&](const std::string& name, int norm, double around, int max_pixels, const auto& create) {
    std::ostringstream text;
    text << name << ", " << max_pixels / 1000 << "k px" << (around > 0.0 ? ", surroundings" : "");
    all.push_back(
        {text.str(), create(kMostOfImage), create(kMostOfView), norm, around, max_pixels, norm == cv::NORM_L2});
  };
  const auto orb = [](int count) { return cv::ORB::create(count, 1.2f, 4, 16, 0, 2, cv::ORB::HARRIS_SCORE, 31, 5); };
  const auto akaze = [](float threshold) {
    return [threshold](int) { return cv::AKAZE::create(cv::AKAZE::DESCRIPTOR_MLDB, 0, 3, threshold, 4, 4); };
  };
  const auto kaze = [](int) { return cv::KAZE::create(false, false, 5e-5f); };
  const auto brisk = [](int) { return cv::BRISK::create(8); };
  for (const double around : {0.0, 0.5}) {
    add("ORB", cv::NORM_HAMMING, around, 150000, orb);
    add("AKAZE 1e-3", cv::NORM_HAMMING, around, 150000, akaze(1e-3f));
    add("AKAZE 1e-5", cv::NORM_HAMMING, around, 150000, akaze(1e-5f));
#if CV_VERSION_MAJOR * 10000 + CV_VERSION_MINOR * 100 >= 40400
    for (const double contrast : {0.04, 0.005}) {
      std::ostringstream name;
      name << "SIFT " << contrast;
      add(name.str(), cv::NORM_L2, around, 60000, [contrast](int) { return cv::SIFT::create(0, 3, contrast); });
    }
#endif
  }
  add("AKAZE 1e-5", cv::NORM_HAMMING, 0.5, 60000, akaze(1e-5f));
  add("KAZE 5e-5", cv::NORM_L2, 0.5, 60000, kaze);
  add("BRISK 8", cv::NORM_HAMMING, 0.5, 150000, brisk);
#if CV_VERSION_MAJOR * 10000 + CV_VERSION_MINOR * 100 >= 40400
  add("SIFT 0.005", cv::NORM_L2, 0.5, 30000, [](int) { return cv::SIFT::create(0, 3, 0.005); });
#endif
  return all;
}

struct Points {
  std::vector<cv::Point2f> at;  // px of the image
  cv::Mat descriptors;
  int scale = 1;
};

// The strongest `most` where `mask`, of the image's size, is not 0; all where it is empty.
Points draw(const cv::Ptr<cv::Feature2D>& detector, const cv::Mat& image, const cv::Mat1b& mask, int max_pixels,
            int most, bool twice) {
  const int scale = tracking::coarseScale(image.size(), max_pixels);
  const tracking::CoarseImage coarse = tracking::coarseImage(image, scale, {0.0f, 1.0f, 0.0f}, kSaturation);
  cv::Mat1b usable = coarse.usable;
  if (!mask.empty()) {
    cv::Mat1b wanted;
    cv::resize(mask, wanted, usable.size(), 0.0, 0.0, cv::INTER_NEAREST);
    usable &= wanted;
  }
  std::vector<cv::KeyPoint> found;
  Points points;
  points.scale = scale;
  if (twice) {
    detector->detect(coarse.grey, found, usable);
    cv::KeyPointsFilter::retainBest(found, most);
    detector->compute(coarse.grey, found, points.descriptors);
  } else {
    cv::Mat all;
    detector->detectAndCompute(coarse.grey, usable, found, all);
    std::vector<int> order(found.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<int>(k);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return found[a].response > found[b].response; });
    order.resize(std::min<std::size_t>(order.size(), most));
    std::vector<cv::KeyPoint> kept;
    for (const int k : order) {
      kept.push_back(found[k]);
      points.descriptors.push_back(all.row(k));
    }
    found = kept;
  }
  for (const cv::KeyPoint& point : found) points.at.push_back(coarse.inImage(point.pt));
  return points;
}

// Whether the matches lead to where the region is.
enum class Verdict { kFound, kNothing, kWrong };

Verdict judge(const Points& view, const Points& image, int norm, const Eigen::Matrix3d& truth,
              const geometry::Rectangle& roi) {
  if (view.at.size() < kMinInliers || image.at.size() < kMinInliers) return Verdict::kNothing;
  std::vector<std::vector<cv::DMatch>> forth;
  std::vector<cv::DMatch> back;
  const cv::BFMatcher matcher(norm);
  matcher.knnMatch(view.descriptors, image.descriptors, forth, 2);
  matcher.match(image.descriptors, view.descriptors, back);
  std::vector<cv::Point2f> from, to;
  for (const auto& pair : forth) {
    if (pair.size() < 2 || !(pair[0].distance < kRatio * pair[1].distance)) continue;
    if (back[pair[0].trainIdx].trainIdx != pair[0].queryIdx) continue;
    from.push_back(view.at[pair[0].queryIdx]);
    to.push_back(image.at[pair[0].trainIdx]);
  }
  if (from.size() < kMinInliers) return Verdict::kNothing;
  cv::Mat agree;
  const cv::Mat motion = cv::estimateAffinePartial2D(from, to, agree, cv::RANSAC, kInlier * image.scale, 1000, 0.99);
  if (motion.empty() || cv::countNonZero(agree) < kMinInliers) return Verdict::kNothing;
  Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
  for (int r = 0; r < 2; ++r) {
    for (int c = 0; c < 3; ++c) g(r, c) = motion.at<double>(r, c);
  }
  const double side = std::sqrt(std::abs(geometry::signedArea(geometry::apply(truth, roi.corners()))));
  return cornerError(g, truth, roi) < kNear * side ? Verdict::kFound : Verdict::kWrong;
}

std::vector<Change> changes() {
  return {{"as it is"},
          {"turn 30", 30.0},
          {"turn 60", 60.0},
          {"turn 90", 90.0},
          {"scale 0.6", 5.0, 0.6},
          {"scale 0.75, turn 40", -40.0, 0.75},
          {"scale 1.35, turn 40", 40.0, 1.35},
          {"scale 1.6", 5.0, 1.6},
          {"gain 0.5", 0.0, 1.0, 0.5},
          {"veil 40 %", 0.0, 1.0, 1.0, 0.4},
          {"half covered", 0.0, 1.0, 1.0, 0.0, true}};
}

struct Tally {
  int trials = 0, found = 0, wrong = 0;
  double drawing = 0.0, matching = 0.0;                  // s
  std::map<std::string, std::pair<int, int>> by_change;  // found, of
};

void measure(const Method& method, const Scene& scene, Tally& tally) {
  const double margin = method.around * std::hypot(scene.roi.width, scene.roi.height);
  cv::Mat1b mask = cv::Mat1b::zeros(scene.reference.size());
  const cv::Rect wanted(cv::Point(cvRound(scene.roi.x - margin), cvRound(scene.roi.y - margin)),
                        cv::Size(cvRound(scene.roi.width + 2 * margin), cvRound(scene.roi.height + 2 * margin)));
  mask(wanted & cv::Rect(cv::Point(0, 0), mask.size())).setTo(255);
  const Points view = draw(method.of_view, scene.reference, mask, method.max_pixels, kMostOfView, method.twice);
  std::mt19937 random(1);
  for (std::size_t k = 0; k < scene.images.size(); ++k) {
    for (const Change& change : changes()) {
      Eigen::Matrix3d truth = scene.g[k];
      const cv::Mat image = changed(scene.images[k], change, scene.roi, truth, random, random);
      const double start = threadSeconds();
      const Points seen = draw(method.of_image, image, cv::Mat1b(), method.max_pixels, kMostOfImage, method.twice);
      const double drawn = threadSeconds();
      const Verdict verdict = judge(view, seen, method.norm, truth, scene.roi);
      tally.matching += threadSeconds() - drawn;
      tally.drawing += drawn - start;
      ++tally.trials;
      auto& [found, of] = tally.by_change[change.name];
      ++of;
      found += verdict == Verdict::kFound ? 1 : 0;
      tally.found += verdict == Verdict::kFound ? 1 : 0;
      tally.wrong += verdict == Verdict::kWrong ? 1 : 0;
    }
  }
}

int program(int argc, char** argv) {
  namespace po = boost::program_options;
  std::vector<std::string> films;
  std::string file;
  int count = 4;
  double seconds = 20.0;
  po::options_description options("Which points find tissue again. bench_search [options] FILM:x,y,w,h ...");
  options.add_options()("help", "this text")                                                       //
      ("film", po::value(&films), "FILM:x,y,w,h or FILM@N:x,y,w,h, any number")                    //
      ("images", po::value(&count)->default_value(4), "of each film")                              //
      ("seconds", po::value(&seconds)->default_value(20.0), "of each film, from which they come")  //
      ("json", po::value(&file), "write everything there");
  const auto complete = [&] { return !films.empty() && count >= 1; };
  if (const auto status = parse(argc, argv, options, "film", -1, complete)) return *status;
  cv::setNumThreads(1);
  std::vector<Scene> scenes;
  for (const std::string& film : films) scenes.push_back(trackedScene(film, count, seconds));
  std::ofstream stream = create(file);
  JsonWriter json(stream);
  json.beginObject();
  json.beginArray("methods");
  for (const Method& method : methods()) {
    Tally t;
    for (const Scene& scene : scenes) measure(method, scene, t);
    const double recall = static_cast<double>(t.found) / t.trials;
    const double drawing = 1e3 * t.drawing / t.trials;
    const double matching = 1e3 * t.matching / t.trials;
    std::cout << std::left << std::setw(36) << method.name << std::right << std::fixed << " recall "
              << std::setprecision(3) << recall << ", wrong " << t.wrong << " of " << t.trials << ", ms "
              << std::setprecision(1) << drawing << " + " << matching << ", recall per ms " << std::setprecision(4)
              << recall / (drawing + matching) << std::defaultfloat << std::endl;
    json.beginObject();
    json.value("name", method.name);
    json.value("recall", recall);
    json.value("wrong", static_cast<double>(t.wrong) / t.trials);
    json.value("drawing_ms", drawing);
    json.value("matching_ms", matching);
    json.beginObject("changes");
    for (const auto& [name, share] : t.by_change) json.value(name, static_cast<double>(share.first) / share.second);
    json.end();
    json.end();
  }
  json.end();
  json.end();
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_search", [&] { return laparoscope_servo::bench::program(argc, argv); });
}
