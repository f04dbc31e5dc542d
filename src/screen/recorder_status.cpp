#include "screen/recorder_status.h"

namespace laparoscope_servo::screen {

// The names in /diagnostics are those of the nodes without the slash in front.
std::optional<RecorderFacts> recorderIn(const diagnostic_msgs::DiagnosticArray& message, const std::string& space) {
  const std::string name = (space.size() <= 1 ? "" : space.substr(1) + "/") + "recorder: recording";
  for (const diagnostic_msgs::DiagnosticStatus& status : message.status) {
    if (status.name != name) continue;
    RecorderFacts facts;
    facts.level = status.level;
    facts.message = status.message;
    for (const diagnostic_msgs::KeyValue& value : status.values) {
      if (value.key == "file") facts.file = value.value.substr(value.value.rfind('/') + 1);
      if (value.key == "written [MB]") facts.written = value.value;
      if (value.key == "free on the disk [MB]") facts.free = value.value;
    }
    return facts;
  }
  return std::nullopt;
}

}  // namespace laparoscope_servo::screen
