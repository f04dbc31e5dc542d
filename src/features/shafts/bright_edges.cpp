#include "features/shafts/bright_edges.h"

#include "laparoscope_servo/features/edge_fit.h"
#include "laparoscope_servo/features/line.h"

namespace laparoscope_servo::features {

int brightEdges(const EdgeConfig& config, const cv::Mat& image, const GreyMap& map, const Shaft& shaft) {
  const auto toPixel = [&](const Eigen::Vector2d& p) {
    return Eigen::Vector2d(map.toPixel(p.x()), map.toPixel(p.y()));
  };
  int count = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const GreyLine& edge = shaft.edges[k];
    const Eigen::Vector2d begin = toPixel(edge.at(edge.begin)), end = toPixel(edge.at(edge.end));
    if (!shaft.seen[k] || !((end - begin).norm() > Line::kMinLength)) continue;
    Line line(begin, end);
    EdgeFit fit(config);
    count += fit.learn(image, line, kStagesApart * map.step() + 2.0).reason == Reason::kNone ? 1 : 0;
  }
  return count;
}

}  // namespace laparoscope_servo::features
