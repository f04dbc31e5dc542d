// The services of the tracker that wait for an image: they run in threads of their own.
#include <memory>
#include <sstream>
#include <stdexcept>

#include "nodelets/tracker.h"

namespace laparoscope_servo::nodelets {

TrackerRequest::Answer Tracker::ask(const TrackerRequest::Question& question) {
  std::ostringstream timeout;
  timeout << "no image came on " << getNodeHandle().resolveName("image") << " within "
          << session_->parameters().select_timeout << " s (parameter select_timeout)";
  return request_.ask(question, session_->parameters().select_timeout, timeout.str());
}

bool Tracker::selectRoi(SelectRoi::Request& request, SelectRoi::Response& response) {
  const geometry::Rectangle roi{static_cast<double>(request.roi.x_offset), static_cast<double>(request.roi.y_offset),
                                static_cast<double>(request.roi.width), static_cast<double>(request.roi.height)};
  const TrackerRequest::Answer answer = ask(roi);
  response.success = static_cast<std::uint8_t>(answer.success);
  response.message = answer.message;
  return true;
}

bool Tracker::storeView(StoredView::Request& request, StoredView::Response& response) {
  const TrackerRequest::Answer answer = ask(TrackerRequest::WantSnapshot());
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

// The tracker goes on meanwhile: searching the image for all the views takes longer than an image.
bool Tracker::recallView(StoredView::Request& request, StoredView::Response& response) {
  response.success = static_cast<std::uint8_t>(false);
  TrackerRequest::Answer answer = ask(TrackerRequest::WantSnapshot());
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
