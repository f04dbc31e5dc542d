// The screen's calls to the tracker: regions, frozen pictures, stored views. Never blocks.
#pragma once

#include <QRect>
#include <functional>
#include <string>

#include "screen/fact_keeper.h"
#include "screen/newest_call.h"
#include "screen/service_calls.h"
#include "screen/wish.h"

namespace laparoscope_servo::screen {

class TrackerLink {
 public:
  // `resolved`: resolves a service's name; empty while there is no master. `news`: called for an answer.
  TrackerLink(FactKeeper& keeper, ServiceCalls& calls, const std::function<std::string(const std::string&)>& resolved,
              const std::function<void()>& news)
      : keeper_(keeper), calls_(calls), resolved_(resolved), news_(news) {}

  // `pixels`: px of the original image, in the frozen picture or the live one.
  void selectRegion(const QRect& pixels);
  void takeOffer(const Offer& offer);
  // No other region is offered in place of the one that was drawn last.
  void forgetDrawn();
  // Asks whether a region would be accepted; the answer is in Facts::verdict.
  void checkRegion(const QRect& pixels);
  void freeze();
  void thaw();
  // Forgets what an earlier tracker has answered.
  void forget();
  void clearRegion();

  void storeView(const std::string& name);
  void recallView(const std::string& name);
  // Checks whether the list of views has changed.
  void listViews();

 private:
  // `stamp`: as of Offer.
  void select(const QRect& pixels, std::int64_t stamp);
  void call(const std::string& service, const std::string& what, const std::string& view, const std::string& line);

  FactKeeper& keeper_;
  ServiceCalls& calls_;
  std::function<std::string(const std::string&)> resolved_;
  std::function<void()> news_;
  Wish frozen_;  // ended by all that ends a frozen picture
  NewestCall checks_;
  NewestCall lists_;
};

}  // namespace laparoscope_servo::screen
