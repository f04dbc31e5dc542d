#include "laparoscope_servo/servo/control_law.h"

#include "laparoscope_servo/servo/insertion_point.h"

namespace laparoscope_servo::servo {

ScopeVelocity PaperLaw::velocity(const TaskError& error, double d2) const {
  geometry::Vector6d wanted;
  // Eq. (7), plus signs: H maps the reference to the current image, so that e_v and e_w point back to the reference.
  // The gains of pan and tilt are those of the paper times d2, which eq. (11) divides by again.
  wanted << gains_.pan * d2 * error.e_v.x(), gains_.tilt * d2 * error.e_v.y(),
      gains_.insertion * error.e_v.z(),       // eq. (7)
      0.0, 0.0, gains_.spin * error.e_w.z();  // eq. (7)
  return aboutInsertionPoint(wanted, d2);     // eq. (11)
}

}  // namespace laparoscope_servo::servo
