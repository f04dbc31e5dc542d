// The services of the tracker that wait for an image; they run in separate threads.
#include <memory>
#include <sstream>
#include <stdexcept>

#include "nodelets/tracker.h"
#include "ros/tracker/region_proposal.h"
#include "ros/tracker/result_messages.h"

namespace laparoscope_servo::nodelets {

namespace {

sensor_msgs::RegionOfInterest roiMessage(const geometry::Rectangle& roi) {
  sensor_msgs::RegionOfInterest message;
  message.x_offset = static_cast<std::uint32_t>(roi.x);
  message.y_offset = static_cast<std::uint32_t>(roi.y);
  message.width = static_cast<std::uint32_t>(roi.width);
  message.height = static_cast<std::uint32_t>(roi.height);
  return message;
}

geometry::Rectangle rectangleOf(const sensor_msgs::RegionOfInterest& roi) {
  return {static_cast<double>(roi.x_offset), static_cast<double>(roi.y_offset), static_cast<double>(roi.width),
          static_cast<double>(roi.height)};
}

}  // namespace

TrackerRequest::Answer Tracker::ask(const TrackerRequest::Question& question) {
  std::ostringstream timeout;
  timeout << "no image came on " << getNodeHandle().resolveName("image") << " within "
          << session_->parameters().select_timeout << " s (parameter select_timeout)";
  return request_.ask(question, session_->parameters().select_timeout, timeout.str());
}

bool Tracker::selectRoi(SelectRoi::Request& request, SelectRoi::Response& response) {
  const TrackerRequest::Answer answer = ask(rectangleOf(request.roi));
  response.success = static_cast<std::uint8_t>(answer.success);
  response.message = answer.message;
  return true;
}

bool Tracker::checkRoi(CheckRoi::Request& request, CheckRoi::Response& response) {
  response.success = static_cast<std::uint8_t>(false);
  const geometry::Rectangle roi = rectangleOf(request.roi);
  std::shared_ptr<const Snapshot> live;
  const Snapshot* snapshot = nullptr;
  try {
    if (request.stamp.isZero()) {
      const TrackerRequest::Answer answer = ask(WantSnapshot());
      live = answer.snapshot;
      if (!live) throw std::runtime_error(answer.message);
    }
    snapshot = live ? live.get() : &desk_->kept(request.stamp);
    desk_->check(*snapshot, roi);
    response.success = static_cast<std::uint8_t>(true);
  } catch (const std::exception& error) {
    response.message = error.what();
    const auto proposal = snapshot != nullptr ? desk_->propose(*snapshot, roi) : std::nullopt;
    response.message += proposalText(proposal);
    // Rectified pixels may be negative, which the message cannot say.
    if (proposal && proposal->x >= 0.0 && proposal->y >= 0.0) response.proposal = roiMessage(*proposal);
  }
  return true;
}

bool Tracker::freezeImage(FreezeImage::Request&, FreezeImage::Response& response) {
  const TrackerRequest::Answer answer = ask(WantSnapshot());
  response.success = static_cast<std::uint8_t>(answer.snapshot != nullptr);
  response.message = answer.message;
  if (!answer.snapshot) return true;
  desk_->keep(answer.snapshot);
  std_msgs::Header header;
  header.stamp = answer.snapshot->stamp;
  response.preview = *imageMessage(header, desk_->preview());
  response.width = static_cast<std::uint32_t>(answer.snapshot->image.cols);
  response.height = static_cast<std::uint32_t>(answer.snapshot->image.rows);
  return true;
}

bool Tracker::selectFrozenRoi(CheckRoi::Request& request, CheckRoi::Response& response) {
  response.success = static_cast<std::uint8_t>(false);
  try {
    TrackerRequest::Answer answer = ask(WantSnapshot());
    if (!answer.snapshot) throw std::runtime_error(answer.message);
    answer = ask(desk_->route(request.stamp, rectangleOf(request.roi), *answer.snapshot));
    response.success = static_cast<std::uint8_t>(answer.success);
    response.message = answer.message;
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  if (!response.success) NODELET_WARN("the region of the frozen picture is not taken: %s", response.message.c_str());
  return true;
}

bool Tracker::listViews(ListViews::Request& request, ListViews::Response& response) {
  response.views = views_->list(request.thumbnails != 0);
  return true;
}

bool Tracker::storeView(StoredView::Request& request, StoredView::Response& response) {
  const TrackerRequest::Answer answer = ask(WantSnapshot());
  response.success = static_cast<std::uint8_t>(answer.success);
  response.message = answer.message;
  if (!answer.snapshot) return true;
  try {
    response.message = views_->store(request.name, *answer.snapshot);
  } catch (const std::exception& error) {
    response.success = static_cast<std::uint8_t>(false);
    response.message = error.what();
  }
  return true;
}

// Tracking goes on meanwhile: searching the image for all views takes longer than the period of the images.
bool Tracker::recallView(StoredView::Request& request, StoredView::Response& response) {
  response.success = static_cast<std::uint8_t>(false);
  TrackerRequest::Answer answer = ask(WantSnapshot());
  if (answer.snapshot) {
    try {
      const RecallRoute route = views_->route(request.name, *answer.snapshot);
      answer = ask(route);
      if (answer.success) answer.message = "going by " + routeText(route);
      response.success = static_cast<std::uint8_t>(answer.success);
    } catch (const std::exception& error) {
      answer.message = error.what();
    }
  }
  response.message = answer.message;
  statistics_->recallRefused(response.success ? "" : "view '" + request.name + "': " + response.message);
  if (!response.success) NODELET_WARN("view '%s' is not recalled: %s", request.name.c_str(), response.message.c_str());
  return true;
}

}  // namespace laparoscope_servo::nodelets
