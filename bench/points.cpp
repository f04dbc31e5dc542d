// Points of texture, beside OpenCV's pyramidal Lucas-Kanade alone, from the same corners, in one run, on one thread: on
// drawn tissue whose motion is known, and on films there and back, where what comes back elsewhere was wrong on the
// way. Times are of the processor.
#include "laparoscope_servo/features/points.h"

#include <boost/program_options.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iomanip>
#include <iostream>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "bench/support/arguments.h"
#include "bench/support/cpu_clock.h"
#include "bench/support/sequence.h"
#include "bench/support/statistics.h"
#include "laparoscope_servo/geometry/homography.h"
#include "test/support/synthetic_tissue.h"

namespace laparoscope_servo::bench {

namespace {

using features::PointTracker;
using features::State;

struct Claim {
  bool is_made = false;
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  // px
};

// A tracker of points, of those that it was given first.
class Follower {
 public:
  virtual ~Follower() = default;
  virtual std::string name() const = 0;
  virtual void select(const cv::Mat& image, const std::vector<Eigen::Vector2d>& places) = 0;
  virtual void track(const cv::Mat& image, double stamp) = 0;
  virtual Claim claim(std::size_t k) const = 0;
};

class Ours : public Follower {
 public:
  std::string name() const override { return "ours"; }
  // Those that it does not take, since where they are nothing tells, are never claimed.
  void select(const cv::Mat& image, const std::vector<Eigen::Vector2d>& places) override {
    std::vector<Eigen::Vector2d> taken;
    index_.assign(places.size(), -1);
    for (std::size_t k = 0; k < places.size(); ++k) {
      PointTracker trial;
      try {
        trial.select(image, 0.0, {{cv::Mat(), {places[k]}}});
      } catch (const std::invalid_argument&) {
        continue;
      }
      index_[k] = static_cast<int>(taken.size());
      taken.push_back(places[k]);
    }
    if (!taken.empty()) tracker_.select(image, 0.0, {{cv::Mat(), taken}});
  }
  void track(const cv::Mat& image, double stamp) override { tracker_.track(image, stamp); }
  Claim claim(std::size_t k) const override {
    if (index_[k] < 0) return {};
    const features::PointResult& point = tracker_.result().points[static_cast<std::size_t>(index_[k])];
    return {point.state == State::kTracking, point.place};
  }

 private:
  PointTracker tracker_;
  std::vector<int> index_;
};

class Klt : public Follower {
 public:
  std::string name() const override { return "OpenCV KLT"; }
  void select(const cv::Mat& image, const std::vector<Eigen::Vector2d>& places) override {
    grey(image, last_);
    places_.clear();
    for (const Eigen::Vector2d& p : places) places_.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
    lost_.assign(places.size(), 0);
  }
  void track(const cv::Mat& image, double) override {
    grey(image, now_);
    cv::calcOpticalFlowPyrLK(last_, now_, places_, next_, status_, cv::noArray(), cv::Size(21, 21), 3);
    for (std::size_t k = 0; k < next_.size(); ++k) {
      if (status_[k] == 0) lost_[k] = 1;
    }
    places_.swap(next_);
    cv::swap(last_, now_);
  }
  Claim claim(std::size_t k) const override { return {lost_[k] == 0, {places_[k].x, places_[k].y}}; }

