// The same region of the same film, shown at other rates and sizes: whether the tracker's states and places stay alike.
// Between two images of the film, a rate that needs one gets it by dense flow; sizes are resampled. Each way of showing
// is compared with the film as it is, at the times that both have, in px of the film.
#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "bench/support/arguments.h"
#include "bench/support/sequence.h"
#include "bench/support/statistics.h"
#include "laparoscope_servo/geometry/homography.h"
#include "laparoscope_servo/tracking/region_tracker.h"

namespace laparoscope_servo::bench {

namespace {

struct Showing {
  double rate = 1.0;  // images per image of the film
  double size = 1.0;  // px per px of the film
};

const std::vector<Showing> kShowings = {{1.0, 1.0}, {0.5, 1.0}, {2.4, 1.0}, {1.0, 0.5}, {1.0, 2.0}, {1.0, 4.0}};

// Of one showing, at an image of the film.
struct Place {
  bool tracking = false;
  Eigen::Matrix3d g;          // of the film's px
  double corner_error = 0.0;  // px of the film
  std::string reason;
};

struct Track {
  int images = 0, tracking = 0;
  std::map<int, Place> at;  // by the film's image
  std::string first_loss;   // when [images of the film] and why
};

// The film's image `position`, counted from 0 and not always whole, moved from both of its neighbours.
cv::Mat between(const std::vector<cv::Mat>& film, double position) {
  const int first = static_cast<int>(std::lround(std::floor(position + 1e-6)));
  const float part = static_cast<float>(position - first);
  if (part < 1e-5f) return film[static_cast<std::size_t>(first)];
  const cv::Mat& before = film[static_cast<std::size_t>(first)];
  const cv::Mat& after = film[static_cast<std::size_t>(first) + 1];
  cv::Mat grey[2];
  cv::cvtColor(before, grey[0], cv::COLOR_BGR2GRAY);
  cv::cvtColor(after, grey[1], cv::COLOR_BGR2GRAY);
  cv::Mat2f flow;
  cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_MEDIUM)->calc(grey[0], grey[1], flow);
  cv::Mat2f from(flow.size()), to(flow.size());
  for (int j = 0; j < flow.rows; ++j) {
    for (int i = 0; i < flow.cols; ++i) {
      const cv::Vec2f here(static_cast<float>(i), static_cast<float>(j));
      from(j, i) = here - part * flow(j, i);
      to(j, i) = here + (1.0f - part) * flow(j, i);
    }
  }
  cv::Mat result, other;
  cv::remap(before, result, from, cv::noArray(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  cv::remap(after, other, to, cv::noArray(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  cv::addWeighted(result, 1.0 - part, other, part, 0.0, result);
  return result;
}

// The film's px to those of this size; both have the centre of their first pixel at (0, 0).
Eigen::Matrix3d sizing(double size) {
  Eigen::Matrix3d s;
  s << size, 0.0, 0.5 * (size - 1.0), 0.0, size, 0.5 * (size - 1.0), 0.0, 0.0, 1.0;
  return s;
}

cv::Mat shown(const std::vector<cv::Mat>& film, double position, double size) {
  const cv::Mat image = between(film, position);
  if (size == 1.0) return image;
  cv::Mat result;
  cv::resize(image, result, cv::Size(), size, size, size < 1.0 ? cv::INTER_AREA : cv::INTER_CUBIC);
  return result;
}

// Defaults of the showings other than the film as it is, times these.
struct Factors {
  double limits = 1.0;  // quality/max_corner_error and quality/max_centre_error
  double budget = 1.0;  // search/budget
};

Track track(const std::vector<cv::Mat>& film, double film_rate, const geometry::Rectangle& roi, const Showing& showing,
            const Factors& factors) {
  tracking::TrackerConfig config;
  config.quality.max_corner_error *= factors.limits;
  config.quality.max_centre_error *= factors.limits;
  config.search.budget *= factors.budget;
  tracking::RegionTracker tracker{config};
  const Eigen::Matrix3d s = sizing(showing.size);
  Track result;
  for (int k = 0; k / showing.rate <= static_cast<double>(film.size()) - 1.0 + 1e-6; ++k) {
    const double position = k / showing.rate, time = position / film_rate;
    const cv::Mat image = shown(film, position, showing.size);
    const tracking::TrackResult found = k == 0 ? tracker.select(image, time,
                                                                {showing.size * roi.x, showing.size * roi.y,
                                                                 showing.size * roi.width, showing.size * roi.height})
                                               : tracker.track(image, time);
    ++result.images;
    const bool tracking = found.state == tracking::State::kTracking;
    result.tracking += tracking;
    if (!tracking && result.first_loss.empty())
      result.first_loss = std::to_string(std::lround(position)) + ": " + found.reason;
    if (std::abs(position - std::round(position)) < 1e-6)
      result.at[static_cast<int>(std::lround(position))] = {tracking, s.inverse() * found.g * s,
                                                            found.corner_error / showing.size, found.reason};
  }
  return result;
}

// The reason without its numbers.
std::string wording(const std::string& reason) {
  return reason.substr(0, reason.find_first_of("0123456789"));
}

// The reason that most of the counted images have, and how many.
std::string mostOften(const std::map<std::string, int>& counts) {
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? "" : std::to_string(most->second) + ": " + most->first;
}

void compare(const Showing& showing, const Track& track, const Track& usual, const geometry::Rectangle& roi) {
  int common = 0, differ = 0;
  std::vector<double> apart, claims;
  std::map<std::string, int> why;  // of images that are TRACKING in one of the two only
  for (const auto& [image, place] : track.at) {
    const auto other = usual.at.find(image);
    if (other == usual.at.end()) continue;
    ++common;
    if (place.tracking != other->second.tracking) {
      ++differ;
      ++why[wording(place.tracking ? other->second.reason : place.reason)];
    }
    if (!place.tracking || !other->second.tracking) continue;
    apart.push_back(geometry::cornerDistance(place.g, other->second.g, roi));
    claims.push_back(place.corner_error);
  }
  std::printf("| %g | %g | %d | %.3f | %d of %d | %.2f | %.2f | %.2f | %s | %s |\n", showing.rate, showing.size,
              track.images, static_cast<double>(track.tracking) / track.images, differ, common, quantile(apart, 0.5),
              quantile(apart, 0.95), quantile(claims, 0.5), track.first_loss.c_str(), mostOften(why).c_str());
  std::fflush(stdout);
}

int program(int argc, char** argv) {
  namespace po = boost::program_options;
  std::string name, roi;
  int from = 0, limit = 0;
  double rate = 25.0, size = 0.0;
  Factors factors;
  po::options_description options("A film at other rates and sizes. bench_shown [options] FILM");
  options.add_options()("help", "this text")                                                                    //
      ("film", po::value(&name), "video, or folder of images")                                                  //
      ("roi", po::value(&roi), "x,y,w,h in its first image, or in that of --from")                              //
      ("from", po::value(&from)->default_value(0), "image, counted from 0")                                     //
      ("limit", po::value(&limit)->default_value(150), "so many images, 0: all")                                //
      ("rate", po::value(&rate)->default_value(25.0), "images per second of the film")                          //
      ("size", po::value(&size)->default_value(size), "only this size beside the film's own, 0: all showings")  //
      ("limits", po::value(&factors.limits)->default_value(1.0),
       "quality/max_corner_error and max_centre_error times this, in all showings but the film as it is")  //
      ("budget", po::value(&factors.budget)->default_value(1.0), "search/budget times this, likewise");
  const auto complete = [&] {
    return !name.empty() && !roi.empty() && from >= 0 && limit >= 0 && rate > 0.0 && size >= 0.0 &&
           factors.limits > 0.0 && factors.budget > 0.0;
  };
  if (const auto status = parse(argc, argv, options, "film", 1, complete)) return *status;
  const geometry::Rectangle region = parseRoi(roi);
  std::vector<cv::Mat> film;
  Sequence images(name);
  cv::Mat image;
  for (int frame = 0; (limit == 0 || frame < from + limit) && images.next(image); ++frame) {
    if (frame >= from) film.push_back(image.clone());
  }
  if (film.size() < 2) throw std::invalid_argument(name + " has too few images, expected two from --from on");
  std::printf(
      "| rate | size | images | TRACKING | states differ | apart, median [px] | 95 %% | claimed, median | first loss: "
      "image, reason | most often, where states differ |\n");
  std::printf("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  Track usual;
  for (const Showing& showing : kShowings) {
    const bool as_it_is = usual.images == 0;
    if (!as_it_is && size > 0.0 && !(showing.size == size && showing.rate == 1.0)) continue;
    try {
      const Track now = track(film, rate, region, showing, as_it_is ? Factors{} : factors);
      if (as_it_is) usual = now;
      compare(showing, now, usual, region);
    } catch (const std::invalid_argument& refused) {
      std::printf("| %g | %g | refused: %s | | | | | | | |\n", showing.rate, showing.size, refused.what());
    }
  }
  return 0;
}

}  // namespace

}  // namespace laparoscope_servo::bench

int main(int argc, char** argv) {
  return laparoscope_servo::bench::run("bench_shown", [&] { return laparoscope_servo::bench::program(argc, argv); });
}
