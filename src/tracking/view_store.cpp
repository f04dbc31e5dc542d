#include "laparoscope_servo/tracking/view_store.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "laparoscope_servo/tracking/region_tracker.h"

namespace laparoscope_servo::tracking {

namespace {

constexpr std::size_t kLongestName = 64;  // bytes
// s, assumed between two views: sets how much the illumination may have changed.
constexpr double kBetweenViews = 10.0;
constexpr double kWholeSearch = 10.0;  // s: a budget that one image cannot use up, since no further image comes

// One image must suffice: confirmations in the same image would prove nothing.
TrackerConfig forOneImage(TrackerConfig config) {
  config.quality.confirmations = 1;
  config.search.features = true;
  config.search.keyframes = 0;
  config.search.budget = kWholeSearch;
  return config;
}

std::string quoted(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

bool found(const View& view, const cv::Mat& image, const TrackerConfig& config, const image::Lens* lens) {
  RegionTracker tracker(config);
  if (lens != nullptr) tracker.setLens(*lens);
  tracker.recall(view.image, -kBetweenViews, view.roi, 0.0);
  return tracker.track(image, 0.0).state == State::kTracking;
}

}  // namespace

geometry::Rectangle uprightRoi(const Eigen::Matrix3d& g, const geometry::Rectangle& roi, const cv::Rect& image) {
  const geometry::Quadrilateral corners = geometry::apply(g, roi.corners());
  if (!geometry::isConvex(corners)) throw std::invalid_argument("the ROI's image is not convex");
  Eigen::Vector2d first = corners[0];
  Eigen::Vector2d last = corners[0];
  for (const Eigen::Vector2d& corner : corners) {
    first = first.cwiseMin(corner);
    last = last.cwiseMax(corner);
  }
  const Eigen::Vector2d sides = last - first;
  const Eigen::Vector2d half = 0.5 * std::sqrt(geometry::signedArea(corners) / sides.prod()) * sides;
  const Eigen::Vector2d middle = 0.5 * (first + last);
  const double left = std::max(std::round(middle.x() - half.x()), 1.0 * image.x);
  const double top = std::max(std::round(middle.y() - half.y()), 1.0 * image.y);
  const double right = std::min(std::round(middle.x() + half.x()), image.x + image.width - 1.0);
  const double bottom = std::min(std::round(middle.y() + half.y()), image.y + image.height - 1.0);
  if (!(right > left && bottom > top)) throw std::invalid_argument("the ROI is outside the image");
  return {left, top, right - left + 1.0, bottom - top + 1.0};
}

ViewStore::ViewStore(const TrackerConfig& config, int capacity, std::shared_ptr<const image::Lens> lens)
    : config_(forOneImage(config)), capacity_(capacity), lens_(std::move(lens)) {
  const RegionTracker checked(config);
  if (capacity < 1)
    throw std::invalid_argument("capacity = " + std::to_string(capacity) + ", expected at least 1 view");
}

void ViewStore::store(const std::string& name, const cv::Mat& image, const geometry::Rectangle& roi) {
  if (name.empty() || name.size() > kLongestName) {
    throw std::invalid_argument("the name of a view has " + std::to_string(name.size()) + " bytes, expected 1 to " +
                                std::to_string(kLongestName));
  }
  if (entries_.count(name) == 0 && static_cast<int>(entries_.size()) >= capacity_) {
    throw std::invalid_argument("no place is left for view '" + name + "', expected one of the " +
                                std::to_string(capacity_) + " that are stored, to replace it: " + quoted(names()));
  }
  RegionTracker checked(config_);
  if (lens_) checked.setLens(*lens_);
  Entry fresh;
  fresh.view.roi = checked.select(image, 0.0, roi).roi;
  fresh.view.image = image.clone();
  std::map<std::string, bool> led_from;
  for (const auto& [other, entry] : entries_) {
    if (other == name) continue;
    fresh.leads_to[other] = found(entry.view, fresh.view.image, config_, lens_.get());
    led_from[other] = found(fresh.view, entry.view.image, config_, lens_.get());
  }
  entries_[name] = std::move(fresh);
  for (const auto& [other, leads] : led_from) entries_[other].leads_to[name] = leads;
}

std::vector<std::string> ViewStore::names() const {
  std::vector<std::string> result;
  for (const auto& stored : entries_) result.push_back(stored.first);
  return result;
}

const ViewStore::Entry& ViewStore::entry(const std::string& name) const {
  const auto stored = entries_.find(name);
  if (stored != entries_.end()) return stored->second;
  throw std::invalid_argument("no view '" + name + "' is stored, expected " +
                              (entries_.empty() ? "one, but there is none" : "one of " + quoted(names())));
}

const View& ViewStore::get(const std::string& name) const {
  return entry(name).view;
}

bool ViewStore::leads(const std::string& from, const std::string& to) const {
  entry(to);
  const std::map<std::string, bool>& leads_to = entry(from).leads_to;
  const auto other = leads_to.find(to);
  return from == to || (other != leads_to.end() && other->second);
}

bool ViewStore::isSeen(const std::string& name, const cv::Mat& image) const {
  return found(entry(name).view, image, config_, lens_.get());
}

// Breadth-first search, against the direction of the ways.
std::vector<std::pair<std::string, std::string>> ViewStore::waysTo(const std::string& to) const {
  entry(to);
  std::vector<std::pair<std::string, std::string>> ways = {{to, to}};
  const auto reached = [&](const std::string& name) {
    return std::any_of(ways.begin(), ways.end(), [&](const auto& way) { return way.first == name; });
  };
  for (std::size_t k = 0; k < ways.size(); ++k) {
    const std::string next = ways[k].first;
    for (const auto& stored : entries_) {
      if (!reached(stored.first) && leads(stored.first, next)) ways.emplace_back(stored.first, next);
    }
  }
  return ways;
}

std::vector<std::string> ViewStore::path(const std::string& from, const std::string& to) const {
  entry(from);
  const auto ways = waysTo(to);
  std::map<std::string, std::string> next(ways.begin(), ways.end());
  if (next.count(from) == 0) return {};
  std::vector<std::string> names = {from};
  while (names.back() != to) names.push_back(next[names.back()]);
  return names;
}

ViewStore::Route ViewStore::route(const cv::Mat& image, const std::string& to) const {
  const auto ways = waysTo(to);
  for (const auto& way : ways) {
    if (isSeen(way.first, image)) return {path(way.first, to), ""};
  }
  std::vector<std::string> seen;
  for (const std::string& name : names()) {
    const bool asked = std::any_of(ways.begin(), ways.end(), [&](const auto& way) { return way.first == name; });
    if (!asked && isSeen(name, image)) seen.push_back(name);
  }
  if (seen.empty()) return {{}, "no stored view overlaps with the present image"};
  return {{},
          "the present image overlaps with " + quoted(seen) + ", from where no stored views lead to '" + to +
              "': store views on the way"};
}

}  // namespace laparoscope_servo::tracking
