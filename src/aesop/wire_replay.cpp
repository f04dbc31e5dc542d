#include "laparoscope_servo/aesop/wire_replay.h"

namespace laparoscope_servo::aesop {

void WireReplay::feed(const WireRecord& record) {
  if (record.event == WireEvent::kState) {  // belongs to the cycle before it
    recorded_ = stateOf(record.payload);
    return;
  }
  compare();
  now_ = static_cast<double>(record.time) / 1e9;
  switch (record.event) {
    case WireEvent::kOpened:
      open();
      break;
    case WireEvent::kClosed:
      driver_.closed(textOf(record));
      break;
    case WireEvent::kReceived:
      driver_.receive(record.payload.data(), record.payload.size(), now_);
      break;
    case WireEvent::kSent:
      turn(record);
      break;
    case WireEvent::kEnable:
      driver_.enable(numbersOf(record, 1)[0], now_);
      break;
    case WireEvent::kDisable:
      if (record.payload.empty()) {
        driver_.disable(now_);
      } else {
        driver_.stop(now_, textOf(record));
      }
      break;
    case WireEvent::kClearFault:
      driver_.clearFault(now_);
      break;
    case WireEvent::kPause:
      driver_.pause(textOf(record));
      break;
    case WireEvent::kResume:
      driver_.resume(numbersOf(record, 1)[0]);
      break;
    case WireEvent::kCommand: {
      const std::vector<double> numbers = numbersOf(record, 6);
      driver_.command({numbers[0], numbers[1], numbers[2], numbers[3]}, numbers[4], numbers[5], now_);
      break;
    }
    case WireEvent::kInsertionPoint: {
      const std::vector<double> numbers = numbersOf(record, 3);
      driver_.setInsertionPoint({numbers[0], numbers[1], numbers[2]});
      break;
    }
    case WireEvent::kState:
      break;
  }
}

void WireReplay::open() {
  if (!begun_ && last_number_) driver_.setSequence(*last_number_);
  begun_ = true;
  driver_.opened(now_);
}

void WireReplay::turn(const WireRecord& record) {
  const Bytes bytes = driver_.transmit(now_);
  if (!begun_) {
    whole_ = false;
    for (const Frame& frame : requests_->push(record.payload.data(), record.payload.size())) {
      last_number_ = frame.sequence;
    }
    return;
  }
  compared_ = false;
  ++statistics_.turns;
  if (!whole_ || bytes == record.payload) return;
  ++statistics_.other_bytes;
  if (!statistics_.first_other) statistics_.first_other = now_;
}

void WireReplay::end() {
  compare();
}

void WireReplay::compare() {
  if (compared_) return;
  compared_ = true;
  if (driver_.state(now_) == recorded_) return;
  ++statistics_.other_states;
  if (!statistics_.first_other) statistics_.first_other = now_;
}

}  // namespace laparoscope_servo::aesop
