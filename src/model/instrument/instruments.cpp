#include "laparoscope_servo/model/instruments.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "features/shafts/bright_edges.h"
#include "features/shafts/shaft_finder.h"
#include "laparoscope_servo/parameters/table.h"
#include "laparoscope_servo/validation/error_report.h"
#include "model/instrument/grey_plane.h"
#include "model/instrument/instrument_track.h"

namespace laparoscope_servo::model {

namespace {

using features::kLeastInstrumentImage;

// Of the threshold of grey, for nine tenths of what lies between edges of little contrast. Of shafts on all films it
// was up to 0.73, of pale tissue with two edges that lasted from 0.96 on (bench_instruments).
constexpr double kGreyThroughout = 0.85;

void check(const cv::Mat& image, double stamp) {
  if (image.type() != CV_8UC3) {
    throw std::invalid_argument(image.empty()
                                    ? "image of 0 x 0 px, expected pixels"
                                    : "image of OpenCV type " + std::to_string(image.type()) +
                                          ", expected 16 (8 bit, blue-green-red): instruments are told by colour");
  }
  if (image.cols < kLeastInstrumentImage || image.rows < kLeastInstrumentImage) {
    std::ostringstream text;
    text << "image of " << image.cols << " x " << image.rows << " px, expected at least " << kLeastInstrumentImage
         << " x " << kLeastInstrumentImage;
    throw std::invalid_argument(text.str());
  }
  if (!std::isfinite(stamp)) throw std::invalid_argument("stamp is not finite, expected seconds");
}

}  // namespace

void describe(parameters::Table& table, InstrumentConfig& c) {
  table.number("most", c.most, {1, 3}, "", "instruments at a time");
  table.number("confirmations", c.confirmations, {1, 100}, "images",
               "in a row that show a new one, before it is taken for an instrument");
  table.number("clear_contrast", c.clear_contrast, {0.3, 10}, "",
               "of colour across the edges of an instrument that is believed at once, relative to the tissue's colour");
  table.number("min_fill", c.min_fill, {0.1, 1}, "", "share of what lies between the edges that is grey");
  table.number("radius", c.radius, {0, 0.05}, "m", "of the shaft, for its pose; 0: not known, no pose");
  table.number("max_search_time", c.max_search_time, {0, 600}, "s", "SEARCHING for longer is LOST");
}

std::vector<std::string> validate(const InstrumentConfig& config) {
  std::vector<std::string> errors = parameters::errorsOf(config);
  for (const std::string& error : features::validate(config.edges)) errors.push_back("edges/" + error);
  return errors;
}

class InstrumentTracker::Implementation {
 public:
  explicit Implementation(const InstrumentConfig& config) : config_(config) {}

  const InstrumentsResult& track(const cv::Mat& image, double stamp, const std::optional<Eigen::Matrix3d>& motion) {
    check(image, stamp);
    if (image.size() != size_ || stamp < stamp_) reset();
    size_ = image.size();
    stamp_ = stamp;
    map_.compute(image);
    view_.compute(map_.level());
    const GreyLevels levels = features::greyLevels(map_, view_);
    const std::vector<Shaft>& found = finder_.find(map_, view_, levels);
    const std::optional<Eigen::Matrix3d> usable = motion && motion->allFinite() ? motion : std::nullopt;
    plane_.compute(image, cv::Rect(cv::Point(0, 0), image.size()));
    const InstrumentScene scene{image, plane_.plane(), stamp, usable, map_, view_, levels};
    taken_.assign(found.size(), false);
    for (InstrumentTrack& track : tracks_) {
      track.predict(scene);
      track.update(scene, match(scene, track, found));
    }
    dropDoubles();
    startNew(scene, found);
    tell(levels);
    return result_;
  }

  void reset() {
    tracks_.clear();
    pending_.clear();
    result_.instruments.clear();
    result_.mask = cv::Mat();
  }

  std::optional<geometry::PinholeCamera> camera_;
  InstrumentsResult result_;

 private:
  // A shaft that is seen, but not yet taken for an instrument.
  struct Pending {
    Shaft shaft;
    int images = 0;
    bool seen = true;
  };

  const Shaft* match(const InstrumentScene& scene, const InstrumentTrack& track, const std::vector<Shaft>& found) {
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (taken_[i] || !track.isExpectedAt(scene, found[i])) continue;
      taken_[i] = true;
      return &found[i];
    }
    return nullptr;
  }

