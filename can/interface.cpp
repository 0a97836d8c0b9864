#include "can/interface.hpp"

#include <cstring>
#include <linux/ethtool.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <string_view>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace can {

// The driver's name decides, not the absence of a device in sysfs: /sys may show another network namespace, and a
// serial line has no such device either. A Unix socket suffices for the ioctl.
bool IsVirtual(const std::string& interface) {
  ethtool_drvinfo info{};
  info.cmd = ETHTOOL_GDRVINFO;
  ifreq request{};
  if (interface.size() >= sizeof(request.ifr_name)) return false;
  interface.copy(request.ifr_name, interface.size());
  request.ifr_data = reinterpret_cast<char*>(&info);
  const int fd = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return false;
  const bool known = ::ioctl(fd, SIOCETHTOOL, &request) == 0;
  ::close(fd);
  const std::string_view driver(info.driver, ::strnlen(info.driver, sizeof(info.driver)));
  return known && (driver == "vcan" || driver == "vxcan");
}

}  // namespace can
