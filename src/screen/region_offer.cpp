#include "screen/region_offer.h"

namespace laparoscope_servo::screen {

namespace {

bool isSearched(const TrackerFacts& tracker) {
  return tracker.state == "SEARCHING" || tracker.state == "LOST";
}

}  // namespace

std::optional<Offer> offerOf(const Facts& facts) {
  const std::int64_t stamp = facts.frozen ? facts.frozen->stamp : 0;
  if (facts.drawn && facts.verdict && facts.drawn->stamp == stamp && facts.verdict->stamp == stamp &&
      facts.verdict->region == facts.drawn->region && !facts.verdict->proposal.isEmpty())
    return Offer{facts.verdict->proposal, stamp, false};
  if (!facts.frozen && isSearched(facts.tracker) && !facts.tracker.proposal.isEmpty())
    return Offer{facts.tracker.proposal, facts.tracker.reference_stamp, true};
  return std::nullopt;
}

}  // namespace laparoscope_servo::screen
