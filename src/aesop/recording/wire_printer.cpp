#include "laparoscope_servo/aesop/wire_printer.h"

#include <algorithm>
#include <cstdio>
#include <iomanip>
#include <sstream>

#include "laparoscope_servo/aesop/operating_state.h"
#include "laparoscope_servo/robust/median.h"

namespace laparoscope_servo::aesop {

namespace {

struct Text {
  std::ostringstream& out;

  void operator()(const Identify&) { out << "identify"; }
  void operator()(const Enable&) { out << "enable"; }
  void operator()(const Disable&) { out << "disable"; }
  void operator()(const Stop&) { out << "stop"; }
  void operator()(const ClearFault&) { out << "clear_fault"; }
  void operator()(const Poll&) { out << "poll"; }
  void operator()(const Velocity& velocity) {
    out << "velocity for " << velocity.time_to_live << " s:";
    for (const double speed : velocity.speed) out << ' ' << speed;
  }
  void operator()(const Identity& identity) {
    out << "identity " << int{identity.joints} << " joints, driven 0x" << std::hex << int{identity.driven} << std::dec
        << ", '" << identity.model << "'";
  }
  void operator()(const Status& status) {
    out << "status " << name(status.state) << (status.homed ? " homed" : " not homed")
        << (status.moving ? " moving" : "");
    if (status.faults != 0) out << " faults: " << describeFaults(status.faults) << ';';
    out << " echo " << status.echo << " time " << std::setprecision(10) << status.time << std::setprecision(6) << " q";
    for (int k = 0; k < kJoints; ++k) out << ' ' << status.position[k];
    out << " qdot";
    for (int k = 0; k < kJoints; ++k) out << ' ' << status.velocity[k];
  }
};

std::string hex(const Bytes& bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    char digits[4];
    std::snprintf(digits, sizeof digits, " %02X", static_cast<unsigned>(byte));
    text += digits;
  }
  return text;
}

std::string numbers(const WireRecord& record, std::size_t count) {
  std::ostringstream out;
  out << std::setprecision(13);
  for (const double value : numbersOf(record, count)) out << ' ' << value;
  return out.str();
}

std::string eventText(const WireRecord& record) {
  switch (record.event) {
    case WireEvent::kOpened:
      return "port opened";
    case WireEvent::kClosed:
      return "port closed: " + textOf(record);
    case WireEvent::kEnable:
      return "asked to enable";
    case WireEvent::kDisable:
      return "asked to disable" + (record.payload.empty() ? "" : ": " + textOf(record));
    case WireEvent::kClearFault:
      return "asked to clear a fault";
    case WireEvent::kPause:
      return "asked to pause: " + textOf(record);
    case WireEvent::kResume:
      return "asked to resume";
    case WireEvent::kCommand:
      return "command" + numbers(record, 6);
    case WireEvent::kInsertionPoint:
      return "insertion point" + numbers(record, 3);
    case WireEvent::kState: {
      const OperatingState state = stateOf(record.payload);
      return std::string("state ") + name(state.mode) + (state.is_homed ? " homed" : "") +
             (state.is_busy ? " busy" : "") + (state.reason.empty() ? "" : ": ") + state.reason;
    }
    case WireEvent::kReceived:
    case WireEvent::kSent:
      break;
  }
  return "";
}

double seconds(std::int64_t time) {
  return static_cast<double>(time) * 1e-9;
}

}  // namespace

std::string describe(const Message& message) {
  std::ostringstream out;
  std::visit(Text{out}, message);
  return out.str();
}

std::string typeOf(const Message& message) {
  const std::string text = describe(message);
  return text.substr(0, text.find(' '));
}

void WirePrinter::print(const WireRecord& record, std::int64_t start, std::ostream& out) {
  if (records_++ == 0) first_ = record.time;
  last_ = record.time;
  std::ostringstream head;
  head << std::fixed << std::setprecision(6) << std::setw(13) << seconds(record.time - start);
  if (record.event == WireEvent::kReceived) return printBytes(record, to_host_, head.str() + " < ", out);
  if (record.event != WireEvent::kSent) {
    out << head.str() << " * " << eventText(record) << '\n';
    return;
  }
  if (turns_++ > 0) longest_turn_ = std::max(longest_turn_, record.time - last_turn_);
  last_turn_ = record.time;
  if (!record.payload.empty()) printBytes(record, to_controller_, head.str() + " > ", out);
}

void WirePrinter::printBytes(const WireRecord& record, Direction& direction, const std::string& head,
                             std::ostream& out) {
  const DecoderStatistics before = direction.codec->statistics();
  direction.bytes += record.payload.size();
  for (const Frame& frame : direction.codec->push(record.payload.data(), record.payload.size())) {
    ++direction.frames[typeOf(frame.message)];
    count(record, frame);
    out << head << '#' << frame.sequence << ' ' << describe(frame.message) << '\n';
  }
  const DecoderStatistics& after = direction.codec->statistics();
  if (after.skipped_bytes == before.skipped_bytes && after.crc_errors == before.crc_errors) return;
  out << head << "skipped " << after.skipped_bytes - before.skipped_bytes << " bytes, CRC errors "
      << after.crc_errors - before.crc_errors << ", malformed " << after.malformed - before.malformed
      << ", of another version " << after.other_version - before.other_version << "; these came:" << hex(record.payload)
      << '\n';
}

void WirePrinter::count(const WireRecord& record, const Frame& frame) {
  if (record.event == WireEvent::kSent) {
    sent_at_[frame.sequence] = record.time;
    return;
  }
  const auto* status = std::get_if<Status>(&frame.message);
  if (status == nullptr) return;
  const auto request = sent_at_.find(status->echo);
  if (request == sent_at_.end()) return;
  round_trips_.push_back(seconds(record.time - request->second));
  sent_at_.erase(request);
}

void WirePrinter::printSummary(std::ostream& out) const {
  const auto line = [&](const char* head, const Direction& direction) {
    const DecoderStatistics& statistics = direction.codec->statistics();
    out << head << direction.bytes << " bytes, frames " << statistics.frames;
    for (const auto& [type, frames] : direction.frames) out << ", " << type << ' ' << frames;
    out << "; skipped " << statistics.skipped_bytes << " bytes, CRC errors " << statistics.crc_errors << ", malformed "
        << statistics.malformed << ", of another version " << statistics.other_version << '\n';
  };
  out << records_ << " records in " << seconds(last_ - first_) << " s, turns of the driver " << turns_
      << ", longest time between two " << seconds(longest_turn_) << " s\n";
  line("to the controller: ", to_controller_);
  line("from it: ", to_host_);
  if (round_trips_.empty()) return;
  std::vector<double> trips = round_trips_;
  out << "round trips " << trips.size() << ", median " << robust::median(trips) << " s, longest "
      << *std::max_element(trips.begin(), trips.end()) << " s\n";
}

}  // namespace laparoscope_servo::aesop
