// Images of models whose pose is known: rays against faces and cylinders, 8 x 8 samples where a pixel shows an edge.
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "laparoscope_servo/geometry/camera.h"
#include "laparoscope_servo/geometry/se3.h"
#include "laparoscope_servo/model/cad_model.h"

namespace laparoscope_servo::test {

// The parts of the cube of ViSP's images, 84 mm wide.
inline const std::string kCubePoints = R"( 0 0 0
-0.084 0 0
-0.084 0.084 0
 0 0.084 0
 0 0 0.084
-0.084 0 0.084
-0.084 0.084 0.084
 0 0.084 0.084
)";
inline const std::string kCubeFaces = R"(0
0
6
4 0 4 5 1
4 1 5 6 2
4 6 7 3 2
4 3 7 4 0
4 0 1 2 3
4 7 6 5 4
)";

inline const std::string kCube = "V1\n8\n" + kCubePoints + kCubeFaces + "0\n0\n";

// The same with a tube beside it, and the circle at the tube's upper end.
inline const std::string kCubeAndTube = "V1\n12\n" + kCubePoints + R"(-0.15 -0.03 0
-0.15 -0.03 0.11
-0.11 -0.03 0.11
-0.15 0.01 0.11
)" + kCubeFaces + R"(1
8 9 0.04
1
0.04 9 10 11
)";

inline std::shared_ptr<const model::CadModel> modelOf(const std::string& text) {
  std::istringstream stream(text);
  return model::readCadModel(stream, "test.cao");
}

// A view from above onto the model's upper corner, `distance` m away, turned by `turn` about the model's vertical.
inline Eigen::Isometry3d viewOf(const model::CadModel& model, double distance, double turn = 0.6, double tilt = 0.6) {
  Eigen::Matrix3d upright;  // the model's z is up
  upright << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = geometry::so3Exp({tilt, 0.0, 0.0}) * upright * geometry::so3Exp({0.0, 0.0, turn});
  result.translation() = Eigen::Vector3d(0.0, 0.0, distance) - result.linear() * model.centre;
  return result;
}

struct ModelScene {
  geometry::PinholeCamera camera{300.0, 300.0, 160.0, 120.0};
  cv::Size size{320, 240};
  double blur = 1.0;   // px
  double noise = 2.0;  // grey levels
  unsigned seed = 1;
  double background = 90.0;
  double clutter = 0.0;  // grey levels, standard deviation of a texture behind the model
  double texture = 0.0;  // the same on its faces
  // Of faces, in turn; a tube is darker on the side that points away from the light.
  std::vector<double> levels{150.0, 190.0, 120.0, 170.0, 210.0, 140.0};
};

class ModelRenderer {
 public:
  ModelRenderer(const model::CadModel& model, const ModelScene& scene) : model_(model), scene_(scene) {
    pattern_ = grain(cv::Size(256, 256), 3.0, 5);
    behind_ = grain(scene.size, 4.0, 7);
  }