 private:
  static void grey(const cv::Mat& image, cv::Mat& to) { cv::cvtColor(image, to, cv::COLOR_BGR2GRAY); }
  cv::Mat last_, now_;
  std::vector<cv::Point2f> places_, next_;
  std::vector<unsigned char> status_, lost_;
};

using Make = std::function<std::unique_ptr<Follower>()>;
const Make kFollowers[] = {[] { return std::make_unique<Ours>(); }, [] { return std::make_unique<Klt>(); }};

struct Row {
  std::string scene, name;
  std::vector<double> errors, ms;
  std::size_t points = 0, kept = 0, wrong = 0;
};

void print(const Row& row) {
  std::cout << std::left << std::setw(34) << row.scene << std::setw(12) << row.name << std::right << std::fixed
            << std::setw(7) << row.points << std::setw(7) << row.kept << std::setw(7) << row.wrong
            << std::setprecision(3) << std::setw(9) << quantile(row.errors, 0.5) << std::setw(9)
            << quantile(row.errors, 0.95) << std::setw(9) << quantile(row.ms, 0.5) << std::endl;
}

constexpr double kWrong = 2.0;  // px

// Half a period of light, turn, zoom and shift; `cover`: a grey shaft that crosses.
void drawn(const std::string& name, int images, bool cover, double gain) {
  const cv::Mat scene = test::tissue({640, 480}, 31);
  const auto motion = [&](int k) {
    const Eigen::Vector2d middle(320.0, 240.0), shift(40.0 * std::sin(0.11 * k), 25.0 * std::sin(0.07 * k));
    Eigen::Matrix3d g = Eigen::Matrix3d::Identity();
    g.topLeftCorner<2, 2>() =
        (1.0 + 0.25 * std::sin(0.05 * k)) * Eigen::Rotation2Dd(0.3 * std::sin(0.06 * k)).toRotationMatrix();
    g.topRightCorner<2, 1>() = middle + shift - g.topLeftCorner<2, 2>() * middle;
    return g;
  };
  const auto image = [&](int k) {
    cv::Mat picture = test::view(scene, motion(k), 1.0 + (gain - 1.0) * 0.5 * (1.0 - std::cos(0.08 * k)), 0.0, 2.0,
                                 static_cast<unsigned>(k + 1));
    if (cover && k > 0) {
      const int x = -100 + 12 * k;
      cv::fillConvexPoly(picture, std::vector<cv::Point>{{x, 0}, {x + 90, 0}, {x - 10, 479}, {x - 100, 479}},
                         cv::Scalar(80, 80, 80), cv::LINE_AA);
    }
    return picture;
  };
  const cv::Mat first = image(0);
  const auto places = features::findCorners(first, {120, 100, 400, 280}, 60, {});
  std::vector<std::unique_ptr<Follower>> followers;
  std::vector<Row> rows;
  for (const Make& make : kFollowers) {
    followers.push_back(make());
    followers.back()->select(first, places);
    rows.push_back({name, followers.back()->name(), {}, {}, places.size()});
  }
  for (int k = 1; k < images; ++k) {
    const cv::Mat picture = image(k);
    for (std::size_t i = 0; i < followers.size(); ++i) {
      const std::size_t f = (i + static_cast<std::size_t>(k)) % followers.size();
      const double start = cpuTime();
      followers[f]->track(picture, 0.04 * k);
      rows[f].ms.push_back(1e3 * (cpuTime() - start));
      const bool is_last = k + 1 == images;
      for (std::size_t p = 0; p < places.size(); ++p) {
        const Claim claim = followers[f]->claim(p);
        if (!claim.is_made) continue;
        const double error = (claim.place - geometry::apply(motion(k), places[p])).norm();
        rows[f].errors.push_back(error);
        if (is_last) ++rows[f].kept;
        if (is_last && !(error < kWrong)) ++rows[f].wrong;
      }
    }
  }
  for (const Row& row : rows) print(row);
}

// Green: came back; red: came back elsewhere, with a line to where it was first.
void drawReturns(cv::Mat& canvas, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const auto point = [](const Eigen::Vector2d& p) {
    return cv::Point(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
  };
  const bool good = (from - to).norm() < kWrong;
  cv::circle(canvas, point(from), 4, good ? cv::Scalar(0, 220, 0) : cv::Scalar(0, 0, 255), 1, cv::LINE_AA);
  if (!good) cv::line(canvas, point(from), point(to), cv::Scalar(0, 0, 255), 1, cv::LINE_AA);
}

void film(const std::string& path, int from, int images, const std::string& pictures) {
  Sequence sequence(path);
  std::vector<cv::Mat> read;
  cv::Mat image;
  for (int k = 0; k < from + images && sequence.next(image); ++k) {
    if (k >= from) read.push_back(image.clone());
  }
  const std::string name = std::filesystem::path(path).stem().string() + '@' + std::to_string(from);
  const auto places = features::findCorners(read.front(), {}, 60, {});
  if (places.empty()) {
    std::cout << name << ": no corners\n";
    return;
  }
  for (const Make& make : kFollowers) {
    const auto there = make(), back = make();
    there->select(read.front(), places);
    Row row{name, there->name(), {}, {}, places.size()};
    for (std::size_t k = 1; k < read.size(); ++k) {
      const double start = cpuTime();
      there->track(read[k], 0.04 * static_cast<double>(k));
      row.ms.push_back(1e3 * (cpuTime() - start));
    }
    std::vector<Eigen::Vector2d> turning, started;
    for (std::size_t p = 0; p < places.size(); ++p) {
      const Claim claim = there->claim(p);
      if (!claim.is_made) continue;
      turning.push_back(claim.place);
      started.push_back(places[p]);
    }
    row.kept = turning.size();
    cv::Mat canvas = read.front().clone(), end = read.back().clone();
    if (!turning.empty()) {
      back->select(read.back(), turning);
      for (std::size_t k = read.size() - 1; k-- > 0;) back->track(read[k], 0.04 * static_cast<double>(read.size() - k));
    }
    for (std::size_t p = 0; p < turning.size(); ++p) {
      const Claim claim = back->claim(p);
      drawReturns(end, turning[p], turning[p]);
      if (!claim.is_made) continue;
      const double error = (claim.place - started[p]).norm();
      row.errors.push_back(error);
      if (!(error < kWrong)) ++row.wrong;
      drawReturns(canvas, started[p], claim.place);
    }
    print(row);
    if (pictures.empty()) continue;
    cv::hconcat(canvas, end, canvas);
    cv::imwrite(pictures + '/' + name + '_' + (row.name == "ours" ? "ours" : "klt") + ".png", canvas);
  }
}

int program(int argc, char** argv) {
  namespace po = boost::program_options;
  std::vector<std::string> films;
  std::string pictures;
  int images = 0;
  po::options_description options(
      "bench_points [FILM or FILM@FROM ...]: points beside OpenCV's, on drawn tissue and films");
  options.add_options()("help", "this text")  //
      ("film", po::value(&films)->composing(), "videos; @N: from image N on")(
          "images", po::value(&images)->default_value(60), "of each")(
          "pictures", po::value(&pictures), "folder to which the first and last image of each film are written");
  if (const auto status = parse(argc, argv, options, "film", -1, [&] { return images > 2; })) return *status;
  if (!pictures.empty()) std::filesystem::create_directories(pictures);
  std::cout << "wrong: of those kept, claimed 2 px or more from the truth in the last image; films: not back at 2 px\n"
            << "scene                             tracker      points   kept  wrong  err 0.5  err 0.95 cpu [ms]\n";
  drawn("drawn", images, false, 1.0);
  drawn("drawn, light 1 to 0.6", images, false, 0.6);
  drawn("drawn, a shaft crosses", images, true, 1.0);
  for (const std::string& each : films) {
    const std::size_t at = each.rfind('@');
    film(each.substr(0, at), at == std::string::npos ? 0 : std::stoi(each.substr(at + 1)), images, pictures);
  }
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_points", [&] { return laparoscope_servo::bench::program(argc, argv); });
}
