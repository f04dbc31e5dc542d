#include "ros/aesop/aesop_diagnostics.h"

namespace laparoscope_servo {

using aesop::OperatingMode;
using diagnostic_msgs::DiagnosticStatus;

void AesopDiagnostics::fill(double now, const aesop::Driver& driver, const AesopReport& report, Status& status) {
  const aesop::OperatingState state = driver.state(now);
  const aesop::Link& link = driver.session().link();
  summarise(state, driver.session(), status);
  addMaster(now, report, status);
  status.add("state", aesop::name(state.mode));
  addCommands(now, driver.guard(), status);
  status.add("port", port_);
  if (link.state() == aesop::LinkState::kClosed) status.add("next attempt to open the port [s]", report.next_attempt);
  addLine(now, link, status);
  addDelay(driver.delay(), status);
}

void AesopDiagnostics::summarise(const aesop::OperatingState& state, const aesop::Session& session, Status& status) {
  const aesop::Link& link = session.link();
  const aesop::LinkStatistics& statistics = link.statistics();
  const std::uint64_t errors = statistics.decoder.crc_errors + statistics.decoder.malformed + statistics.lost;
  status.summary(DiagnosticStatus::OK,
                 std::string(aesop::name(state.mode)) + (state.reason.empty() ? "" : ": ") + state.reason);
  if (!link.isUp() || state.mode == OperatingMode::kFault) {
    status.level = DiagnosticStatus::ERROR;
  } else if (session.stopped()) {
    status.level = DiagnosticStatus::WARN;
  } else if (!line_warning_.empty()) {
    status.mergeSummary(DiagnosticStatus::WARN, line_warning_);
  } else if (errors > errors_reported_) {
    status.mergeSummary(DiagnosticStatus::WARN, "the line loses bytes");
  }
  errors_reported_ = errors;
}

void AesopDiagnostics::addMaster(double now, const AesopReport& report, Status& status) {
  const std::string complaint = report.command_owner.complaint(now);
  if (!complaint.empty()) {
    status.mergeSummary(DiagnosticStatus::WARN, complaint);
  } else if (report.publishers > 1) {
    status.mergeSummary(DiagnosticStatus::WARN,
                        std::to_string(report.publishers) + " publishers of commands are connected, only " +
                            report.command_owner.name() + " counts ('rostopic info' of the topic names them)");
  }
  status.add("node whose commands count", report.command_owner.name());
  status.add("publishers of commands", report.publishers);
  status.add("commands refused for their sender", report.command_owner.refused());
}

void AesopDiagnostics::addCommands(double now, const aesop::CommandGuard& guard, Status& status) {
  status.add("age of the last command [s]", guard.age(now));
  status.add("commands accepted", guard.accepted());
  status.add("commands refused", guard.refused());
  for (std::size_t k = 0; k < aesop::kRefusals; ++k) {
    const auto refusal = static_cast<aesop::Refusal>(k);
    status.add("refused: " + guard.describe(refusal), guard.refused(refusal));
  }
}

void AesopDiagnostics::addLine(double now, const aesop::Link& link, Status& status) {
  const aesop::LinkStatistics& statistics = link.statistics();
  const aesop::RoundTripSummary trips = link.roundTrips();
  const double passed = now - called_at_;
  const auto rate = [passed](std::uint64_t count, std::uint64_t before) {
    return passed > 0.0 ? static_cast<double>(count - before) / passed : 0.0;
  };
  status.add("link", aesop::name(link.state()));
  status.add("controller", link.model());
  status.add("age of the last status [s]", link.statusAge(now));
  status.add("requests sent [1/s]", rate(statistics.sent, before_.sent));
  status.add("statuses received [1/s]", rate(statistics.received, before_.received));
  status.add("round trip, median [s]", trips.median);
  status.add("round trip, 99 of 100 [s]", trips.p99);
  status.add("round trip, longest [s]", trips.longest);
  status.add("round trip, jitter [s]", trips.jitter);
  status.add("requests sent", statistics.sent);
  status.add("statuses received", statistics.received);
  status.add("replies lost", statistics.lost);
  status.add("CRC errors", statistics.decoder.crc_errors);
  status.add("malformed frames", statistics.decoder.malformed);
  status.add("frames of another version", statistics.decoder.other_version);
  status.add("bytes skipped", statistics.decoder.skipped_bytes);
  status.add("sessions", statistics.sessions);
  before_ = statistics;
  called_at_ = now;
}

void AesopDiagnostics::addDelay(const aesop::MotionDelay& delay, Status& status) {
  const auto add = [&status](const std::string& key, const std::optional<double>& value) {
    if (value) {
      status.add(key, *value);
    } else {
      status.add(key, "not measured yet");
    }
  };
  add("delay of the arm, start to half its speed [s]", delay.start());
  add("delay of the arm, stop to half its speed [s]", delay.stop());
  add("delay of the arm, stop to standing [s]", delay.standing());
}

}  // namespace laparoscope_servo