  // CV_8UC1.
  cv::Mat draw(const Eigen::Isometry3d& camera_T_object, unsigned seed) const {
    constexpr int kSamples = 8;
    const Eigen::Isometry3d object_T_camera = camera_T_object.inverse();
    cv::Mat1f image(scene_.size);
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        float level = 0.0f;
        const int middle = hit(object_T_camera, u, v, level);
        bool whole = true;
        for (int k = 0; k < 4 && whole; ++k) {
          float other = 0.0f;
          whole = hit(object_T_camera, u + (k % 2 == 0 ? -0.7 : 0.7), v + (k / 2 == 0 ? -0.7 : 0.7), other) == middle;
        }
        float sum = level;
        if (!whole) {
          sum = 0.0f;
          for (int k = 0; k < kSamples * kSamples; ++k) {
            hit(object_T_camera, u + (k % kSamples + 0.5) / kSamples - 0.5, v + (k / kSamples + 0.5) / kSamples - 0.5,
                level);
            sum += level / (kSamples * kSamples);
          }
        }
        image(v, u) = sum;
      }
    }
    if (scene_.blur > 0.0) cv::GaussianBlur(image, image, cv::Size(), scene_.blur, scene_.blur, cv::BORDER_REFLECT_101);
    if (scene_.noise > 0.0) {
      cv::Mat1f noise(scene_.size);
      cv::RNG rng(seed);
      rng.fill(noise, cv::RNG::NORMAL, 0.0, scene_.noise);
      image += noise;
    }
    cv::Mat result;
    image.convertTo(result, CV_8UC1);
    return result;
  }

 private:
  static cv::Mat1f grain(const cv::Size& size, double scale, unsigned seed) {
    cv::Mat1f result(size);
    cv::RNG rng(seed);
    rng.fill(result, cv::RNG::NORMAL, 0.0, 1.0);
    cv::GaussianBlur(result, result, cv::Size(), scale);
    result *= static_cast<float>(3.545 * scale);
    return result;
  }

  // What is seen there: -1 the background, then faces, then tubes and their ends; and its grey level.
  int hit(const Eigen::Isometry3d& object_T_camera, double u, double v, float& level) const {
    const geometry::PinholeCamera& c = scene_.camera;
    const Eigen::Vector3d from = object_T_camera.translation();
    const Eigen::Vector3d ray = object_T_camera.linear() * Eigen::Vector3d((u - c.cx) / c.fx, (v - c.cy) / c.fy, 1.0);
    double nearest = 1e9;
    int what = -1;
    level = static_cast<float>(scene_.background);
    if (scene_.clutter > 0.0) {
      const int x = std::clamp(static_cast<int>(u + 0.5), 0, behind_.cols - 1);
      const int y = std::clamp(static_cast<int>(v + 0.5), 0, behind_.rows - 1);
      level += static_cast<float>(scene_.clutter) * behind_(y, x);
    }
    for (std::size_t f = 0; f < model_.faces.size(); ++f) {
      const model::Face& face = model_.faces[f];
      const double toward = face.normal.dot(ray);
      if (!(toward < 0.0)) continue;
      const double s = face.normal.dot(face.centre - from) / toward;
      if (!(s > 0.0 && s < nearest) || !inside(face, from + s * ray)) continue;
      nearest = s;
      what = static_cast<int>(f);
      level = static_cast<float>(scene_.levels[f % scene_.levels.size()]);
      if (scene_.texture > 0.0) {
        const Eigen::Vector3d p = 1000.0 * (from + s * ray);  // a pixel of the pattern to the millimetre
        const int x = static_cast<int>(p.x() + 2.0 * p.y() + 1280.0) & 255;
        const int y = static_cast<int>(p.z() + 1.5 * p.y() + 1280.0) & 255;
        level += static_cast<float>(scene_.texture) * pattern_(y, x);
      }
    }
    for (std::size_t k = 0; k < model_.cylinders.size(); ++k) {
      const int tube = hitTube(model_.cylinders[k], from, ray, nearest, level);
      if (tube >= 0) what = static_cast<int>(model_.faces.size() + 3 * k) + tube;
    }
    return what;
  }

  bool inside(const model::Face& face, const Eigen::Vector3d& p) const {
    for (std::size_t k = 0; k < face.points.size(); ++k) {  // convex faces only
      const Eigen::Vector3d& a = model_.points[static_cast<std::size_t>(face.points[k])];
      const Eigen::Vector3d& b = model_.points[static_cast<std::size_t>(face.points[(k + 1) % face.points.size()])];
      if (face.normal.dot((b - a).cross(p - a)) < 0.0) return false;
    }
    return true;
  }

  // 0: its side, 1 and 2: its ends, -1: missed.
  static int hitTube(const model::Cylinder& tube, const Eigen::Vector3d& from, const Eigen::Vector3d& ray,
                     double& nearest, float& level) {
    const Eigen::Vector3d whole = tube.end - tube.begin, axis = whole.normalized();
    const Eigen::Vector3d d = ray - ray.dot(axis) * axis;
    const Eigen::Vector3d o = (from - tube.begin) - (from - tube.begin).dot(axis) * axis;
    const double a = d.squaredNorm(), b = d.dot(o), root = b * b - a * (o.squaredNorm() - tube.radius * tube.radius);
    int what = -1;
    if (root > 0.0) {
      const double s = (-b - std::sqrt(root)) / a;
      const double along = (from + s * ray - tube.begin).dot(axis);
      if (s > 0.0 && s < nearest && along >= 0.0 && along <= whole.norm()) {
        nearest = s;
        what = 0;
        const Eigen::Vector3d normal = (o + s * d) / tube.radius;
        level = static_cast<float>(160.0 + 25.0 * normal.dot(Eigen::Vector3d(0.6, 0.8, 0.0)));
      }
    }
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector3d& centre = k == 0 ? tube.begin : tube.end;
      const double s = axis.dot(centre - from) / axis.dot(ray);
      if (s > 0.0 && s < nearest && (from + s * ray - centre).norm() < tube.radius) {
        nearest = s;
        what = 1 + k;
        level = 230.0f;
      }
    }
    return what;
  }

  const model::CadModel& model_;
  ModelScene scene_;
  cv::Mat1f pattern_, behind_;
};

}  // namespace laparoscope_servo::test
