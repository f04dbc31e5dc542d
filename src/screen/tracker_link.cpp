#include "screen/tracker_link.h"

#include <laparoscope_servo/CheckRoi.h>
#include <laparoscope_servo/FreezeImage.h>
#include <laparoscope_servo/ListViews.h>
#include <laparoscope_servo/SelectRoi.h>
#include <laparoscope_servo/StoredView.h>
#include <std_srvs/Trigger.h>

#include <memory>
#include <utility>
#include <vector>

#include "ros/common/clocks.h"
#include "screen/preview_image.h"
#include "screen/region_message.h"

namespace laparoscope_servo::screen {

namespace {

using StoredView_ = laparoscope_servo::StoredView;
// All that gives the tracker another region is sent in order.
const char* const kRegionLine = "region";

using Views = std::shared_ptr<const std::vector<StoredView>>;

CheckRoi questionOf(const QRect& pixels, std::int64_t stamp) {
  CheckRoi question;
  question.request.roi = messageOf(pixels);
  question.request.stamp.fromNSec(static_cast<std::uint64_t>(stamp));
  return question;
}

std::int64_t stampOf(const std::optional<Frozen>& frozen) {
  return frozen ? frozen->stamp : 0;
}

bool same(const std::optional<Drawn>& a, const std::optional<Drawn>& b) {
  return a && b && a->region == b->region && a->stamp == b->stamp;
}

Views viewsOf(const ListViews::Response& response) {
  auto views = std::make_shared<std::vector<StoredView>>();
  for (const StoredViewInfo& info : response.views) {
    StoredView view;
    view.name = info.name;
    view.stamp = static_cast<std::int64_t>(info.stamp.toNSec());
    view.thumbnail = previewImage(info.thumbnail);
    view.size = {side(info.width), side(info.height)};
    view.roi = {side(info.roi.x_offset), side(info.roi.y_offset), side(info.roi.width), side(info.roi.height)};
    view.leads_to = info.leads_to;
    views->push_back(view);
  }
  return views;
}

bool sameViews(const Views& known, const ListViews::Response& listed) {
  if (!known || known->size() != listed.views.size()) return false;
  for (std::size_t k = 0; k < known->size(); ++k) {
    const StoredView& view = (*known)[k];
    const StoredViewInfo& info = listed.views[k];
    if (view.name != info.name || view.stamp != static_cast<std::int64_t>(info.stamp.toNSec()) ||
        view.leads_to != info.leads_to)
      return false;
  }
  return true;
}

}  // namespace

void TrackerLink::selectRegion(const QRect& pixels) {
  const Facts facts = keeper_.facts();
  const std::int64_t stamp = stampOf(facts.frozen);
  keeper_.change([&](Facts& changed) { changed.drawn = Drawn{pixels, stamp}; });
  select(pixels, stamp);
  const bool is_judged = facts.verdict && facts.verdict->region == pixels && facts.verdict->stamp == stamp;
  if (!is_judged) checkRegion(pixels);
}

void TrackerLink::takeOffer(const Offer& offer) {
  select(offer.region, offer.stamp);
}

void TrackerLink::select(const QRect& pixels, std::int64_t stamp) {
  const std::string name = resolved_(stamp != 0 ? "tracker/select_frozen_roi" : "tracker/select_roi");
  if (name.empty()) return;
  // The answer ends only what was drawn or frozen when the request was made, not what came after it.
  const auto taken = [this, drawn = keeper_.facts().drawn, holds = frozen_.present()](const auto&) {
    const bool ends_frozen = holds();
    if (ends_frozen) frozen_.end();
    keeper_.change([&](Facts& facts) {
      if (same(facts.drawn, drawn)) facts.drawn.reset();
      if (ends_frozen) facts.frozen.reset();
    });
  };
  ServiceCalls::Manner manner;
  manner.line = kRegionLine;
  if (stamp == 0) {
    SelectRoi request;
    request.request.roi = messageOf(pixels);
    return calls_.call<SelectRoi>(name, "Region", request, manner, taken);
  }
  calls_.call<CheckRoi>(name, "Region of an earlier picture", questionOf(pixels, stamp), manner, taken);
}

void TrackerLink::forgetDrawn() {
  keeper_.change([](Facts& facts) { facts.drawn.reset(); });
}

void TrackerLink::checkRegion(const QRect& pixels) {
  const std::string name = resolved_("tracker/check_roi");
  if (name.empty()) return;
  const CheckRoi question = questionOf(pixels, stampOf(keeper_.facts().frozen));
  checks_.ask([this, name, pixels, question]() -> std::function<void()> {
    CheckRoi call = question;
    Verdict verdict;
    verdict.region = pixels;
    verdict.stamp = static_cast<std::int64_t>(question.request.stamp.toNSec());
    const bool answered = ros::service::call(name, call);
    verdict.taken = answered && call.response.success != 0;
    verdict.why = answered ? call.response.message : "no answer from " + name;
    if (answered && !verdict.taken) verdict.proposal = pixelsOf(call.response.proposal);
    return [this, verdict] {
      keeper_.change([&](Facts& facts) { facts.verdict = verdict; });
      news_();
    };
  });
}

void TrackerLink::freeze() {
  const std::string name = resolved_("tracker/freeze_image");
  if (name.empty()) return;
  frozen_.end();
  ServiceCalls::Manner manner;
  manner.wanted = frozen_.present();
  calls_.call<FreezeImage>(name, "Freeze", FreezeImage(), manner, [=](const FreezeImage::Response& response) {
    Frozen frozen;
    frozen.image = previewImage(response.preview);
    frozen.stamp = static_cast<std::int64_t>(response.preview.header.stamp.toNSec());
    frozen.size = {side(response.width), side(response.height)};
    frozen.at = steadyNow();
    if (frozen.image.isNull() || frozen.size.isEmpty()) return;
    keeper_.change([&](Facts& facts) {
      if (manner.wanted()) facts.frozen = frozen;
    });
  });
}

void TrackerLink::thaw() {
  frozen_.end();
  keeper_.change([](Facts& facts) { facts.frozen.reset(), facts.drawn.reset(); });
}

void TrackerLink::forget() {
  thaw();
  keeper_.change([](Facts& facts) { facts.views.reset(), facts.verdict.reset(); });
}

void TrackerLink::clearRegion() {
  const std::string name = resolved_("tracker/reset");
  ServiceCalls::Manner manner;
  manner.line = kRegionLine;
  if (!name.empty()) calls_.call(name, "Clear region", std_srvs::Trigger(), manner);
}

// Each name is a wish of its own.
void TrackerLink::storeView(const std::string& name) {
  call("tracker/store_view", "Store view", name, "store view " + name);
}

void TrackerLink::recallView(const std::string& name) {
  call("tracker/recall_view", "Recall view", name, kRegionLine);
}

// Fetches the pictures only if the list has changed.
void TrackerLink::listViews() {
  const std::string name = resolved_("tracker/list_views");
  if (name.empty()) return;
  lists_.ask([this, name, known = keeper_.facts().views]() -> std::function<void()> {
    ListViews call;
    if (!ros::service::call(name, call) || sameViews(known, call.response)) return nullptr;
    call.request.thumbnails = 1;
    if (!ros::service::call(name, call)) return nullptr;
    return [this, views = viewsOf(call.response)] { keeper_.change([&](Facts& facts) { facts.views = views; }); };
  });
}

void TrackerLink::call(const std::string& service, const std::string& what, const std::string& view,
                       const std::string& line) {
  const std::string name = resolved_(service);
  if (name.empty()) return;
  StoredView_ request;
  request.request.name = view;
  ServiceCalls::Manner manner;
  manner.line = line;
  calls_.call<StoredView_>(name, what + " '" + view + "'", request, manner,
                           [this](const StoredView_::Response&) { listViews(); });
}

}  // namespace laparoscope_servo::screen
