#include "laparoscope_servo/servo/controller.h"

#include "servo/controller_implementation.h"

namespace laparoscope_servo::servo {

Controller::Controller(const ControllerConfig& config) : implementation_(std::make_unique<Implementation>(config)) {}
Controller::~Controller() = default;
Controller::Controller(Controller&&) noexcept = default;
Controller& Controller::operator=(Controller&&) noexcept = default;

std::string Controller::engage(const ControllerInput& input) {
  return implementation_->engage(input);
}

void Controller::disengage(const std::string& reason) {
  implementation_->disengage(reason);
}

void Controller::stop(const std::string& reason, double time) {
  implementation_->stop(reason, time);
}

void Controller::select(Task task) {
  implementation_->select(task);
}

ControllerOutput Controller::update(const ControllerInput& input) {
  return implementation_->update(input);
}

void Controller::retune(const ControllerConfig& config) {
  implementation_->retune(config);
}

std::string Controller::problem(const ControllerInput& input) const {
  return implementation_->problem(input);
}

bool Controller::engaged() const {
  return implementation_->engaged();
}

Task Controller::task() const {
  return implementation_->task();
}

ControllerFigures Controller::figures() const {
  return implementation_->figures();
}

}  // namespace laparoscope_servo::servo
