// How far the stamps of images are off from when they were exposed, each by another time: of a grabber that stamps what
// it delivers, and delivers unevenly.
//
// In a picture that moves, such a stamp looks like a region that trembles along its motion. No explanation of the guard
// of effect is free of it, it goes back and forth and does not grow; it is no more than the motion within the time. So
// it is measured from three images each: by how far the middle one lies beside the line through the others, in what the
// explanation with the least of it leaves over.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <vector>

namespace laparoscope_servo::servo {

class StampScatter {
 public:
  using Features = Eigen::Vector4d;  // x, y, log depth, alpha

  // Until it has moved, stamps are taken to be off by so many seconds, which is worth so many images. Measured in
  // simulated time, starts of a healthy scope that are held, of 100, where pictures are older than their stamps by 0 to
  // 0.1 s, each by another time: 7; with 0.015 s 5, with 0.004 s 30. Where pictures come up to 0.15 s late and two of
  // five are lost, 11; with 0.015 s 18: what is taken for scatter is no evidence.
  static constexpr double kBefore = 0.01;

  // What comes next does not go on from what was. What is known of the stamps stays.
  void restart();

  // An image at `time` [s], later than the last. `seen`: the features in it; `left`: what each explanation leaves over
  // of them, always as many; `variance`: of their noise; `expected`: how fast the scope should move them [1/s].
  void take(double time, const Features& seen, const std::vector<Features>& left, const Features& variance,
            const Features& expected);

  // s, standard deviation.
  double seconds() const { return seconds_; }
  // 1/s, how fast the features move in the picture, x and y together in each of both.
  const Features& speed() const { return speed_; }

 private:
  struct Image {
    double time;
    Features seen;
    std::vector<Features> left;
  };

  void forget(double dt);
  void measureSpeed(const Features& expected);
  void compare(const Features& variance);

  std::deque<Image> images_;
  std::vector<double> square_;  // s^2, of each explanation, times images that moved
  double moved_ = 0.0;          // images, those that moved slowly count less
  Features speed_ = Features::Zero();
  double seconds_ = 0.0;
};

}  // namespace laparoscope_servo::servo
