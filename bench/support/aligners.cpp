#include "bench/support/aligners.h"

#include <stdexcept>

#include "tracking/esm/esm.h"

namespace laparoscope_servo::bench {

namespace {

constexpr int kPatience = 50;

// ESM alone, without gates and states.
class Aligner : public Contestant {
 public:
  Aligner(std::string name, const tracking::EsmConfig& config)
      : name_(std::move(name)), config_(config), esm_(config) {}
  std::string name() const override { return name_; }
  void select(const cv::Mat& image, const geometry::Rectangle& roi) override {
    pyramid_.build(image, cv::Rect(0, 0, image.cols, image.rows), config_.levels, image::kLuma);
    esm_.setReference(pyramid_, roi);
  }
  Verdict track(const cv::Mat& image) override {
    pyramid_.build(image, cv::Rect(0, 0, image.cols, image.rows), config_.levels, image::kLuma);
    esm_.forgetLight();
    const tracking::EsmResult result = esm_.align(pyramid_, tracking::EsmState());
    return {result.state.g, result.status == tracking::EsmStatus::kConverged};
  }

 private:
  std::string name_;
  tracking::EsmConfig config_;
  tracking::Esm esm_;
  image::RegionPyramid pyramid_;
};

using Contestants = std::vector<std::unique_ptr<Contestant>>;

void addEsm(Contestants& all, const std::string& name, const tracking::EsmConfig& config) {
  for (const int levels : {1, 3}) {
    tracking::EsmConfig with = config;
    with.levels = levels;
    all.push_back(std::make_unique<Aligner>(name + (levels == 1 ? "_1_level" : "_3_levels"), with));
  }
}

tracking::EsmConfig plain(const tracking::EsmConfig& config) {
  tracking::EsmConfig result = config;
  result.robust = false;
  result.light = tracking::Light::kConstant;
  return result;
}

void addParts(Contestants& all, const tracking::EsmConfig& config) {
  using tracking::Light;
  for (const auto& [name, light] : {std::pair("constant", Light::kConstant), std::pair("global", Light::kGlobal),
                                    std::pair("local", Light::kLocal)}) {
    for (const bool robust : {false, true}) {
      tracking::EsmConfig part = config;
      part.light = light;
      part.robust = robust;
      addEsm(all, std::string(name) + (robust ? "_robust" : ""), part);
    }
  }
}

}  // namespace

Contestants aligners(const std::string& who, int max_iterations) {
  if (who != "own" && who != "all" && who != "parts")
    throw std::invalid_argument("who \"" + who + "\", expected all, own or parts");
  Contestants all;
  tracking::EsmConfig config;
  tracking::EsmConfig patient = config;
  patient.max_iterations = kPatience;
  if (max_iterations > 0) config.max_iterations = patient.max_iterations = max_iterations;
  if (who == "parts") {
    addParts(all, patient);
    return all;
  }
  addEsm(all, "esm", config);
  addEsm(all, "plain_esm", plain(patient));
  all.push_back(makeOurs());
  if (who == "own") return all;
  all.push_back(makeEcc(kWholeImage));
  all.push_back(makeKlt(kWholeImage));
#ifdef LAPAROSCOPE_SERVO_BENCH_VISP
  all.push_back(makeVispTuned(1));
  all.push_back(makeVispTuned(3));
#endif
  return all;
}

}  // namespace laparoscope_servo::bench
