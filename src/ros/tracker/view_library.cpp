#include "ros/tracker/view_library.h"

#include <stdexcept>

#include "ros/tracker/result_messages.h"

namespace laparoscope_servo {

namespace {

bool same(const std::shared_ptr<const image::Lens>& a, const std::shared_ptr<const image::Lens>& b) {
  return a && b ? *a == *b : !a && !b;
}

}  // namespace

ViewLibrary::ViewLibrary(const TrackerParameters& parameters)
    : parameters_(parameters), store_(parameters.tracking, parameters.views.capacity) {}

// H between images of two cameras has no meaning, and a ROI is in pixels of its lens.
void ViewLibrary::followCamera(const Snapshot& snapshot) {
  const bool other_camera = camera_ && snapshot.camera && *camera_ != *snapshot.camera;
  if (other_camera || !same(lens_, snapshot.lens)) {
    if (!stamps_.empty()) forgotten_ = "; the camera's calibration changed, views stored before that are forgotten";
    store_ = tracking::ViewStore(parameters_.tracking, parameters_.views.capacity, snapshot.lens);
    stamps_.clear();
    camera_.reset();
    lens_ = snapshot.lens;
  }
  if (snapshot.camera) camera_ = snapshot.camera;
}

std::string ViewLibrary::store(const std::string& name, const Snapshot& snapshot) {
  followCamera(snapshot);
  if (!snapshot.roi) throw std::invalid_argument(snapshot.roi_error);
  store_.store(name, snapshot.image, *snapshot.roi);
  stamps_[name] = snapshot.stamp;
  // Its image may show another view's region while that view's image does not show its own: there is then a way there,
  // but not back.
  std::string from;
  std::string to;
  const auto list = [](std::string& names, const std::string& other) {
    names += (names.empty() ? "'" : ", '") + other + "'";
  };
  for (const std::string& other : store_.names()) {
    if (other == name) continue;
    if (store_.leads(other, name)) list(from, other);
    if (store_.leads(name, other)) list(to, other);
  }
  return "stored view '" + name + "' with ROI " + roiText(store_.get(name).roi) + "; reached from " +
         (from.empty() ? "no other" : from) + ", leads to " + (to.empty() ? "no other" : to);
}

RecallRoute ViewLibrary::route(const std::string& name, const Snapshot& snapshot) {
  followCamera(snapshot);
  RecallRoute result;
  result.epoch = snapshot.epoch;
  try {
    const tracking::ViewStore::Route route = store_.route(snapshot.image, name);
    if (!route.why.empty()) throw std::invalid_argument(route.why);
    for (const std::string& step : route.names) result.steps.push_back({step, store_.get(step), stamps_.at(step)});
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(error.what() + forgotten_);
  }
  return result;
}

std::vector<StoredViewInfo> ViewLibrary::list(bool thumbnails) {
  std::vector<StoredViewInfo> list;
  for (const std::string& name : store_.names()) {
    const tracking::View& view = store_.get(name);
    StoredViewInfo info;
    info.name = name;
    info.stamp = stamps_.at(name);
    info.roi.x_offset = static_cast<std::uint32_t>(view.roi.x);
    info.roi.y_offset = static_cast<std::uint32_t>(view.roi.y);
    info.roi.width = static_cast<std::uint32_t>(view.roi.width);
    info.roi.height = static_cast<std::uint32_t>(view.roi.height);
    info.width = static_cast<std::uint32_t>(view.image.cols);
    info.height = static_cast<std::uint32_t>(view.image.rows);
    for (const std::string& other : store_.names()) {
      if (other != name && store_.leads(name, other)) info.leads_to.push_back(other);
    }
    if (thumbnails) {
      std_msgs::Header header;
      header.stamp = info.stamp;
      info.thumbnail = *imageMessage(header, thumbnail_.of(view.image, lens_));
    }
    list.push_back(info);
  }
  return list;
}

std::string routeText(const RecallRoute& route) {
  std::string text;
  for (const RecallStep& step : route.steps) text += (text.empty() ? "'" : ", '") + step.name + "'";
  return text;
}

}  // namespace laparoscope_servo
