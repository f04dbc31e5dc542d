// The services of the tracker that wait for an image; they run in separate threads.
#include <memory>
#include <sstream>
#include <stdexcept>

#include "nodelets/tracker.h"
#include "ros/common/clocks.h"
#include "ros/tracker/region_proposal.h"
#include "ros/tracker/result_messages.h"

namespace laparoscope_servo::nodelets {

namespace {

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
  std::shared_ptr<const Snapshot> picture;
  try {
    const bool frozen = desk_->holds(request.stamp);  // then no image has to come
    const TrackerRequest::Answer now = frozen ? TrackerRequest::Answer() : askSnapshot();
    picture = request.stamp.isZero() ? now.snapshot : pictureOf(request.stamp, now);
    desk_->check(*picture, roi);
    response.success = static_cast<std::uint8_t>(true);
  } catch (const std::exception& error) {
    const auto proposal = picture ? desk_->propose(*picture, roi) : std::nullopt;
    response.message = error.what() + proposalText(proposal);
    response.proposal = proposalMessage(proposal);
  }
  return true;
}

TrackerRequest::Answer Tracker::askSnapshot() {
  TrackerRequest::Answer answer = ask(WantSnapshot());
  if (!answer.snapshot) throw std::runtime_error(answer.message);
  return answer;
}

std::shared_ptr<const Snapshot> Tracker::pictureOf(const ros::Time& stamp, const TrackerRequest::Answer& now) const {
  const bool selected = now.reference && now.reference->stamp == stamp;
  return selected && !desk_->holds(stamp) ? now.reference : desk_->kept(stamp, steadyNow());
}

bool Tracker::freezeImage(FreezeImage::Request&, FreezeImage::Response& response) {
  const TrackerRequest::Answer answer = ask(WantSnapshot());
  response.success = static_cast<std::uint8_t>(answer.snapshot != nullptr);
  response.message = answer.message;
  if (!answer.snapshot) return true;
  desk_->keep(answer.snapshot, steadyNow());
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
    if (request.stamp.isZero()) throw std::invalid_argument("stamp is 0, expected that of the picture");
    const TrackerRequest::Answer now = askSnapshot();
    const std::shared_ptr<const Snapshot> before = pictureOf(request.stamp, now);
    const TrackerRequest::Answer answer = ask(desk_->route(*before, rectangleOf(request.roi), *now.snapshot));
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
