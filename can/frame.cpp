#include "can/frame.hpp"

#include <algorithm>

namespace can {
namespace {

bool IsFdLength(std::uint8_t length) {
  constexpr std::array<std::uint8_t, 7> kLongLengths{12, 16, 20, 24, 32, 48, 64};
  return length <= kMaxClassicLength || std::ranges::count(kLongLengths, length) != 0;
}

}  // namespace

bool IsValid(const Frame& frame) {
  const bool id_is_29_bits = frame.extended || frame.kind == FrameKind::kError;
  if (frame.id > (id_is_29_bits ? kMaxExtendedId : kMaxStandardId)) return false;
  if (frame.kind != FrameKind::kData && frame.fd) return false;
  return frame.fd ? IsFdLength(frame.length) : frame.length <= kMaxClassicLength;
}

bool SameOnWire(const Frame& a, const Frame& b) {
  return a.id == b.id && a.extended == b.extended && a.kind == b.kind && a.fd == b.fd &&
         a.fd_flags == b.fd_flags && a.length == b.length && std::ranges::equal(a.Payload(), b.Payload());
}

}  // namespace can
