#include "laparoscope_servo/servo/task_config.h"

#include "laparoscope_servo/parameters/table.h"

namespace laparoscope_servo::servo {

void describe(parameters::Table& table, StabiliseConfig& c) {
  table.flag("spin", c.spin, "the scope's spin is used, as the parameter spin says; false: it does not spin");
  table.flag("insertion", c.insertion,
             "the distance to the tissue is kept; false: the scope does not move along its shaft");
  table.number("max_error", c.max_error, {0.1, 100}, "px",
               "expected error of the view at its worst corner; beyond it the scope stands");
}

}  // namespace laparoscope_servo::servo