  // Two that came to lie on one another are one: the older one.
  void dropDoubles() {
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      for (std::size_t j = tracks_.size(); j-- > i + 1;) {
        if (overlaps(tracks_[i].shaft(), tracks_[j].shaft()) && tracks_[i].state() == features::State::kTracking) {
          tracks_.erase(tracks_.begin() + static_cast<std::ptrdiff_t>(j));
        }
      }
    }
  }

  void startNew(const InstrumentScene& scene, const std::vector<Shaft>& found) {
    for (Pending& p : pending_) p.seen = false;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (taken_[i]) continue;
      const Shaft& shaft = found[i];
      const bool covered = std::any_of(tracks_.begin(), tracks_.end(), [&](const InstrumentTrack& t) {
        return t.state() == features::State::kTracking && overlaps(t.shaft(), shaft);
      });
      if (covered) continue;
      const bool contrasts = shaft.clarity >= config_.clear_contrast && shaft.coverage >= features::kClearCoverage;
      auto p = std::find_if(pending_.begin(), pending_.end(),
                            [&](const Pending& q) { return !q.seen && isSame(q.shaft, shaft); });
      if (p == pending_.end()) p = pending_.insert(p, Pending());
      p->shaft = shaft;
      p->seen = true;
      ++p->images;
      const bool confirmed = p->images >= config_.confirmations;
      if (!confirmed && !(contrasts && shaft.seen[0] && shaft.seen[1])) continue;
      // Pale tissue hardly counts as grey: between two edges of little contrast all has to be greyer than that.
      if (!contrasts && !(shaft.colour <= kGreyThroughout)) continue;
      // Light has to agree with colour: the border between pale tissue and red tissue is no step of brightness. One
      // that is grey throughout and has lasted needs no step, which a dark shaft on dark tissue does not have.
      const bool lasting = confirmed && shaft.seen[0] && shaft.seen[1] && shaft.coverage >= features::kClearCoverage;
      const bool needs_light = !(contrasts && confirmed) && !lasting;
      const int bright = needs_light ? features::brightEdges(config_.edges, scene.image, map_, shaft) : 0;
      if (needs_light && bright < (contrasts ? 1 : 2)) continue;
      if (static_cast<int>(tracks_.size()) >= config_.most && !makeRoom()) continue;
      InstrumentTrack track(config_, next_id_, scene, shaft);
      if (track.fineEdges() == 0 && needs_light) continue;
      tracks_.push_back(std::move(track));
      ++next_id_;
      p->seen = false;
    }
    pending_.erase(std::remove_if(pending_.begin(), pending_.end(), [](const Pending& q) { return !q.seen; }),
                   pending_.end());
  }

  // One that is LOST gives way.
  bool makeRoom() {
    const auto lost = std::find_if(tracks_.begin(), tracks_.end(),
                                   [](const InstrumentTrack& t) { return t.state() == features::State::kLost; });
    if (lost == tracks_.end()) return false;
    tracks_.erase(lost);
    return true;
  }

  void tell(const GreyLevels& levels) {
    mask_.create(size_);
    std::fill_n(mask_.ptr(), mask_.total(), uchar{0});
    result_.instruments.resize(tracks_.size());
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      tracks_[i].tell(map_, camera_, result_.instruments[i]);
      tracks_[i].draw(map_, levels.threshold, mask_);
    }
    result_.mask = mask_;
  }

  InstrumentConfig config_;
  GreyMap map_;
  image::FieldOfView view_;
  features::ShaftFinder finder_;
  std::vector<InstrumentTrack> tracks_;
  std::vector<Pending> pending_;
  std::vector<char> taken_;
  cv::Mat1b mask_;
  GreyPlane plane_;
  cv::Size size_;
  double stamp_ = 0.0;
  int next_id_ = 1;
};

InstrumentTracker::InstrumentTracker(const InstrumentConfig& config) {
  validation::throwErrors("instrument", validate(config));
  implementation_ = std::make_unique<Implementation>(config);
}
InstrumentTracker::~InstrumentTracker() = default;
InstrumentTracker::InstrumentTracker(InstrumentTracker&&) noexcept = default;
InstrumentTracker& InstrumentTracker::operator=(InstrumentTracker&&) noexcept = default;

void InstrumentTracker::setCamera(const std::optional<geometry::PinholeCamera>& camera) {
  if (camera && !camera->error().empty()) throw std::invalid_argument("camera: " + camera->error());
  implementation_->camera_ = camera;
}

const InstrumentsResult& InstrumentTracker::track(const cv::Mat& image, double stamp,
                                                  const std::optional<Eigen::Matrix3d>& motion) {
  return implementation_->track(image, stamp, motion);
}

void InstrumentTracker::reset() {
  implementation_->reset();
}

const InstrumentsResult& InstrumentTracker::result() const {
  return implementation_->result_;
}

}  // namespace laparoscope_servo::model
