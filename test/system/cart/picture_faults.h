// What cameras and grabbers do to the picture itself, as others have reported it. Each has a state that begins anew
// with the call.
#pragma once

#include <functional>

#include "image_relay.h"

namespace laparoscope_servo::test::image_faults {

// One picture, with the noise of a grabber that digitises it anew each time, standard deviation in grey levels.
ImageRelay::Fault frozenWithNoise(double noise);
// Every second picture is changed: two sources that take turns.
ImageRelay::Fault everySecond(const std::function<void(cv::Mat&)>& change);
void shift(cv::Mat& image, int right, int down);
// Each is somewhere else, by up to so many pixels.
ImageRelay::Fault trembling(int most);
ImageRelay::Fault white();
// Of this contrast, on light grey.
ImageRelay::Fault inSmoke(double contrast);
// Blurred, standard deviation in pixels.
ImageRelay::Fault outOfFocus(double sigma);
// Half as large, in the middle of a still one.
ImageRelay::Fault inAWindow();
// Below a line, which is another one in each picture, it is the one before.
ImageRelay::Fault torn();
// Every second line is that of the picture before.
ImageRelay::Fault interlaced();
// The picture wraps around, further by so many pixels each time: a grabber that has lost the synchronisation of lines
// (to the right) or of pictures (down).
ImageRelay::Fault runningThrough(int right, int down);
// Red for blue, the encoding stays.
ImageRelay::Fault swappedColours();
ImageRelay::Fault gamma(double exponent);
// Each is the mean of the last ones, with weights that fall to 1/e within `pictures`: noise reduction of the camera.
ImageRelay::Fault smoothed(double pictures);
// By JPEG of this quality, 0 to 100.
ImageRelay::Fault compressed(int quality);
// The picture of a stereo screen: both halves show all of it.
ImageRelay::Fault sideBySide();
// The camera's menu opens over the middle.
ImageRelay::Fault menu();
// The grabber's test picture, without noise.
ImageRelay::Fault testPicture();
// By hand, `rate` [degrees/s] until `most` [degrees]: the camera head turns on the scope.
ImageRelay::Fault turning(double rate, double most);
// By hand, growing by the factor `rate` per second until `most`; the intrinsics stay what they were.
ImageRelay::Fault zooming(double rate, double most);
// The camera keeps the picture steady, as one that is held in a hand.
ImageRelay::Fault stabilised();

}  // namespace laparoscope_servo::test::image_faults
