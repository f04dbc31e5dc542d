#include "ros/reasons/reason_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "laparoscope_servo/aesop/messages.h"
#include "laparoscope_servo/aesop/session_reason.h"
#include "laparoscope_servo/features/feature_state.h"

namespace laparoscope_servo {
namespace {

namespace fs = std::filesystem;

const std::string kRoot = LAPAROSCOPE_SERVO_ROOT;
constexpr Speaker kSpeakers[] = {Speaker::kTracker, Speaker::kFeatures, Speaker::kController, Speaker::kRobot,
                                 Speaker::kPlayer};

std::string textOf(const fs::path& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

// Without the tables of parameters, whose sentences are no reasons.
std::string withoutParameters(std::string text) {
  const std::string begin = "parameters::Table& table", end = "\n}\n";
  for (std::size_t at = 0; (at = text.find(begin, at)) != std::string::npos;) {
    const std::size_t body_end = text.find(end, at);
    if (body_end == std::string::npos) break;
    text.erase(at, body_end - at);
  }
  return text;
}

// As the compiler sees them: adjacent ones are one.
std::vector<std::string> literalsOf(const fs::path& path) {
  static const std::regex several("\"(?:[^\"\\\\\n]|\\\\.)*\"(?:\\s*\"(?:[^\"\\\\\n]|\\\\.)*\")*");
  static const std::regex one("\"((?:[^\"\\\\\n]|\\\\.)*)\"");
  static const std::regex include("#include[^\n]*");
  const std::string text = std::regex_replace(withoutParameters(textOf(path)), include, "");
  std::vector<std::string> literals;
  for (std::sregex_iterator it(text.begin(), text.end(), several), end; it != end; ++it) {
    const std::string group = it->str();
    std::string literal;
    for (std::sregex_iterator part(group.begin(), group.end(), one); part != end; ++part) literal += (*part)[1];
    literals.push_back(literal);
  }
  return literals;
}

std::vector<std::string> piecesOf(const std::string& pattern) {
  std::vector<std::string> pieces;
  const std::string gap = "…";
  for (std::size_t begin = 0; begin <= pattern.size();) {
    const std::size_t end = std::min(pattern.find(gap, begin), pattern.size());
    if (end > begin) pieces.push_back(pattern.substr(begin, end - begin));
    begin = end + gap.size();
  }
  return pieces;
}

const std::vector<std::string>& sourceLiterals() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> literals;
    for (const char* folder : {"/src", "/include"}) {
      for (const auto& entry : fs::recursive_directory_iterator(kRoot + folder)) {
        const std::string path = entry.path().string();
        const bool is_source = entry.path().extension() == ".cpp" || entry.path().extension() == ".h";
        if (!is_source || path.find("/ros/reasons/") != std::string::npos) continue;
        for (const std::string& literal : literalsOf(entry.path())) literals.push_back(literal);
      }
    }
    return literals;
  }();
  return all;
}

// Every file in which reasons are written, and what in it is none: of answers, of the log, of diagnostics.
const std::map<std::string, std::set<std::string>>& filesWithReasons() {
  static const std::map<std::string, std::set<std::string>> files{
      {"src/tracking/region_tracker.cpp", {}},
      {"src/tracking/roi_check.cpp",
       {"image is empty, expected at least one pixel", "image of OpenCV type ",
        ", expected 8 bit with one channel or three", "external mask of ", " px and OpenCV type ",
        ", expected the image's size, ", " px, and type "}},
      {"src/tracking/frozen_feed.cpp", {}},
      {"src/tracking/align/quality.cpp", {"within a factor of"}},
      {"src/features/feature_state.cpp", {}},
      {"src/model/instrument/instrument_feature_tracker.cpp",
       {" features, expected none: instruments are found without a selection"}},
      {"src/tracking/search/region_search.cpp", {}},
      {"src/ros/tracker/image_gate.cpp", {" px, grey", " px, in colour", "the image is stamped ", "old they are"}},
      {"src/ros/tracker/image_conversion.cpp", {}},
      {"src/ros/tracker/tracker_session_input.cpp", {"the images have their old size again"}},
      {"src/ros/tracker/tracker_state_report.cpp", {}},
      {"src/ros/playback/image_source.cpp",
       {" s, expected 0 or more", " Hz, expected more than 0",
        "no input is given, expected a bag, a video or a folder of images", "crop is given, and '",
        "' is a bag, expected a video or a folder of images"}},
      {"src/ros/playback/image_source_bag.cpp",
       {"compressed image with format '", " cannot be decoded, expected JPEG or PNG",
        " is a colour filter pattern, expected grey or colour: let image_proc turn it into colour",
        " images have the stamp 0 or that of the image before: theirs is from the time of recording",
        "); 'rosbag reindex' may repair it", "the bag has no ", ": one of them can be chosen by camera-info-topic",
        "' has another definition of its type than this system", "message of topic '"}},
      {"src/ros/playback/bag_topics.cpp", {"the bag is empty", "the bag has:"}},
      {"src/servo/controller_implementation.cpp", {}},
      {"src/servo/controller_seen.cpp", {}},
      {"src/servo/safety/dead_man_switch.cpp", {}},
      {"src/servo/safety/effect_guard.cpp", {}},
      {"src/servo/safety/manual_stick.cpp", {}},
      {"src/servo/safety/opposed_motion.cpp", {}},
      {"src/servo/safety/pose_watch.cpp", {}},
      {"src/servo/safety/safety_machine.cpp",
       {"by itself", "resume the robot", "press the dead-man switch", "engage again", "disengage, then engage again"}},
      {"src/servo/safety/task_error_input.cpp", {}},
      {"src/ros/controller/tip_input.cpp", {}},
      {"src/ros/controller/view_input.cpp", {}},
      {"src/ros/controller/scope_pose.cpp", {"transforms of others refused", "transforms refused as nonsense"}},
      {"src/ros/common/stop_line.cpp",
       {"it is empty", "it begins neither with 0 nor with 1", "signal = '",
        "', expected CTS, DSR or CD, or nothing for a file", "it has not been read yet", "no reading for "}},
      {"src/ros/common/master_watch.cpp", {"does not answer", "is gone", "is another one", " knows another node as "}},
      {"src/aesop/line/link.cpp", {}},
      {"src/aesop/line/session.cpp",
       {"not connected: ", "; clear_fault comes first", "still disabling; try again", "there is no fault",
        "only an enabled arm can be paused", "the arm is not paused"}},
      {"src/aesop/line/session_reason.cpp", {"the controller names no cause"}},
      {"src/aesop/line/transport.cpp", {}},
      {"src/aesop/arm/scope_motion.cpp", {}},
      {"src/aesop/arm/command_guard.cpp",
       {"is not finite", "has no stamp", "is older than the enable",
        "has a stamp that is not newer than that of the one before", "has a stamp more than ", "is stamped more than ",
        " s ahead: compare the clocks of the machines"}},
      {"src/aesop/arm/kinematics.cpp", {}},
      {"src/aesop/driver.cpp",
       {"insertion_point = (", "), expected finite numbers within 10 m", "the arm is ", ", not DISABLED",
        "the arm moves, or is about to be enabled"}},
      {"src/aesop/motion_monitor.cpp", {}},
  };
  return files;
}

// Short ones join the parts of a sentence.
bool isSentence(const std::string& literal) {
  return literal.size() >= 12 && std::count(literal.begin(), literal.end(), ' ') >= 2;
}

bool isInTable(const std::string& literal) {
  for (const Speaker speaker : kSpeakers) {
    for (const ReasonRow& row : reasonRows(speaker)) {
      for (const std::string& pattern : row.patterns) {
        for (const std::string& piece : piecesOf(pattern)) {
          if (literal.find(piece) != std::string::npos || piece.find(literal) != std::string::npos) return true;
        }
      }
    }
  }
  return false;
}

TEST(ReasonTable, HasEveryReasonThatASourceGives) {
  int sentences = 0;
  for (const auto& [file, others] : filesWithReasons()) {
    for (const std::string& literal : literalsOf(kRoot + "/" + file)) {
      if (!isSentence(literal) || others.count(literal) > 0) continue;
      ++sentences;
      // What follows the number in the middle of a sentence tells nothing that its beginning does not.
      if (std::string(" ,;)").find(literal[0]) != std::string::npos) continue;
      EXPECT_TRUE(isInTable(literal)) << file << " says '" << literal
                                      << "': give it a row in src/ros/reasons/, or name it here as no reason";
    }
  }
  EXPECT_GT(sentences, 100);
}

TEST(ReasonTable, HasNothingThatNoSourceSays) {
  for (const Speaker speaker : kSpeakers) {
    for (const ReasonRow& row : reasonRows(speaker)) {
      EXPECT_FALSE(row.patterns.empty());
      for (const std::string& pattern : row.patterns) {
        for (const std::string& piece : piecesOf(pattern)) {
          const bool said = std::any_of(sourceLiterals().begin(), sourceLiterals().end(),
                                        [&piece](const std::string& s) { return s.find(piece) != std::string::npos; });
          EXPECT_TRUE(said || piece == "port '" || piece == "': " || piece == ": ")
              << "no source says '" << piece << "'";
        }
      }
    }
  }
}

// A row that another one before it takes everything from is never shown.
TEST(ReasonTable, EachPatternLeadsToItsOwnRow) {
  for (const Speaker speaker : kSpeakers) {
    for (const ReasonRow& row : reasonRows(speaker)) {
      for (const std::string& pattern : row.patterns) {
        std::string reason;
        for (const std::string& piece : piecesOf(pattern)) reason += piece + "7";
        const ReasonRow* found = explain(speaker, reason);
        ASSERT_NE(found, nullptr) << pattern;
        EXPECT_EQ(found->sentence, row.sentence) << pattern << " is taken by another row";
      }
    }
  }
}

TEST(ReasonTable, SaysASentenceAndACure) {
  for (const Speaker speaker : kSpeakers) {
    for (const ReasonRow& row : reasonRows(speaker)) {
      for (const std::string& text : {row.sentence, row.cure}) {
        ASSERT_FALSE(text.empty()) << row.patterns.front();
        EXPECT_TRUE(text.back() == '.' || text.back() == '?') << text;
        EXPECT_LE(text.size(), 100u) << "it has to fit a band of the screen: " << text;
        EXPECT_EQ(text.find('|'), std::string::npos) << text;
      }
      if (row.page.empty()) continue;
      EXPECT_TRUE(fs::exists(kRoot + "/doc/" + row.page.substr(0, row.page.find('#')))) << row.page;
    }
  }
}

TEST(ReasonTable, KnowsEveryReasonOfASession) {
  using Kind = aesop::SessionReason::Kind;
  // Up to the last of the enumeration; kNone and kGiven have no words of their own.
  for (int k = 0; k <= static_cast<int>(Kind::kDisableConfirmedLate); ++k) {
    const auto kind = static_cast<Kind>(k);
    if (kind == Kind::kNone || kind == Kind::kGiven) continue;
    const std::string words = aesop::text({kind, 1});
    EXPECT_FALSE(words.empty()) << k;
    EXPECT_NE(explain(Speaker::kRobot, words), nullptr) << words;
  }
}

TEST(ReasonTable, KnowsEveryReasonOfAFeature) {
  for (int k = 0; k <= static_cast<int>(features::Reason::kAmbiguous); ++k) {
    const std::string words = features::reasonText(static_cast<features::Reason>(k));
    if (static_cast<features::Reason>(k) == features::Reason::kNone) continue;
    EXPECT_FALSE(words.empty()) << k;
    EXPECT_NE(explain(Speaker::kFeatures, "some id: " + words), nullptr) << words;
  }
}

TEST(ReasonTable, ExplainsReasonsAsTheyAreSaid) {
  const struct {
    Speaker speaker;
    const char* reason;
    const char* sentence;
  } cases[] = {
      {Speaker::kTracker, "visible fraction 0.04, expected at least 0.1", "Something covers the region."},
      {Speaker::kTracker, "no image for more than 1 s; before: TRACKING", "The camera has stopped sending."},
      {Speaker::kFeatures, "shaft: outside the image", "It has left the picture."},
      {Speaker::kController, "held for 2 s: the robot is paused; engage again",
       "What was missing did not come back in time."},
      {Speaker::kController, "depth d2 is not between 0.02 and 0.25 m", "The scope is too far out, or too deep."},
      {Speaker::kController, "slow: visible fraction below 0.5; not deeper: visible fraction below 0.5",
       "What is followed is seen badly, so the scope goes slower, or no deeper."},
      {Speaker::kRobot,
       "not connected: port '/dev/ttyX': there is no such port; is the cable plugged in, is the name right?",
       "The arm's serial port is not there."},
      {Speaker::kRobot, "fault: emergency stop", "The arm's emergency stop is pressed."},
      {Speaker::kRobot, "joint 2 has moved by 0.1 rad, which nobody has commanded",
       "A joint does not do what it was told."},
  };
  for (const auto& each : cases) {
    const ReasonRow* row = explain(each.speaker, each.reason);
    ASSERT_NE(row, nullptr) << each.reason;
    EXPECT_EQ(row->sentence, each.sentence) << each.reason;
  }
  EXPECT_EQ(explain(Speaker::kRobot, "nothing that anybody says"), nullptr);
  EXPECT_EQ(explain(Speaker::kRobot, ""), nullptr);
}

TEST(ReasonTable, PiecesHaveToStandInTheirOrder) {
  EXPECT_TRUE(fits("a … b", "say a 7 b now"));
  EXPECT_FALSE(fits("a … b", "b 7 a "));
  EXPECT_TRUE(fits("…a", "a"));
  EXPECT_TRUE(fits("a…", "xa"));
}

// With LAPAROSCOPE_SERVO_WRITE_PAGES set, the page is written anew.
TEST(ReasonTable, IsThePartOfThePage) {
  const std::string path = kRoot + "/doc/troubleshooting.md";
  const std::string begin = "<!-- reasons: begin -->\n";
  const std::string end = "<!-- reasons: end -->";
  std::string page = textOf(path);
  const std::size_t first = page.find(begin);
  const std::size_t last = page.find(end);
  ASSERT_NE(first, std::string::npos);
  ASSERT_NE(last, std::string::npos);
  const std::size_t from = first + begin.size();
  if (std::getenv("LAPAROSCOPE_SERVO_WRITE_PAGES") != nullptr) {
    page.replace(from, last - from, reasonPage());
    std::ofstream(path) << page;
    return;
  }
  EXPECT_TRUE(page.substr(from, last - from) == reasonPage())
      << "it differs: run this test with LAPAROSCOPE_SERVO_WRITE_PAGES=1 in the environment, which writes the page";
}

}  // namespace
}  // namespace laparoscope_servo
