#include "laparoscope_servo/ros/aesop_diagnostics.h"

namespace laparoscope_servo::skin {

using aesop::OperatingMode;
using diagnostic_msgs::DiagnosticStatus;

void AesopDiagnostics::fill(double now, const aesop::Driver& driver, const CommandMaster& master,
                            std::uint32_t publishers, diagnostic_updater::DiagnosticStatusWrapper& status) {
  const aesop::Link& link = driver.session().link();
  const aesop::LinkStatistics& statistics = link.statistics();
  const aesop::OperatingState state = driver.state(now);
  const std::uint64_t errors = statistics.decoder.crc_errors + statistics.decoder.malformed + statistics.lost;
  status.summary(DiagnosticStatus::OK,
                 std::string(aesop::name(state.mode)) + (state.reason.empty() ? "" : ": ") + state.reason);
  if (!link.isUp() || state.mode == OperatingMode::kFault) {
    status.level = DiagnosticStatus::ERROR;
  } else if (!line_warning_.empty()) {
    status.mergeSummary(DiagnosticStatus::WARN, line_warning_);
  } else if (errors > errors_reported_) {
    status.mergeSummary(DiagnosticStatus::WARN, "the line loses bytes");
  }
  errors_reported_ = errors;
  addMaster(now, master, publishers, status);
  status.add("port", port_);
  status.add("link", aesop::name(link.state()));
  status.add("controller", link.model());
  status.add("state", aesop::name(state.mode));
  status.add("age of the last status [s]", link.statusAge(now));
  status.add("age of the last command [s]", driver.guard().age(now));
  status.add("commands accepted", driver.guard().accepted());
  status.add("commands refused", driver.guard().refused());
  status.add("round trip [s]", statistics.round_trip);
  status.add("longest round trip [s]", statistics.longest_round_trip);
  status.add("requests sent", statistics.sent);
  status.add("statuses received", statistics.received);
  status.add("replies lost", statistics.lost);
  status.add("CRC errors", statistics.decoder.crc_errors);
  status.add("malformed frames", statistics.decoder.malformed);
  status.add("bytes skipped", statistics.decoder.skipped_bytes);
  status.add("sessions", statistics.sessions);
}

void AesopDiagnostics::addMaster(double now, const CommandMaster& master, std::uint32_t publishers,
                                 diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const std::string complaint = master.complaint(now);
  if (!complaint.empty()) {
    status.mergeSummary(DiagnosticStatus::WARN, complaint);
  } else if (publishers > 1) {
    status.mergeSummary(DiagnosticStatus::WARN, std::to_string(publishers) +
                                                    " publishers of commands are connected, only " + master.name() +
                                                    " counts ('rostopic info' of the topic names them)");
  }
  status.add("node whose commands count", master.name());
  status.add("publishers of commands", publishers);
  status.add("commands refused for their sender", master.refused());
}

}  // namespace laparoscope_servo::skin
