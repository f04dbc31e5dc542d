#include "ros/common/json_writer.h"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

namespace laparoscope_servo {
namespace {

TEST(JsonWriter, NestsAndSeparates) {
  std::ostringstream text;
  JsonWriter json(text);
  json.beginObject();
  json.value("number", 0.125);
  json.value("count", 3);
  json.value("yes", true);
  json.value("no", false);
  json.values("list", {1.0, 2.5});
  json.beginArray("rows");
  json.beginObject();
  json.value("name", "first");
  json.end();
  json.beginObject();
  json.end();
  json.end();
  json.end();
  EXPECT_EQ(text.str(),
            "{\n \"number\": 0.125,\n \"count\": 3,\n \"yes\": true,\n \"no\": false,\n \"list\": [1,2.5],\n"
            " \"rows\": [{\n   \"name\": \"first\"},{}]}\n");
}

TEST(JsonWriter, WritesNullForWhatJsonHasNoNumberFor) {
  std::ostringstream text;
  JsonWriter json(text);
  json.values("", {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1.0});
  EXPECT_EQ(text.str(), "[null,null,-1]\n");
}

TEST(JsonWriter, EscapesText) {
  std::ostringstream text;
  JsonWriter json(text);
  json.beginObject();
  json.value("a \"name\"", std::string("back\\slash, \"quote\", line\nbreak"));
  json.end();
  EXPECT_EQ(text.str(), "{\n \"a \\\"name\\\"\": \"back\\\\slash, \\\"quote\\\", line break\"}\n");
}

TEST(JsonWriter, RoundsToItsDigits) {
  std::ostringstream text;
  JsonWriter json(text, 3);
  json.values("", {3.14159});
  EXPECT_EQ(text.str(), "[3.14]\n");
}

}  // namespace
}  // namespace laparoscope_servo
