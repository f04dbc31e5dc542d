// What the screen asks the tracker: of regions, frozen pictures, stored views. Waits for nobody.
#pragma once

#include <QRect>
#include <functional>
#include <string>

#include "screen/fact_keeper.h"
#include "screen/newest_call.h"
#include "screen/service_calls.h"

namespace laparoscope_servo::screen {

class TrackerLink {
 public:
  // `resolved`: of a service's name; empty while there is no master. `news`: there is an answer.
  TrackerLink(FactKeeper& keeper, ServiceCalls& calls, const std::function<std::string(const std::string&)>& resolved,
              const std::function<void()>& news)
      : keeper_(keeper), calls_(calls), resolved_(resolved), news_(news) {}

  // In px of the original image, of the picture that is frozen, or of the live one.
  void selectRegion(const QRect& pixels);
  // Would it be taken? The answer is Facts::verdict.
  void checkRegion(const QRect& pixels);
  void freeze();
  void thaw();

  void storeView(const std::string& name) { call("tracker/store_view", "Store view", name); }
  void recallView(const std::string& name) { call("tracker/recall_view", "Recall view", name); }
  // Looks whether there are others than before.
  void listViews();

 private:
  void call(const std::string& service, const std::string& what, const std::string& view);

  FactKeeper& keeper_;
  ServiceCalls& calls_;
  std::function<std::string(const std::string&)> resolved_;
  std::function<void()> news_;
  NewestCall checks_;
  NewestCall lists_;
};

}  // namespace laparoscope_servo::screen
