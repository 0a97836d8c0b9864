// Library for LD_PRELOAD that turns the CAN sockets of a process into UDP sockets on the loopback: the programs run
// unchanged, with every other system call real, on a kernel without CAN. Each process has one peer, which receives all
// that it sends.
//
//   CAN_BY_UDP="OWN PEER"    the ports of both
//
// There are no filters, no error frames, and no reception of own frames.
#include <arpa/inet.h>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

namespace {

int can_socket = -1;

template <typename Function>
Function* Real(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

sockaddr_in Address(bool own) {
  int ports[2] = {};
  const char* text = std::getenv("CAN_BY_UDP");
  if (text == nullptr || std::sscanf(text, "%d %d", &ports[0], &ports[1]) != 2) std::abort();
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(ports[own ? 0 : 1]));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

}  // namespace

extern "C" {

int socket(int domain, int type, int protocol) noexcept {
  static auto* real = Real<int(int, int, int)>("socket");
  if (domain != PF_CAN) return real(domain, type, protocol);
  return can_socket = real(AF_INET, SOCK_DGRAM | (type & (SOCK_NONBLOCK | SOCK_CLOEXEC)), 0);
}

// Every name is accepted as that of a CAN interface.
int ioctl(int fd, unsigned long request, ...) noexcept {
  std::va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  auto* interface = static_cast<ifreq*>(argument);
  if (request == SIOCGIFINDEX) {
    interface->ifr_ifindex = 1;
  } else if (request == SIOCGIFHWADDR) {
    interface->ifr_hwaddr.sa_family = ARPHRD_CAN;
  } else {
    return Real<int(int, unsigned long, void*)>("ioctl")(fd, request, argument);
  }
  return 0;
}

int setsockopt(int fd, int level, int option, const void* value, socklen_t size) noexcept {
  if (level == SOL_CAN_RAW) return 0;
  return Real<int(int, int, int, const void*, socklen_t)>("setsockopt")(fd, level, option, value, size);
}

int bind(int fd, const sockaddr* address, socklen_t size) noexcept {
  static auto* real = Real<int(int, const sockaddr*, socklen_t)>("bind");
  if (fd != can_socket) return real(fd, address, size);
  const sockaddr_in own = Address(true);
  return real(fd, reinterpret_cast<const sockaddr*>(&own), sizeof(own));
}

ssize_t send(int fd, const void* data, size_t size, int flags) {
  static auto* real = Real<ssize_t(int, const void*, size_t, int)>("send");
  if (fd != can_socket) return real(fd, data, size, flags);
  static const sockaddr_in peer = Address(false);
  return ::sendto(fd, data, size, flags, reinterpret_cast<const sockaddr*>(&peer), sizeof(peer));
}

}  // extern "C"
