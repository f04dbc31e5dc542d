#include "ros/reasons/reason_table.h"

#include <algorithm>

#include "ros/reasons/reason_rows.h"

namespace laparoscope_servo {

namespace {

const std::string kGap = "…";

void addTable(const std::string& heading, Speaker speaker, std::string& page) {
  page += "### " + heading + "\n| message | means | do |\n| --- | --- | --- |\n";
  for (const ReasonRow& row : reasonRows(speaker)) {
    std::string messages;
    for (const std::string& pattern : row.patterns) messages += (messages.empty() ? "`" : ", `") + pattern + "`";
    page += "| " + messages + " | " + row.sentence + " | " + row.cure;
    if (!row.page.empty()) page += " See [" + row.page.substr(0, row.page.find('#')) + "](" + row.page + ").";
    page += " |\n";
  }
}

}  // namespace

const std::vector<ReasonRow>& reasonRows(Speaker speaker) {
  switch (speaker) {
    case Speaker::kTracker:
      return trackerReasons();
    case Speaker::kFeatures:
      return featureReasons();
    case Speaker::kController:
      return controllerReasons();
    case Speaker::kPlayer:
      return playerReasons();
    case Speaker::kRobot:
      break;
  }
  return robotReasons();
}

bool fits(const std::string& pattern, const std::string& text) {
  std::size_t at = 0;
  for (std::size_t begin = 0; begin <= pattern.size();) {
    const std::size_t end = std::min(pattern.find(kGap, begin), pattern.size());
    const std::size_t found = text.find(pattern.substr(begin, end - begin), at);
    if (found == std::string::npos) return false;
    at = found + (end - begin);
    begin = end + kGap.size();
  }
  return true;
}

const ReasonRow* explain(Speaker speaker, const std::string& reason) {
  for (const ReasonRow& row : reasonRows(speaker)) {
    for (const std::string& pattern : row.patterns) {
      if (fits(pattern, reason)) return &row;
    }
  }
  return nullptr;
}

std::string reasonPage() {
  std::string page;
  addTable("Of the tracker", Speaker::kTracker, page);
  page += "\n";
  addTable("Of the trackers of features", Speaker::kFeatures, page);
  page += "\n";
  addTable("Of the controller", Speaker::kController, page);
  page += "\n";
  addTable("Of the robot", Speaker::kRobot, page);
  page += "\n";
  addTable("Of the player of a recording", Speaker::kPlayer, page);
  return page;
}

}  // namespace laparoscope_servo
