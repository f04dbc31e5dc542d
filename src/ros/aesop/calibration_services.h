// The services and the topic under ~calibrate_insertion_point: doc/nodes/aesop.md.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <ros/node_handle.h>
#include <ros/service_callback_helper.h>
#include <std_srvs/Trigger.h>

#include <string>
#include <vector>

#include "laparoscope_servo/StartCalibration.h"
#include "ros/aesop/insertion_point_calibration.h"
#include "ros/common/service_callers.h"
#include "ros/common/service_errors.h"

namespace laparoscope_servo {

class CalibrationServices {
 public:
  // `callers`: who may start a calibration, which may move the arm, or end it with a result. `errors` keeps exceptions
  // of the services; it and `driver` must outlive this.
  CalibrationServices(const ros::NodeHandle& private_node, const AesopParameters& parameters,
                      const ServiceCallers& callers, ServiceErrors& errors, aesop::Driver& driver);

  // Call often. Returns true if the insertion point has changed.
  bool step(double stamp_now, double now);
  // Whether a command is consumed here, because the arm moves along its pattern.
  bool takes(const scope::Velocity& command, double now);
  // Whether a new insertion point is not in use yet.
  bool waits() const { return calibration_.waits(); }
  void describe(diagnostic_updater::DiagnosticStatusWrapper& status) const;

 private:
  using Ending = std_srvs::Trigger::Response;

  // Each fills in the response of the service.
  void start(const StartCalibration::Request& request, StartCalibration::Response& response);
  void end(const std::string& refusal, Ending& response);
  void publish(double now);

  ros::NodeHandle node_;
  ServiceCallers callers_;
  ServiceErrors& errors_;
  std::string frame_;
  std::string origin_;  // source of the insertion point, for display
  InsertionPointCalibration calibration_;
  CalibrationStage published_ = CalibrationStage::kIdle;
  double next_publication_ = 0.0;  // s, steady
  ros::Publisher publisher_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace laparoscope_servo
