// What drivers do to images on their way, as others have reported it: pictures that are older than their stamps, that
// come twice, in bursts, in another format, or messages that are none. Each has a state that begins anew with the call.
#pragma once

#include "image_relay.h"

namespace laparoscope_servo::test::image_faults {

// Pictures that are `seconds` old, stamped when they are delivered.
ImageRelay::Fault oldButStampedNow(double seconds);
// A buffer that fills: of the pictures, `share` are delivered, in their order and stamped when they are; each is older
// than the one before.
ImageRelay::Fault filling(double share);
// `count` pictures come at once, with the stamps of their exposure.
ImageRelay::Fault inBursts(std::size_t count);
// Each picture comes once more, half a period later and with a stamp of its own.
ImageRelay::Fault doubled();
// Every `period`-th picture is the one before it.
ImageRelay::Fault repeatedEvery(int period);
// One of `period` comes.
ImageRelay::Fault only(int period);
// Ever later: by `rate` times what has passed since the first one, with the stamps of the exposure.
ImageRelay::Fault laterAndLater(double rate);
// Every second picture is the one of `pictures` before, as of a buffer that a driver forgets to give back.
ImageRelay::Fault oldBetween(std::size_t pictures);
// In each second the pictures stand for a while, `share` of it, and their stamps go on.
ImageRelay::Fault stuttering(double share);
// In one of `period` a block of bytes got lost: what follows moves up, also within the line.
ImageRelay::Fault blockLost(int period);
// mono8, from one picture to the next.
ImageRelay::Fault grey();
// Messages that are no images, of one kind after the other.
ImageRelay::Fault malformed();

}  // namespace laparoscope_servo::test::image_faults
