#include "can/frame.hpp"

#include <algorithm>

namespace can {

bool SameOnWire(const Frame& a, const Frame& b) {
  return a.id == b.id && a.extended == b.extended && a.kind == b.kind && a.fd == b.fd &&
         a.fd_flags == b.fd_flags && a.length == b.length && std::ranges::equal(a.Payload(), b.Payload());
}

}  // namespace can
