#include "laparoscope_servo/aesop/codec.h"

#include <stdexcept>

namespace laparoscope_servo::aesop {

namespace {

struct NamedCodec {
  const char* name;
  std::unique_ptr<Codec> (*make)();
};

constexpr NamedCodec kCodecs[] = {
    {"own", makeOwnCodec},
};

}  // namespace

std::vector<std::string> codecNames() {
  std::vector<std::string> names;
  for (const NamedCodec& codec : kCodecs) names.emplace_back(codec.name);
  return names;
}

CodecFactory codecNamed(const std::string& name) {
  std::string names;
  for (const NamedCodec& codec : kCodecs) {
    if (name == codec.name) return codec.make;
    names += (names.empty() ? "" : ", ") + std::string(codec.name);
  }
  throw std::invalid_argument("codec = '" + name + "', expected one of: " + names);
}

int compareSequence(std::uint16_t a, std::uint16_t b) {
  if (a == b) return 0;
  return static_cast<std::uint16_t>(a - b) < 0x8000 ? 1 : -1;
}

}  // namespace laparoscope_servo::aesop
